// From an experiment to its search.
#pragma once

#include <cstdint>
#include <memory>

#include "base/result.h"
#include "master/experiment/experiment.h"
#include "master/search/search_algorithm.h"
#include "sim/arena/validity.h"

namespace gauntlet::master {

// What the experiment's scenario, looked up in controllers/registry.h, demands of its arenas. Error: there is
// no such scenario.
Result<sim::ArenaRequirements> RequirementsOf(const Experiment& experiment);

// Whether the experiment's swarm, with its noise and faults, can begin in this arena
// (controllers::CountSwarm).
Status CheckSwarmFits(const Experiment& experiment, const sim::TestCase& test_case);

// The search that experiment.search describes; `search_id` is its number within the campaign and part of all
// its random keys. Error: the ranges of genes leave no room for a valid case, or search.algorithm is "cases",
// which needs a list (CaseListSearch).
Result<std::unique_ptr<SearchAlgorithm>> MakeSearch(const Experiment& experiment, std::uint32_t search_id);
Result<std::unique_ptr<SearchAlgorithm>> MakeSearch(const Experiment& experiment,
                                                    const sim::ArenaRequirements& requirements,
                                                    std::uint32_t search_id);

}  // namespace gauntlet::master
