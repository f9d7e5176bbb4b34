// The runs that the speed report measures: those that users make, and those whose work was measured in
// ARGoS3.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "sim/simulation.h"

namespace gauntlet::perf {

// A kind of run, with fixed seeds: the same work in every build that computes the same bits.
struct Load {
  std::string name;  // one word
  std::string what;
  std::uint64_t runs = 1;  // their seeds are 1, 2, 3, ...
  // Everything that a worker does for a run. A probe is told of every phase, the making of the scenario
  // included.
  std::function<sim::RunResult(std::uint64_t seed, const sim::SimulationOptions& options)> run;
};

// What the three shipped experiments simulate: per experiment an evolved and a random case.
std::vector<Load> ShippedLoads();
// The second of them under a requirement.
Load RequiredLoad();
// Light-flocking of 11 robots in a pocket, which ends in a jam, and of 6 robots; 20 random walkers with the
// sensors that cost most. With GAUNTLET_ARGOS_CASES in the environment, the folder of the thesis author's
// layouts, light-flocking stands in his layout `environment1` (or `env1`) instead, as it stood in ARGoS.
std::vector<Load> ArgosLoads();
// Robots that see nothing and push: the physics' worst case.
std::vector<Load> CrowdLoads();

}  // namespace gauntlet::perf
