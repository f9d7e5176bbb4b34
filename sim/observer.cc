#include "sim/observer.h"

#include "base/check.h"

namespace gauntlet::sim {

Observer::Observer(int robots, Tick tick_limit, std::size_t moving_obstacles)
    : robots_(robots), moving_obstacles_(moving_obstacles) {
  obstacles_.reserve(moving_obstacles * (static_cast<std::size_t>(tick_limit) + 1));
  states_.reserve(static_cast<std::size_t>(robots) * (static_cast<std::size_t>(tick_limit) + 1));
}

void Observer::Record(std::span<const RobotState> states, std::span<const Vec2> obstacles) {
  GAUNTLET_CHECK(states.size() == static_cast<std::size_t>(robots_), "one state per robot");
  GAUNTLET_CHECK(obstacles.size() == moving_obstacles_, "one centre per moving obstacle");
  obstacles_.insert(obstacles_.end(), obstacles.begin(), obstacles.end());
  states_.insert(states_.end(), states.begin(), states.end());
}

}  // namespace gauntlet::sim
