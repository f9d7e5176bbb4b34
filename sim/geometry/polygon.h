// Convex polygons, as they arise when a box is clipped at the edge of the arena.
#pragma once

#include <vector>

#include "sim/geometry/oriented_box.h"
#include "sim/geometry/vec2.h"

namespace gauntlet::sim {

using Polygon = std::vector<Vec2>;  // corners counter-clockwise; empty = nothing left

// The part of the box inside the axis-aligned rectangle [min, max] (Sutherland and Hodgman 1974).
Polygon ClipToRectangle(const OrientedBox& box, const Vec2& min, const Vec2& max);
// Area by the shoelace formula, m^2.
double Area(const Polygon& polygon);

}  // namespace gauntlet::sim
