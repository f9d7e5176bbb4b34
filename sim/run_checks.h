// What a run refuses: swarms, surroundings and outcomes that are no numbers or beyond what is simulated.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "sim/scenario.h"

namespace gauntlet::sim {

// "robot 7"
std::string RobotName(std::size_t robot);

// Why this swarm cannot be simulated in this arena, naming robot, tick and value, or nothing.
std::optional<std::string> RefuseSwarm(const Arena& arena, const std::vector<RobotSetup>& swarm);

// Which light or radio beacon is no number at `tick`, or nothing. Both may change from tick to tick.
std::optional<std::string> CheckSurroundings(const Surroundings& surroundings, Tick tick);

// What of an outcome is not finite, or nothing: no result holds a NaN.
std::optional<std::string> CheckOutcome(const Outcome& outcome, Tick tick);

}  // namespace gauntlet::sim
