// The phenotype of a test case: walls and obstacles as boxes, ready for physics, sensors and planning.
// Immutable after construction.
#pragma once

#include <span>
#include <vector>

#include "sim/arena/test_case.h"
#include "sim/geometry/oriented_box.h"

namespace gauntlet::sim {

class Arena {
 public:
  // The test case obeys the rules up to "limits" (validity.h); a broken one may abort.
  explicit Arena(const TestCase& test_case);

  // An obstacle that moves, and its way: from its centre at the beginning along these points and back.
  struct Moving {
    std::size_t obstacle = 0;
    std::vector<Vec2> path;  // m, two or more
    double speed = 0.0;      // m/s
  };
  struct Lit {
    std::size_t obstacle = 0;
    Color color = Color::kBlack;
  };

  // The inner faces of the walls, m.
  const Vec2& interior_min() const { return interior_min_; }
  const Vec2& interior_max() const { return interior_max_; }

  // Obstacles in gene order. What lies beyond the walls is kept in the box: no robot can be there and no line
  // between two robots passes there, so clipping changes nothing but drawings (see VisiblePart).
  const std::vector<OrientedBox>& obstacles() const { return obstacles_; }
  // The four walls: +y, -y, +x, -x. They overlap in the corners.
  const std::vector<OrientedBox>& walls() const { return walls_; }
  // Obstacles where they are at tick 0, then walls.
  const std::vector<OrientedBox>& boxes() const { return boxes_; }
  // The same without the obstacles that move.
  const std::vector<OrientedBox>& fixed_boxes() const { return fixed_boxes_; }
  // In gene order.
  const std::vector<Moving>& moving() const { return moving_; }
  const std::vector<Lit>& lit() const { return lit_; }

  // The part of obstacle `index` inside the interior (thesis 3.2.1: what lies outside the edge is split off).
  Polygon VisiblePart(std::size_t index) const;
  // Strictly between the inner faces of the walls.
  bool InInterior(const Vec2& p) const;
  // Centre-to-centre line of sight: no obstacle or wall touches the segment. `centers` says where the moving
  // obstacles are, in the order of moving() (Observer::ObstaclesAt); without it they are where they begin.
  bool LineOfSight(const Vec2& a, const Vec2& b, std::span<const Vec2> centers = {}) const;

 private:
  Vec2 interior_min_;
  Vec2 interior_max_;
  std::vector<OrientedBox> obstacles_;
  std::vector<OrientedBox> walls_;
  std::vector<OrientedBox> boxes_;
  std::vector<OrientedBox> fixed_boxes_;
  std::vector<Moving> moving_;
  std::vector<Lit> lit_;
};

}  // namespace gauntlet::sim
