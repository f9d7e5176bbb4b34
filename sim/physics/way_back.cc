#include "sim/physics/way_back.h"

#include <algorithm>
#include <cmath>

#include "sim/physics/physics_engine.h"

namespace gauntlet::sim {
namespace {

constexpr int kSubsteps = foot_bot::kSubstepsPerTick / kStepsPerTick;
// Deeper contacts than Box2D's slop are cut, the solver would push them out.
constexpr double kDeepestBite = 0.0005;  // m

// The first positive overlap at the ends of the substeps of a step, at most kDeepestBite. `overlap_at` tells
// the overlap (m) after a share of the step; it is positive at the end.
template <typename OverlapAt>
double DepthWhenNoticed(const OverlapAt& overlap_at) {
  int substep = 1;
  while (substep < kSubsteps && overlap_at(static_cast<double>(substep) / kSubsteps) <= 0.0) ++substep;
  return std::min(overlap_at(static_cast<double>(substep) / kSubsteps), kDeepestBite);
}

Vec2 ClosestPoint(const OrientedBox& box, const Vec2& p) {
  const Vec2 local = ToLocal(box, p).cwiseMax(-box.half_extents).cwiseMin(box.half_extents);
  return box.center + local.x() * box.axis + local.y() * LeftOf(box.axis);
}

}  // namespace

Vec2 WayBack(const OrientedBox& box, const StepWay& robot) {
  const Vec2 outward = robot.to - ClosestPoint(box, robot.to);
  const double distance_squared = outward.squaredNorm();
  constexpr double kContact = foot_bot::kRadius;
  if (distance_squared >= kContact * kContact || distance_squared == 0.0 ||
      Distance(box, robot.from) <= kContact) {
    return Vec2::Zero();
  }
  const double distance = std::sqrt(distance_squared);
  const double bite = DepthWhenNoticed(
      [&](double share) { return kContact - Distance(box, robot.from + share * (robot.to - robot.from)); });
  return (kContact - bite - distance) / distance * outward;
}

std::optional<WaysBack> WaysApart(const StepWay& a, bool a_held, const StepWay& b, bool b_held) {
  const Vec2 apart = a.to - b.to;
  const double distance_squared = apart.squaredNorm();
  constexpr double kContact = 2.0 * foot_bot::kRadius;
  const Vec2 apart_before = a.from - b.from;
  if (distance_squared >= kContact * kContact || distance_squared == 0.0 ||
      apart_before.squaredNorm() <= kContact * kContact) {
    return std::nullopt;
  }
  const double distance = std::sqrt(distance_squared);
  const Vec2 normal = apart / distance;
  const double a_closing = a_held ? 0.0 : std::max(normal.dot(a.from - a.to), 0.0);
  const double b_closing = b_held ? 0.0 : std::max(normal.dot(b.to - b.from), 0.0);
  if (a_closing + b_closing == 0.0) return std::nullopt;
  const double bite = DepthWhenNoticed([&](double share) {
    return kContact - std::sqrt((apart_before + share * (apart - apart_before)).squaredNorm());
  });
  const Vec2 excess = (kContact - bite - distance) / (a_closing + b_closing) * normal;
  return WaysBack{a_closing * excess, -b_closing * excess};
}

}  // namespace gauntlet::sim
