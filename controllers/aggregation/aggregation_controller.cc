#include "controllers/aggregation/aggregation_controller.h"

#include <algorithm>
#include <cmath>

#include "controllers/aggregation/aggregation_scenario.h"  // kBeaconColor
#include "sim/geometry/trigonometry.h"

namespace gauntlet::controllers::aggregation {
namespace {

using sim::kDegree;

// Of the random walk of who leaves; those of foraging (Buchanan's dps code).
constexpr RandomWalkParameters kWalk = {.turn_probability = 0.05, .turn_limit = 115.0 * kDegree};
constexpr double kTurnRate = 1.0;  // rad/s, on the spot
constexpr SteeringThresholds kSteering = {
    .straight = 10.0 * kDegree, .hard = 70.0 * kDegree, .turn_rate = kTurnRate};

TurnAsideSettings AvoidanceOf(const AggregationSettings& settings) {
  return {.near_distance = 0.05,
          .clear_distance = 0.08,
          .front_angle = 60.0 * kDegree,
          .speed = settings.speed,
          .turn_rate = kTurnRate,
          .escape_ticks = 5,
          .random_side = true};
}

}  // namespace

bool SeesRobotAhead(std::span<const sim::Blob> blobs) {
  return std::ranges::any_of(blobs, [](const sim::Blob& blob) {
    return blob.color == kBeaconColor && blob.position.x() > 0.0 &&
           std::abs(blob.position.y()) <= sim::foot_bot::kRadius;
  });
}

int CountNeighbours(std::span<const sim::Blob> blobs, double range) {
  return static_cast<int>(std::ranges::count_if(
      blobs, [&](const sim::Blob& blob) { return blob.color == kBeaconColor && blob.range <= range; }));
}

AggregationController::AggregationController(const AggregationSettings& settings)
    : settings_(settings), walk_(kWalk), avoidance_(AvoidanceOf(settings)) {}

sim::DeviceSet AggregationController::Devices() const {
  const sim::DeviceSet always =
      sim::Device::kWheels | sim::Device::kLeds | sim::Device::kOmnidirectionalCamera;
  return settings_.quorum > 0 ? always | sim::Device::kProximity : always;
}

DriveCommand AggregationController::Walk(const sim::ControlStep& step) {
  if (const auto aside = avoidance_.Next(step.readings.proximity, step.random)) {
    walk_.Reset();
    return *aside;
  }
  return walk_.Drive(settings_.speed, kSteering, step.random);
}

void AggregationController::Step(const sim::ControlStep& step) {
  step.actuators.beacon = kBeaconColor;
  if (settings_.quorum > 0 && walk_left_ == 0 &&
      CountNeighbours(step.readings.blobs, settings_.near_range) < settings_.quorum &&
      step.random.Chance(settings_.leave_rate * sim::kTickSeconds)) {
    walk_left_ = settings_.walk_ticks;
  }
  if (walk_left_ > 0) {
    --walk_left_;
    const DriveCommand command = Walk(step);
    step.actuators.Drive(command.forward, command.turn);
    return;
  }
  const bool sees_robot = SeesRobotAhead(step.readings.blobs);
  step.actuators.left_wheel = settings_.speed * (sees_robot ? settings_.seeing_left : settings_.alone_left);
  step.actuators.right_wheel =
      settings_.speed * (sees_robot ? settings_.seeing_right : settings_.alone_right);
}

}  // namespace gauntlet::controllers::aggregation
