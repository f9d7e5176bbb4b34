// The simulation loop: act, physics, observe, sense, control; tick order as in ARGoS3 (commands of tick t
// move the robot in tick t + 1).
#pragma once

#include <cstdint>

#include "sim/run_result.h"
#include "sim/scenario.h"

namespace gauntlet::sim {

// Simulates the scenario to its end. A function of the scenario and the seed alone. Never throws; a refusal
// is a verdict.
RunResult Simulate(Scenario& scenario, std::uint64_t seed, bool record_trajectory);

}  // namespace gauntlet::sim
