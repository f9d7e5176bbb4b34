#include "sim/physics/differential_drive.h"

#include <cmath>

namespace gauntlet::sim {
namespace {

constexpr double kMaxVelocityChange = foot_bot::kMaxForce * foot_bot::kSubstep / foot_bot::kMass;  // m/s
constexpr int kSubstepsPerHalf = foot_bot::kSubstepsPerTick / 2;

}  // namespace

DriveMotion Drive(const DriveState& start, const WheelSpeeds& command, const Vec2& direction) {
  const Vec2 target = (command.left + command.right) / 2.0 * direction;
  const double target_rate = (command.right - command.left) / foot_bot::kWheelDistance;

  DriveMotion motion;
  Vec2 velocity = start.velocity;
  for (int half = 0; half < 2; ++half) {
    Vec2 displacement = Vec2::Zero();
    int substep = 0;
    for (; substep < kSubstepsPerHalf && velocity != target; ++substep) {
      displacement += velocity * foot_bot::kSubstep;
      const Vec2 missing = target - velocity;
      const double distance = std::sqrt(missing.squaredNorm());
      velocity =
          distance > kMaxVelocityChange ? Vec2(velocity + missing * (kMaxVelocityChange / distance)) : target;
    }
    displacement += velocity * (foot_bot::kSubstep * (kSubstepsPerHalf - substep));
    motion.halves[static_cast<std::size_t>(half)] = displacement;
  }
  motion.turn = start.turn_rate * foot_bot::kSubstep + target_rate * (kTickSeconds - foot_bot::kSubstep);
  motion.end = {velocity, target_rate};
  return motion;
}

}  // namespace gauntlet::sim
