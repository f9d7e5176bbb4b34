// rapidcheck generators for geometry: finite numbers in a range, points, boxes.
#pragma once

#include <rapidcheck.h>

#include <cstdint>

#include "sim/geometry/oriented_box.h"
#include "sim/geometry/trigonometry.h"
#include "sim/geometry/vec2.h"
#include "tests/support/make_box.h"

namespace gauntlet::sim::testing {

// In [low, high], in steps of (high - low) / 10^9, so that shrinking ends at round numbers.
inline double AnyReal(double low, double high) {
  constexpr std::int64_t kSteps = 1'000'000'000;
  const auto step = *rc::gen::inRange<std::int64_t>(0, kSteps + 1);
  return low + (high - low) * (static_cast<double>(step) / static_cast<double>(kSteps));
}

inline Vec2 AnyPoint(double limit) {
  const double x = AnyReal(-limit, limit);
  return {x, AnyReal(-limit, limit)};
}

inline double AnyAngle() {
  return AnyReal(-kPi, kPi);
}

inline OrientedBox AnyBox(double limit) {
  const Vec2 center = AnyPoint(limit);
  const double length = AnyReal(0.05, 3.0);
  const double width = AnyReal(0.05, 3.0);
  return MakeBox(center, length, width, AnyAngle());
}

// The same box with every side moved outwards by `margin` (inwards when negative).
inline OrientedBox Grown(const OrientedBox& box, double margin) {
  OrientedBox grown = box;
  grown.half_extents += Vec2(margin, margin);
  return grown;
}

}  // namespace gauntlet::sim::testing
