// A rectangle at any angle: the footprint of an obstacle or a wall; and the polygon that the edge of the
// arena leaves of it.
#pragma once

#include <array>
#include <cmath>
#include <vector>

#include "sim/geometry/vec2.h"

namespace gauntlet::sim {

struct OrientedBox {
  Vec2 center = Vec2::Zero();      // m
  Vec2 half_extents = {0.5, 0.5};  // m; along the box's own x (length) and y (width) axes
  Vec2 axis = {1.0, 0.0};          // unit vector of the box's own x axis in the world
};

// How far beyond its exact boundary a box still contains a point, m: far more than coordinates up to 1000 m
// lose by rounding, so that a box contains its own corners, and far less than anything a robot can notice.
inline constexpr double kContainsTolerance = 1e-9;

// Everything within `radius` of a box; a disc is what lies around a box without extent.
struct RoundedBox {
  OrientedBox box;
  double radius = 0.0;  // m
};

// p in the frame of the box (centre at the origin, length along x).
inline Vec2 ToLocal(const OrientedBox& box, const Vec2& p) {
  const Vec2 d = p - box.center;
  return {d.dot(box.axis), Cross(box.axis, d)};
}

// Half sides of the smallest axis-aligned rectangle around the box, whose centre is the box's centre.
inline Vec2 BoundingHalfExtents(const OrientedBox& box) {
  const double c = std::fabs(box.axis.x());
  const double s = std::fabs(box.axis.y());
  return {c * box.half_extents.x() + s * box.half_extents.y(),
          s * box.half_extents.x() + c * box.half_extents.y()};
}

// Counter-clockwise, starting at (-length/2, -width/2) of the box's frame.
std::array<Vec2, 4> Corners(const OrientedBox& box);
// Boundary counts as inside (to kContainsTolerance).
bool Contains(const OrientedBox& box, const Vec2& p);
// All four corners of `inner` lie in `outer` (boundary counts).
bool ContainsBox(const OrientedBox& outer, const OrientedBox& inner);

// Euclidean distance, squared; 0 inside.
inline double SquaredDistance(const OrientedBox& box, const Vec2& p) {
  const Vec2 local = ToLocal(box, p);
  const double dx = std::fabs(local.x()) - box.half_extents.x();
  const double dy = std::fabs(local.y()) - box.half_extents.y();
  const double outside_x = dx > 0.0 ? dx : 0.0;
  const double outside_y = dy > 0.0 ? dy : 0.0;
  return outside_x * outside_x + outside_y * outside_y;
}
// Euclidean distance; 0 inside.
double Distance(const OrientedBox& box, const Vec2& p);
// Between the nearest points of both; 0 when they touch.
double Distance(const OrientedBox& a, const OrientedBox& b);

using Polygon = std::vector<Vec2>;  // convex, corners counter-clockwise; empty = nothing left

// The part of the box inside the axis-aligned rectangle [min, max] (Sutherland and Hodgman 1974).
Polygon ClipToRectangle(const OrientedBox& box, const Vec2& min, const Vec2& max);
// Area by the shoelace formula, m^2.
double Area(const Polygon& polygon);

}  // namespace gauntlet::sim
