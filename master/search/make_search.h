// From an experiment to its search.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "base/result.h"
#include "master/experiment/experiment.h"
#include "master/search/search_algorithm.h"

namespace gauntlet::master {

// Whether the experiment's swarm, with its noise and faults, can begin in this arena
// (controllers::CountSwarm).
Status CheckSwarmFits(const Experiment& experiment, const sim::TestCase& test_case);

// The search that experiment.search describes; `search_id` is its number within the campaign and part of all
// its random keys; `cases` are for the search through given cases (SearchRow::given_cases), which needs them.
// Error: there is no such scenario, no run could begin, or the ranges of genes leave no room for a valid
// case.
Result<std::unique_ptr<SearchAlgorithm>> MakeSearch(const Experiment& experiment, std::uint32_t search_id,
                                                    std::vector<sim::TestCase> cases = {});

}  // namespace gauntlet::master
