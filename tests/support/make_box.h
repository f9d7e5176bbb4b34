// Boxes as tests write them.
#pragma once

#include "sim/geometry/oriented_box.h"
#include "sim/geometry/trigonometry.h"

namespace gauntlet::sim {

// `length` lies along the box's x axis before it is turned by `orientation` (rad).
inline OrientedBox MakeBox(const Vec2& center, double length, double width, double orientation) {
  return {center, {length / 2.0, width / 2.0}, UnitVector(orientation)};
}

}  // namespace gauntlet::sim
