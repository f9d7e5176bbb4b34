// Points, vectors and poses in the plane. Metres and radians; x right, y up, angles counter-clockwise.
#pragma once

#include <Eigen/Core>

namespace gauntlet::sim {

using Vec2 = Eigen::Vector2d;

// z component of the cross product: positive when b lies to the left of a.
inline double Cross(const Vec2& a, const Vec2& b) {
  return a.x() * b.y() - a.y() * b.x();
}
// v turned by +90 degrees.
inline Vec2 LeftOf(const Vec2& v) {
  return {-v.y(), v.x()};
}

struct Pose {
  Vec2 position = Vec2::Zero();  // m
  double heading = 0.0;          // rad in (-pi, pi], 0 = +x
};

}  // namespace gauntlet::sim
