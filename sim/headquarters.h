// Headquarters (thesis 3.3.3.2): the one explicit door through which a scenario hands global information to a
// robot. The prey of the flocking scenario is given one, and the odometers of task partitioning, which tell
// their robot its own motion only.
#pragma once

#include "sim/arena/arena.h"
#include "sim/observer.h"

namespace gauntlet::sim {

class Headquarters {
 public:
  Headquarters(const Arena& arena, const Observer& observer) : arena_(arena), observer_(observer) {}

  const Arena& arena() const { return arena_; }
  // Pose of the robot at the newest tick.
  Pose PoseOf(RobotIndex robot) const {
    const RobotState& state = observer_.Latest()[static_cast<std::size_t>(robot)];
    return {state.position(), state.heading};
  }

 private:
  const Arena& arena_;
  const Observer& observer_;
};

}  // namespace gauntlet::sim
