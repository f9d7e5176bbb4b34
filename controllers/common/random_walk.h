// Wandering: straight on, and now and then a new heading (Buchanan's dps code).
#pragma once

#include "controllers/common/steering.h"
#include "sim/random/random_stream.h"
#include "sim/robot/foot_bot.h"

namespace gauntlet::controllers {

struct RandomWalkParameters {
  double turn_probability = 0.0;  // per tick
  double turn_limit = 0.0;        // rad; a new heading differs by up to this much to either side
};

// One robot's random walk. It remembers the angle still to be turned; a robot has no compass, so the angle is
// dead-reckoned from the turns that its controller reports.
class RandomWalk {
 public:
  explicit RandomWalk(const RandomWalkParameters& parameters) : parameters_(parameters) {}

  // Drives the walk's bearing of this tick and reports the turn to itself: all that wandering takes.
  DriveCommand Drive(double speed, const SteeringThresholds& steering, sim::RandomStream& random) {
    const DriveCommand command = Steer(Next(random), speed, steering);
    if (command.turn == 0.0) {
      Reset();
    } else {
      Turned(command.turn * sim::kTickSeconds);
    }
    return command;
  }
  // Still turning to a heading that it took.
  bool turning() const { return remaining_ != 0.0; }

  // The bearing to take in this tick, rad. Draws once or twice from `random`.
  double Next(sim::RandomStream& random) {
    if (random.Chance(parameters_.turn_probability)) {
      remaining_ = random.Uniform(-parameters_.turn_limit, parameters_.turn_limit);
    }
    return remaining_;
  }
  // Takes a heading that differs by `angle` rad from the present one.
  void TurnBy(double angle) { remaining_ = angle; }
  // The controller commanded a turn of `angle` rad for the coming tick.
  void Turned(double angle) { remaining_ -= angle; }
  // The way is straight on from here: after the bearing was reached, or after something else steered.
  void Reset() { remaining_ = 0.0; }

 private:
  RandomWalkParameters parameters_;
  double remaining_ = 0.0;
};

}  // namespace gauntlet::controllers
