#include "controllers/common/steering.h"

#include <algorithm>
#include <cmath>

#include "sim/geometry/trigonometry.h"
#include "sim/robot/foot_bot.h"

namespace gauntlet::controllers {

DriveCommand Steer(double bearing, double speed, const SteeringThresholds& thresholds) {
  const double angle = std::fabs(bearing);
  if (angle <= thresholds.straight) return {speed, 0.0};
  const double fastest_turn =
      thresholds.turn_rate > 0.0 ? thresholds.turn_rate : 2.0 * speed / sim::foot_bot::kWheelDistance;
  if (angle > thresholds.hard) return {0.0, std::copysign(fastest_turn, bearing)};
  const double share = angle / thresholds.hard;
  const double turn = std::min(angle / sim::kTickSeconds, fastest_turn * share);
  return {speed * (1.0 - share), std::copysign(turn, bearing)};
}

DriveCommand React(double bearing, const Reactions& reactions) {
  const double angle = std::fabs(bearing);
  if (angle <= reactions.straight_within) return {reactions.speed, 0.0};
  const double forward = angle > sim::kPi / 2.0 ? 0.0 : reactions.speed * reactions.turning_speed_factor;
  return {forward, std::copysign(reactions.turn_rate, bearing)};
}

DriveCommand React(const sim::Vec2& direction, const sim::Vec2& straight_edge, const Reactions& reactions) {
  const sim::Vec2 left(direction.x(), std::fabs(direction.y()));
  if (sim::Cross(left, straight_edge) >= 0.0) return {reactions.speed, 0.0};
  const double forward = direction.x() < 0.0 ? 0.0 : reactions.speed * reactions.turning_speed_factor;
  return {forward, direction.y() < 0.0 ? -reactions.turn_rate : reactions.turn_rate};
}

DriveCommand TurnThenDrive(double bearing, double speed, double max_turn_rate, double drive_within) {
  const double turn = std::clamp(bearing / sim::kTickSeconds, -max_turn_rate, max_turn_rate);
  return {std::fabs(bearing) < drive_within ? speed : 0.0, turn};
}

}  // namespace gauntlet::controllers
