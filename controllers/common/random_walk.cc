#include "controllers/common/random_walk.h"

#include "sim/robot/foot_bot.h"

namespace gauntlet::controllers {

DriveCommand RandomWalk::Drive(double speed, const SteeringThresholds& steering, sim::RandomStream& random) {
  const DriveCommand command = Steer(Next(random), speed, steering);
  if (command.turn == 0.0) {
    Reset();
  } else {
    Turned(command.turn * sim::kTickSeconds);
  }
  return command;
}

double RandomWalk::Next(sim::RandomStream& random) {
  if (random.Chance(parameters_.turn_probability)) {
    remaining_ = random.Uniform(-parameters_.turn_limit, parameters_.turn_limit);
  }
  return remaining_;
}

}  // namespace gauntlet::controllers
