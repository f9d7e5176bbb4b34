// One table of searches. A new search is a class of its own (mostly a PopulationSearch), a function that
// gives its row beside it, a line in search_table.cc and one in CMakeLists.txt.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string_view>
#include <vector>

#include "base/result.h"
#include "search/search_row.h"

namespace gauntlet {

std::span<const SearchRow> Searches();
// nullptr when there is none of that name.
const SearchRow* FindSearch(std::string_view name);
// The row of experiment.search.algorithm, which must be there.
const SearchRow& RowOf(const Experiment& experiment);

// What an experiment may name in this program: the scenarios and controllers of controllers/registry.h and
// the searches of this table.
const Catalogue& BuiltInCatalogue();
// CommonKeys of it.
const std::vector<Key>& BuiltInKeys();
// The same and those of the parameters of the experiment's scenario and controller, where these are known.
std::vector<Key> AllKeysOf(const Experiment& experiment);

// What the search that the experiment describes starts from.
SearchSetup SetupOf(const Experiment& experiment, const sim::ArenaRequirements& requirements = {},
                    std::vector<sim::TestCase> cases = {});

// The seed of replicate 0, 1, ... of an evaluation. It depends on the numbers of these and of the individual
// and on the experiment's seed alone, so a search of a sweep has the seeds that it would have in a campaign
// of its own. Where seeds are those of cases (SearchRow::seeds_of_cases) the arena, robots and obstacles
// count instead of the individual's number, so that a case has the same seeds at any place of the list (and
// the same case given twice, whatever its name, the same runs).
std::uint64_t RunSeed(const Experiment& experiment, const EvaluationRequest& evaluation,
                      std::uint32_t replicate);

// What is simulated as that replicate: every run of a search has its spec from here.
sim::RunSpec SpecOfRun(const Experiment& experiment, const EvaluationRequest& evaluation,
                       std::uint32_t replicate);

// Whether the experiment's swarm, with its noise and faults, can begin in this arena
// (controllers::CountSwarm).
Status CheckSwarmFits(const Experiment& experiment, const sim::TestCase& test_case);

// The search that experiment.search describes; `cases` are for a search through given cases
// (SearchRow::given_cases), which needs them.
// Error: there is no such scenario, no run could begin, or the ranges of genes leave no room for a valid
// case.
Result<std::unique_ptr<SearchAlgorithm>> MakeSearch(const Experiment& experiment,
                                                    std::vector<sim::TestCase> cases = {});

}  // namespace gauntlet
