// Rays against boxes and discs, and lines of sight. Pure functions, inline because sensing calls them more
// often than anything else.
#pragma once

#include <cmath>

#include "sim/geometry/oriented_box.h"
#include "sim/geometry/vec2.h"

namespace gauntlet::sim {

inline constexpr double kNoHit = -1.0;

// Distance along the ray from `origin` in `direction` (unit vector) to the first point of the shape, or
// kNoHit when it lies farther than `range`. An origin inside the shape gives 0.
inline double RayHit(const OrientedBox& box, const Vec2& origin, const Vec2& direction, double range) {
  // Slabs (Kay and Kajiya 1986) in the box's frame. A ray along a slab has an infinite inverse; then entry
  // and exit are infinite, or NaN (0 * infinity) on the slab's face, and a comparison with NaN is false,
  // which leaves the interval as it is: the boundary counts.
  const Vec2 o = ToLocal(box, origin);
  const double dx = direction.dot(box.axis);
  const double dy = Cross(box.axis, direction);
  const double inverse_x = 1.0 / dx;
  const double inverse_y = 1.0 / dy;
  const double toward_x = std::copysign(box.half_extents.x(), dx);
  const double toward_y = std::copysign(box.half_extents.y(), dy);
  const double enter_x = (-toward_x - o.x()) * inverse_x;
  const double enter_y = (-toward_y - o.y()) * inverse_y;
  const double leave_x = (toward_x - o.x()) * inverse_x;
  const double leave_y = (toward_y - o.y()) * inverse_y;
  double enter = enter_x > 0.0 ? enter_x : 0.0;
  enter = enter_y > enter ? enter_y : enter;
  double leave = leave_x < range ? leave_x : range;
  leave = leave_y < leave ? leave_y : leave;
  return enter <= leave ? enter : kNoHit;
}

inline double RayHit(const Vec2& disc_center, double disc_radius, const Vec2& origin, const Vec2& direction,
                     double range) {
  const Vec2 to_center = disc_center - origin;
  const double squared_radius = disc_radius * disc_radius;
  if (to_center.squaredNorm() <= squared_radius) return 0.0;
  const double along = to_center.dot(direction);
  const double aside = Cross(direction, to_center);
  const double squared_half_chord = squared_radius - aside * aside;
  if (along < 0.0 || squared_half_chord < 0.0) return kNoHit;
  const double distance = along - std::sqrt(squared_half_chord);
  if (distance > range) return kNoHit;
  return distance > 0.0 ? distance : 0.0;
}

// A segment and a box on the axes that can separate them (Gottschalk et al. 1996): the box's two axes and
// the segment's normal. Everything is doubled instead of halving the segment. On an axis the two are apart
// where the distance of their middles exceeds the sum of their extents.
struct SeparatingAxes {
  SeparatingAxes(const OrientedBox& box, const Vec2& a, const Vec2& b) {
    const Vec2 a_local = ToLocal(box, a);
    const Vec2 b_local = ToLocal(box, b);
    const Vec2 middle = a_local + b_local;
    extent = b_local - a_local;
    const double ex = std::fabs(extent.x());
    const double ey = std::fabs(extent.y());
    const double hx = 2.0 * box.half_extents.x();
    const double hy = 2.0 * box.half_extents.y();
    distance_x = std::fabs(middle.x());
    distance_y = std::fabs(middle.y());
    distance_aside = std::fabs(Cross(middle, extent));
    extent_x = hx + ex;
    extent_y = hy + ey;
    extent_aside = hx * ey + hy * ex;
  }

  Vec2 extent;                                        // m, of the segment in the box's frame
  double distance_x, distance_y, extent_x, extent_y;  // m, doubled
  double distance_aside, extent_aside;                // m^2: doubled m, times the segment's length
};

// Whether the segment a-b touches the shape (boundary counts). The answer for b-a is the same.
inline bool SegmentTouches(const OrientedBox& box, const Vec2& a, const Vec2& b) {
  const SeparatingAxes axes(box, a, b);
  return axes.distance_x <= axes.extent_x && axes.distance_y <= axes.extent_y &&
         axes.distance_aside <= axes.extent_aside;
}

// At most the distance (m) from the segment a-b to the box; positive unless SegmentTouches, but for rounding.
inline double SegmentGap(const OrientedBox& box, const Vec2& a, const Vec2& b) {
  // The widest gap along one of the separating axes.
  const SeparatingAxes axes(box, a, b);
  const double along_axes = std::fmax(axes.distance_x - axes.extent_x, axes.distance_y - axes.extent_y);
  const double length = std::sqrt(axes.extent.squaredNorm());
  const double aside = axes.distance_aside - axes.extent_aside;
  const double twice = length > 0.0 ? std::fmax(along_axes, aside / length) : along_axes;
  return twice > 0.0 ? 0.5 * twice : 0.0;
}

// How deep in the box (m from its edge) some point of the segment a-b lies; 0 when none does.
inline double SegmentDepth(const OrientedBox& box, const Vec2& a, const Vec2& b) {
  // The middle of the part inside, which has its ends on the box's edge or at the segment's ends.
  const Vec2 from = ToLocal(box, a);
  const Vec2 way = ToLocal(box, b) - from;
  double enter = 0.0;
  double leave = 1.0;
  for (int axis = 0; axis < 2; ++axis) {
    if (way[axis] == 0.0) continue;
    const double half = std::copysign(box.half_extents[axis], way[axis]);
    enter = std::fmax(enter, (-half - from[axis]) / way[axis]);
    leave = std::fmin(leave, (half - from[axis]) / way[axis]);
  }
  const Vec2 middle = from + 0.5 * (enter + leave) * way;
  const double depth =
      std::fmin(box.half_extents.x() - std::fabs(middle.x()), box.half_extents.y() - std::fabs(middle.y()));
  return enter <= leave && depth > 0.0 ? depth : 0.0;
}

inline bool SegmentTouches(const Vec2& disc_center, double disc_radius, const Vec2& a, const Vec2& b) {
  const Vec2 segment = b - a;
  const Vec2 from_a = disc_center - a;
  const Vec2 from_b = disc_center - b;
  const double squared_radius = disc_radius * disc_radius;
  if (from_a.squaredNorm() <= squared_radius || from_b.squaredNorm() <= squared_radius) return true;
  if (from_a.dot(segment) <= 0.0 || from_b.dot(segment) >= 0.0) return false;
  const double cross = Cross(segment, from_a);
  return cross * cross <= squared_radius * segment.squaredNorm();
}

}  // namespace gauntlet::sim
