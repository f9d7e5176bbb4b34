// Rays against boxes and discs, and lines of sight. Pure functions.
#pragma once

#include "sim/geometry/oriented_box.h"
#include "sim/geometry/vec2.h"

namespace gauntlet::sim {

inline constexpr double kNoHit = -1.0;

// Distance along the ray from `origin` in `direction` (unit vector) to the first point of the shape, or
// kNoHit when it lies farther than `range`. An origin inside the shape gives 0.
double RayHit(const OrientedBox& box, const Vec2& origin, const Vec2& direction, double range);
double RayHit(const Vec2& disc_center, double disc_radius, const Vec2& origin, const Vec2& direction,
              double range);

// Whether the segment a-b touches the shape (boundary counts).
bool SegmentTouches(const OrientedBox& box, const Vec2& a, const Vec2& b);
bool SegmentTouches(const Vec2& disc_center, double disc_radius, const Vec2& a, const Vec2& b);

}  // namespace gauntlet::sim
