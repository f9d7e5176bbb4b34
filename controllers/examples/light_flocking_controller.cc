#include "controllers/examples/light_flocking_controller.h"

#include <algorithm>
#include <cmath>

#include "controllers/common/proximity.h"
#include "controllers/examples/light_flocking_scenario.h"
#include "sim/geometry/trigonometry.h"

namespace gauntlet::controllers::light_flocking {
namespace {

using sim::Vec2;

constexpr double kLeastDistance = 0.01;  // m; centres are never this near, and a force stays finite

double Power(double base, int exponent) {
  double result = 1.0;
  for (int i = 0; i < exponent; ++i) result *= base;
  return result;
}

// Towards a flockmate at `distance`, m/s.
double Attraction(double distance, const LightFlockingSettings& settings) {
  const double far = std::max(distance, kLeastDistance);
  const double term = Power(settings.target_distance / far, settings.exponent);
  return settings.gain / far * (term - term * term);
}

}  // namespace

Vec2 FlockingVelocity(std::span<const sim::Blob> blobs, const LightFlockingSettings& settings) {
  Vec2 sum = Vec2::Zero();
  int count = 0;
  for (const sim::Blob& blob : blobs) {
    if (blob.color != kFlockmateColor) continue;
    if (blob.range >= settings.cutoff * settings.target_distance) continue;
    if (blob.range > 0.0) sum += Attraction(blob.range, settings) / blob.range * blob.position;
    ++count;
  }
  if (count == 0) return Vec2::Zero();
  sum /= count;
  const double speed = std::sqrt(sum.squaredNorm());
  return speed > settings.max_speed ? Vec2(sum * (settings.max_speed / speed)) : sum;
}

Vec2 LightVelocity(std::span<const double> readings, const LightFlockingSettings& settings) {
  Vec2 sum = Vec2::Zero();
  const auto& directions = ProximityDirections();
  for (std::size_t i = 0; i < readings.size(); ++i) sum += readings[i] * directions[i];
  const double length = std::sqrt(sum.squaredNorm());
  if (length <= 0.0) return Vec2::Zero();
  return sum * (settings.light_share * settings.max_speed / length);
}

sim::DeviceSet LightFlockingController::Devices() const {
  return sim::Device::kWheels | sim::Device::kLeds | sim::Device::kOmnidirectionalCamera |
         sim::Device::kLight;
}

void LightFlockingController::Step(const sim::ControlStep& step) {
  const Vec2 velocity =
      FlockingVelocity(step.readings.blobs, settings_) + LightVelocity(step.readings.light, settings_);
  step.actuators.beacon = kFlockmateColor;
  Drive(velocity, step.actuators);
}

void LightFlockingController::Drive(const Vec2& velocity, sim::Actuators& actuators) {
  const double bearing = sim::AngleOf(velocity);
  const double angle = std::fabs(bearing);
  const double speed = std::min(std::sqrt(velocity.squaredNorm()), settings_.max_speed);
  if (turning_ == Turning::kHard && angle <= settings_.soft_turn) turning_ = Turning::kSoft;
  if (turning_ != Turning::kHard) {
    turning_ = angle > settings_.hard_turn ? Turning::kHard
               : angle > settings_.no_turn ? Turning::kSoft
                                           : Turning::kNone;
  }

  double inner = speed;
  double outer = speed;
  if (turning_ == Turning::kSoft) {
    const double share = angle / settings_.hard_turn;
    inner = speed * (1.0 - share);
    outer = speed * (1.0 + share);
  } else if (turning_ == Turning::kHard) {
    inner = -settings_.max_speed;
    outer = settings_.max_speed;
  }
  actuators.left_wheel = bearing > 0.0 ? inner : outer;
  actuators.right_wheel = bearing > 0.0 ? outer : inner;
}

}  // namespace gauntlet::controllers::light_flocking
