// Which boxes a robot could meet: a short list per robot, renewed only after the robot has moved some way.
#pragma once

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

 private:
  struct List {
    Vec2 anchor = Vec2::Zero();
    bool valid = false;
    std::size_t size = 0;
  };

  double reach_;
  std::vector<OrientedBox> boxes_;
  std::vector<List> lists_;
  std::vector<std::size_t> entries_;  // [robot][boxes_.size()]
};

}  // namespace gauntlet::sim
