#include "sim/geometry/oriented_box.h"

#include <algorithm>
#include <limits>
#include <utility>

#include "sim/geometry/ray_cast.h"

namespace gauntlet::sim {
namespace {

// Keeps the part with sign * p[axis] <= sign * limit.
Polygon ClipToHalfPlane(const Polygon& polygon, int axis, double sign, double limit) {
  Polygon kept;
  kept.reserve(polygon.size() + 1);
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Vec2& from = polygon[i];
    const Vec2& to = polygon[(i + 1) % polygon.size()];
    const double from_inside = sign * (limit - from[axis]);
    const double to_inside = sign * (limit - to[axis]);
    if (from_inside >= 0.0) kept.push_back(from);
    if ((from_inside > 0.0 && to_inside < 0.0) || (from_inside < 0.0 && to_inside > 0.0)) {
      Vec2 crossing = from + (to - from) * (from_inside / (from_inside - to_inside));
      crossing[axis] = limit;
      kept.push_back(crossing);
    }
  }
  return kept;
}

}  // namespace

std::array<Vec2, 4> Corners(const OrientedBox& box) {
  const Vec2 along = box.half_extents.x() * box.axis;
  const Vec2 across = box.half_extents.y() * LeftOf(box.axis);
  return {box.center - along - across, box.center + along - across, box.center + along + across,
          box.center - along + across};
}

bool Contains(const OrientedBox& box, const Vec2& p) {
  const Vec2 local = ToLocal(box, p);
  return std::fabs(local.x()) <= box.half_extents.x() + kContainsTolerance &&
         std::fabs(local.y()) <= box.half_extents.y() + kContainsTolerance;
}

bool ContainsBox(const OrientedBox& outer, const OrientedBox& inner) {
  for (const Vec2& corner : Corners(inner)) {
    if (!Contains(outer, corner)) return false;
  }
  return true;
}

double Distance(const OrientedBox& box, const Vec2& p) {
  return std::sqrt(SquaredDistance(box, p));
}

double Distance(const OrientedBox& a, const OrientedBox& b) {
  // Of two that lie apart a corner is among the nearest points; two may cross with all corners outside.
  double least = std::numeric_limits<double>::infinity();
  for (const auto& [one, other] : {std::pair{&a, &b}, {&b, &a}}) {
    const auto corners = Corners(*one);
    for (std::size_t i = 0; i < corners.size(); ++i) {
      if (SegmentTouches(*other, corners[i], corners[(i + 1) % corners.size()])) return 0.0;
      least = std::min(least, Distance(*other, corners[i]));
    }
  }
  return least;
}

Polygon ClipToRectangle(const OrientedBox& box, const Vec2& min, const Vec2& max) {
  const auto corners = Corners(box);
  Polygon polygon(corners.begin(), corners.end());
  for (const int axis : {0, 1}) {
    polygon = ClipToHalfPlane(polygon, axis, 1.0, max[axis]);
    polygon = ClipToHalfPlane(polygon, axis, -1.0, min[axis]);
  }
  if (Area(polygon) <= 0.0) polygon.clear();
  return polygon;
}

double Area(const Polygon& polygon) {
  double twice = 0.0;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    // Relative to the first corner, so that a small polygon far from the origin keeps its digits.
    twice += Cross(polygon[i] - polygon[0], polygon[(i + 1) % polygon.size()] - polygon[0]);
  }
  return twice / 2.0;
}

}  // namespace gauntlet::sim
