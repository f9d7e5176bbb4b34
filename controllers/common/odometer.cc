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

Odometer OdometerOf(const sim::Headquarters& headquarters, sim::RobotIndex robot, const sim::Pose& start) {
  return [&headquarters, robot, last = start]() mutable {
    const sim::Pose now = headquarters.PoseOf(robot);
    const BodyMotion motion = {Rotated(now.position - last.position, -last.heading),
                               sim::WrapAngle(now.heading - last.heading)};
    last = now;
    return motion;
  };
}

}  // namespace gauntlet::controllers
