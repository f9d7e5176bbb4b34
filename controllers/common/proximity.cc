#include "controllers/common/proximity.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

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
  for (int i = 0; i < sim::foot_bot::kProximitySensors; ++i) {
    const double reading = readings[static_cast<std::size_t>(i)];  // most are 0: cheaper to ask first
    if (reading > largest && std::fabs(sim::ProximityBearing(i)) <= half_angle) largest = reading;
  }
  return largest;
}

ProximityReadings WithoutBodies(const ProximityReadings& readings, std::span<const SeenBody> bodies) {
  const auto& directions = ProximityDirections();
  ProximityReadings result = readings;
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
  for (std::size_t i = 0; i < readings.size(); ++i) {
    if (readings[i] == 0.0) continue;
    result.sum += readings[i] * ProximityDirections()[i];
    result.largest = std::max(result.largest, readings[i]);
  }
  return result;
}

}  // namespace gauntlet::controllers
