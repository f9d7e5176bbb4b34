#include "controllers/partitioning/odometer.h"

#include <cmath>

#include "sim/geometry/trigonometry.h"

namespace gauntlet::controllers {
namespace {

sim::Vec2 Rotated(const sim::Vec2& v, double angle) {
  const sim::SinCos sc = sim::SineCosine(angle);
  return {sc.cos * v.x() - sc.sin * v.y(), sc.sin * v.x() + sc.cos * v.y()};
}

// Inverse of the distribution function 1 - exp(-x^2 / (2 scale^2)).
double DrawRayleigh(double scale, sim::RandomStream& random) {
  return scale * std::sqrt(-2.0 * sim::Log(1.0 - random.Uniform()));
}

}  // namespace

sim::Vec2 AfterMotion(const sim::Vec2& point, const BodyMotion& motion) {
  return Rotated(point - motion.shift, -motion.turn);
}

BodyOdometer::BodyOdometer(const sim::Headquarters& headquarters, sim::RobotIndex robot,
                           const sim::Pose& start, double drift)
    : headquarters_(headquarters), robot_(robot), last_(start), drift_(drift) {}

BodyMotion BodyOdometer::Next() {
  const sim::Pose now = headquarters_.PoseOf(robot_);
  BodyMotion motion;
  motion.shift = Rotated(now.position - last_.position, -last_.heading);
  motion.turn = sim::WrapAngle(now.heading - last_.heading);
  last_ = now;
  if (drift_ == 0.0) return motion;
  const double half = motion.turn * sim::foot_bot::kWheelDistance / 2.0;
  const double left = (motion.shift.x() - half) * (1.0 + left_error_);
  const double right = (motion.shift.x() + half) * (1.0 + right_error_);
  motion.shift.x() = (left + right) / 2.0;
  motion.turn = (right - left) / sim::foot_bot::kWheelDistance;
  return motion;
}

void BodyOdometer::BeginTrip(sim::RandomStream& random) {
  if (drift_ == 0.0) return;
  const double error = DrawRayleigh(drift_, random);
  const bool left = random.Chance(0.5);
  left_error_ = left ? error : 0.0;
  right_error_ = left ? 0.0 : error;
}

}  // namespace gauntlet::controllers
