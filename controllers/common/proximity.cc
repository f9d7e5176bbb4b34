#include "controllers/common/proximity.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include "sim/geometry/trigonometry.h"

namespace gauntlet::controllers {
namespace {

// ARGoS footbot_proximity_default.
constexpr double kSaturated = 0.009889556;  // m
constexpr double kScale = 0.0100527;
constexpr double kOffset = 0.000163144;

constexpr double kBodyReach =
    0.30;  // m between centres; a robot's body is beyond the ring's range farther off
constexpr double kBodyAside = 0.10;  // m, a ray that passes a robot's centre nearer than this hits it

// Most robots have nothing near: the bits of all readings at once, which the compiler puts into few
// registers.
bool NothingNear(const ProximityReadings& readings) {
  std::uint64_t bits = 0;
  for (const double reading : readings) bits |= std::bit_cast<std::uint64_t>(reading);
  return bits == 0;
}

bool LooksAt(const sim::Vec2& direction, double range, const sim::Vec2& body_direction) {
  const double along = direction.dot(body_direction);
  const double aside = std::fabs(sim::Cross(direction, body_direction)) * range;
  return along > 0.0 && aside <= kBodyAside;
}

}  // namespace

const std::array<sim::Vec2, sim::foot_bot::kProximitySensors>& ProximityDirections() {
  static const auto directions = [] {
    std::array<sim::Vec2, sim::foot_bot::kProximitySensors> result;
    for (int i = 0; i < sim::foot_bot::kProximitySensors; ++i) {
      result[static_cast<std::size_t>(i)] = sim::UnitVector(sim::ProximityBearing(i));
    }
    return result;
  }();
  return directions;
}

double ProximityReadingAt(double distance) {
  return distance < kSaturated ? 1.0 : kScale / (distance + kOffset);
}

double ProximityDistanceOf(double reading) {
  return std::max(0.0, kScale / reading - kOffset);
}

double FrontReading(const ProximityReadings& readings, double half_angle) {
  double largest = 0.0;
  if (NothingNear(readings)) return largest;
  for (int i = 0; i < sim::foot_bot::kProximitySensors; ++i) {
    const double reading = readings[static_cast<std::size_t>(i)];  // most are 0: cheaper to ask first
    if (reading > largest && std::fabs(sim::ProximityBearing(i)) <= half_angle) largest = reading;
  }
  return largest;
}

ProximityReadings WithoutBodies(const ProximityReadings& readings, std::span<const SeenBody> bodies) {
  const auto& directions = ProximityDirections();
  ProximityReadings result = readings;
  if (NothingNear(readings)) return result;
  for (const SeenBody& body : bodies) {
    if (body.range >= kBodyReach) continue;
    const sim::Vec2 body_direction = sim::UnitVector(body.bearing);
    for (std::size_t i = 0; i < result.size(); ++i) {
      if (result[i] != 0.0 && LooksAt(directions[i], body.range, body_direction)) result[i] = 0.0;
    }
  }
  return result;
}

ProximitySum SumProximity(const ProximityReadings& readings) {
  ProximitySum result;
  if (NothingNear(readings)) return result;
  const auto& directions = ProximityDirections();
  for (std::size_t i = 0; i < readings.size(); ++i) {
    if (readings[i] == 0.0) continue;
    result.sum += readings[i] * directions[i];
    result.largest = std::max(result.largest, readings[i]);
  }
  return result;
}

}  // namespace gauntlet::controllers
