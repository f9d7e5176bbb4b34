// A rectangle at any angle: the footprint of an obstacle or a wall.
#pragma once

#include <array>

#include "sim/geometry/vec2.h"

namespace gauntlet::sim {

struct OrientedBox {
  Vec2 center = Vec2::Zero();      // m
  Vec2 half_extents = {0.5, 0.5};  // m; along the box's own x (length) and y (width) axes
  Vec2 axis = {1.0, 0.0};          // unit vector of the box's own x axis in the world
};

// length along the box's x axis before it is turned by `orientation` (rad).
OrientedBox MakeBox(const Vec2& center, double length, double width, double orientation);

// p in the frame of the box (centre at the origin, length along x).
inline Vec2 ToLocal(const OrientedBox& box, const Vec2& p) {
  const Vec2 d = p - box.center;
  return {d.dot(box.axis), Cross(box.axis, d)};
}

// Counter-clockwise, starting at (-length/2, -width/2) of the box's frame.
std::array<Vec2, 4> Corners(const OrientedBox& box);
// Boundary counts as inside.
bool Contains(const OrientedBox& box, const Vec2& p);
// All four corners of `inner` lie in `outer` (boundary counts).
bool ContainsBox(const OrientedBox& outer, const OrientedBox& inner);
// Euclidean distance; 0 inside.
double Distance(const OrientedBox& box, const Vec2& p);

}  // namespace gauntlet::sim
