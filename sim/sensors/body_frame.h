// A robot's pose as the sensors need it: its direction is computed once per tick and shared by all of them.
#pragma once

#include "sim/geometry/trigonometry.h"
#include "sim/geometry/vec2.h"

namespace gauntlet::sim {

struct BodyFrame {
  Vec2 position = Vec2::Zero();
  double heading = 0.0;         // rad in (-pi, pi]
  Vec2 direction = {1.0, 0.0};  // unit vector of the heading

  BodyFrame() = default;
  explicit BodyFrame(const Pose& pose)
      : position(pose.position), heading(pose.heading), direction(UnitVector(pose.heading)) {}

  // A point given in the robot's frame (x forward, y left), in the world's.
  Vec2 ToWorld(const Vec2& point) const {
    return {position.x() + direction.x() * point.x() - direction.y() * point.y(),
            position.y() + direction.y() * point.x() + direction.x() * point.y()};
  }
  // A way given in the world's frame, in the robot's.
  Vec2 FromWorld(const Vec2& way) const { return {direction.dot(way), Cross(direction, way)}; }
};

}  // namespace gauntlet::sim
