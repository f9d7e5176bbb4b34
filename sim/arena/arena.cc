#include "sim/arena/arena.h"

#include "base/check.h"
#include "sim/geometry/ray_cast.h"

namespace gauntlet::sim {

Arena::Arena(const TestCase& test_case) {
  const double half_x = test_case.side_x / 2.0;
  const double half_y = test_case.side_y / 2.0;
  const double thickness = test_case.wall_thickness;
  const Vec2& center = test_case.center;
  const Vec2 interior = {half_x - thickness / 2.0, half_y - thickness / 2.0};
  interior_max_ = center + interior;
  interior_min_ = center - interior;
  GAUNTLET_CHECK(interior.x() > 0.0 && interior.y() > 0.0,
                 "an arena without interior: judge the test case with CheckValidity first");

  obstacles_.reserve(test_case.obstacles.size());
  for (const ObstacleGene& gene : test_case.obstacles) {
    if (gene.Lit()) lit_.push_back({obstacles_.size(), gene.light});
    if (gene.Moves()) {
      moving_.push_back({obstacles_.size(), {{gene.x, gene.y}}, gene.speed});
      moving_.back().path.insert(moving_.back().path.end(), gene.path.begin(), gene.path.end());
    } else {
      fixed_boxes_.push_back(BoxOf(gene));
    }
    obstacles_.push_back(BoxOf(gene));
  }

  // Walls overlap in the corners, so that no gap is left there.
  const Vec2 along_x = {half_x + thickness / 2.0, thickness / 2.0};
  const Vec2 along_y = {thickness / 2.0, half_y + thickness / 2.0};
  walls_ = {{{center.x(), center.y() + half_y}, along_x, {1.0, 0.0}},
            {{center.x(), center.y() - half_y}, along_x, {1.0, 0.0}},
            {{center.x() + half_x, center.y()}, along_y, {1.0, 0.0}},
            {{center.x() - half_x, center.y()}, along_y, {1.0, 0.0}}};

  boxes_ = obstacles_;
  boxes_.insert(boxes_.end(), walls_.begin(), walls_.end());
  fixed_boxes_.insert(fixed_boxes_.end(), walls_.begin(), walls_.end());
}

Polygon Arena::VisiblePart(std::size_t index) const {
  GAUNTLET_CHECK(index < obstacles_.size(), "no obstacle " + std::to_string(index));
  return ClipToRectangle(obstacles_[index], interior_min_, interior_max_);
}

bool Arena::InInterior(const Vec2& p) const {
  return p.x() > interior_min_.x() && p.x() < interior_max_.x() && p.y() > interior_min_.y() &&
         p.y() < interior_max_.y();
}

bool Arena::LineOfSight(const Vec2& a, const Vec2& b, std::span<const Vec2> centers) const {
  if (centers.empty()) {
    for (const OrientedBox& box : obstacles_) {
      if (SegmentTouches(box, a, b)) return false;
    }
  } else {
    GAUNTLET_CHECK(centers.size() == moving_.size(), "one centre per moving obstacle");
    for (const OrientedBox& box : fixed_boxes_) {
      if (SegmentTouches(box, a, b)) return false;
    }
    for (std::size_t i = 0; i < centers.size(); ++i) {
      OrientedBox box = obstacles_[moving_[i].obstacle];
      box.center = centers[i];
      if (SegmentTouches(box, a, b)) return false;
    }
  }
  // The interior is convex: only a point outside it can have a wall in the way.
  if (InInterior(a) && InInterior(b)) return true;
  for (const OrientedBox& wall : walls_) {
    if (SegmentTouches(wall, a, b)) return false;
  }
  return true;
}

}  // namespace gauntlet::sim
