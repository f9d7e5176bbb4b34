#include "sim/observer.h"

#include "sim/base/check.h"

namespace gauntlet::sim {

Observer::Observer(int robots, Tick tick_limit) : robots_(robots) {
  states_.reserve(static_cast<std::size_t>(robots) * (static_cast<std::size_t>(tick_limit) + 1));
}

void Observer::Record(std::span<const RobotState> states) {
  GAUNTLET_CHECK(states.size() == static_cast<std::size_t>(robots_), "one state per robot");
  states_.insert(states_.end(), states.begin(), states.end());
}

}  // namespace gauntlet::sim
