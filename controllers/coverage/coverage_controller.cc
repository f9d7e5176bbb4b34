#include "controllers/coverage/coverage_controller.h"

#include <algorithm>
#include <cmath>

#include "controllers/common/proximity.h"
#include "controllers/coverage/coverage_scenario.h"  // kStandingMessage
#include "sim/geometry/trigonometry.h"

namespace gauntlet::controllers::coverage {

sim::Vec2 FieldForce(const sim::SensorReadings& readings, const CoverageSettings& settings) {
  constexpr double kLeastRange = 0.01;  // m; centres are never this near, and the force stays finite
  const double far = 1.0 / (settings.neighbour_range * settings.neighbour_range);
  sim::Vec2 force = -settings.obstacle_push * SumProximity(readings.proximity).sum;
  for (const sim::Message& message : readings.range_and_bearing) {
    if (message.range >= settings.neighbour_range) continue;
    const double range = std::max(message.range, kLeastRange);
    force -= (1.0 / (range * range) - far) / range * message.position;
  }
  return force;
}

// Turns on the spot with one wheel each way at full speed, however weak the force.
CoverageController::CoverageController(const CoverageSettings& settings)
    : settings_(settings),
      steering_({.straight = 10.0 * sim::kDegree,
                 .hard = 70.0 * sim::kDegree,
                 .turn_rate = 2.0 * settings.max_speed / sim::foot_bot::kWheelDistance}),
      walk_(settings.walk.value_or(RandomWalkParameters{})) {}

sim::DeviceSet CoverageController::Devices() const {
  return sim::Device::kWheels | sim::Device::kProximity | sim::Device::kRangeAndBearing;
}

void CoverageController::Step(const sim::ControlStep& step) {
  const sim::Vec2 velocity = settings_.gain * FieldForce(step.readings, settings_);
  const double speed = std::min(std::sqrt(velocity.squaredNorm()), settings_.max_speed);
  const bool at_rest = speed < settings_.rest_speed;
  DriveCommand command;
  if (!at_rest) {
    walk_.Reset();
    command = Steer(sim::AngleOf(velocity), speed, steering_);
  } else if (settings_.walk) {
    command = walk_.Drive(settings_.max_speed, steering_, step.random);
  }
  step.actuators.message = at_rest && !settings_.walk ? kStandingMessage : sim::Payload{};
  step.actuators.Drive(command.forward, command.turn);
}

}  // namespace gauntlet::controllers::coverage
