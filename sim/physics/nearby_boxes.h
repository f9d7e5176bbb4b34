// Which boxes a robot could meet: a short list per robot, renewed only after the robot has moved some way,
// from a grid of cells that know the boxes around them, so that it costs the same in an arena of any size.
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "sim/geometry/oriented_box.h"
#include "sim/robot/foot_bot.h"

namespace gauntlet::sim {

class NearbyBoxes {
 public:
  // Lists hold every box within `reach` metres of the robot's centre and some beyond.
  explicit NearbyBoxes(double reach) : reach_(reach) {}

  void AddBox(const OrientedBox& box);
  // Allocates; Near() does not.
  void SetRobots(int robots);
  // A superset, in the order of AddBox, of the boxes within `reach` of `position`.
  std::span<const std::size_t> Near(RobotIndex robot, const Vec2& position);
  const OrientedBox& box(std::size_t index) const { return boxes_[index]; }
  std::size_t size() const { return boxes_.size(); }

 private:
  struct List {
    Vec2 anchor = Vec2::Zero();
    bool valid = false;
    std::size_t size = 0;
  };

  void FillCells();
  int Cell(double coordinate, int axis) const;

  double reach_;
  std::vector<OrientedBox> boxes_;
  Vec2 origin_ = Vec2::Zero();  // of the grid
  double cell_ = 1.0;           // m
  std::array<int, 2> cells_ = {1, 1};
  std::vector<std::vector<std::size_t>>
      in_reach_;  // [cell]: boxes that some place in it may have in its list
  std::vector<List> lists_;
  std::vector<std::size_t> entries_;  // [robot][boxes_.size()]
};

}  // namespace gauntlet::sim
