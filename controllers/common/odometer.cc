#include "controllers/common/odometer.h"

#include "sim/geometry/trigonometry.h"

namespace gauntlet::controllers {
namespace {

sim::Vec2 Rotated(const sim::Vec2& v, double angle) {
  const sim::SinCos sc = sim::SineCosine(angle);
  return {sc.cos * v.x() - sc.sin * v.y(), sc.sin * v.x() + sc.cos * v.y()};
}

}  // namespace

sim::Vec2 AfterMotion(const sim::Vec2& point, const BodyMotion& motion) {
  return Rotated(point - motion.shift, -motion.turn);
}

BodyOdometer::BodyOdometer(const sim::Headquarters& headquarters, sim::RobotIndex robot,
                           const sim::Pose& start)
    : headquarters_(headquarters), robot_(robot), last_(start) {}

BodyMotion BodyOdometer::Next() {
  const sim::Pose now = headquarters_.PoseOf(robot_);
  BodyMotion motion;
  motion.shift = Rotated(now.position - last_.position, -last_.heading);
  motion.turn = sim::WrapAngle(now.heading - last_.heading);
  last_ = now;
  return motion;
}

}  // namespace gauntlet::controllers
