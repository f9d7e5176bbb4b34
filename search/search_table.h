// One table of searches: whatever differs from search to search and is not its algorithm stands in its row. A
// new search is a class of its own (mostly a PopulationSearch), a function that gives its row beside it, a
// line in search_table.cc and one in CMakeLists.txt.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "base/result.h"
#include "search/experiment/schema.h"
#include "search/search_algorithm.h"
#include "search/search_setup.h"
#include "sim/random/random_stream.h"

namespace gauntlet {

struct SearchRow {
  SearchInfo info;  // what experiments may say of it: name, keys, rules between them
  // Part of the key of its random numbers: take the next that no row has. Searches that share one begin with
  // the same random cases. Stored campaigns depend on it: do not renumber.
  std::uint32_t number = 0;
  std::string_view title;    // "genetic search"
  std::string_view members;  // of what its population consists: "population", "cases"
  // What an experiment makes it do, behind the title: "20 test cases x 50 generations".
  std::string (*plan)(const Experiment& experiment) = nullptr;
  // Error: the ranges of genes leave no room for a valid case, or there is nothing to search.
  Result<std::unique_ptr<SearchAlgorithm>> (*make)(const SearchSetup& setup) = nullptr;
  sim::SeedPurpose purpose = sim::SeedPurpose::kSearch;  // of the seeds of its runs
  bool given_cases = false;  // goes through SearchSetup::cases; made by `command` alone
  std::string_view command = "evaluate";
  // The seeds of a run follow from its case, not from its individual's number: a case has the same ones at
  // any place of a list, and so have clones.
  bool seeds_of_cases = false;
};

std::span<const SearchRow> Searches();
// nullptr when there is none of that name.
const SearchRow* FindSearch(std::string_view name);
// The row of experiment.search.algorithm, which must be there.
const SearchRow& RowOf(const Experiment& experiment);

// What an experiment may name in this program: the scenarios and controllers of controllers/registry.h and
// the searches of this table.
const Catalogue& BuiltInCatalogue();

// Whether the experiment's swarm, with its noise and faults, can begin in this arena
// (controllers::CountSwarm).
Status CheckSwarmFits(const Experiment& experiment, const sim::TestCase& test_case);

// The search that experiment.search describes; `search_id` is its number within the campaign and part of all
// its random keys; `cases` are for a search through given cases (SearchRow::given_cases), which needs them.
// Error: there is no such scenario, no run could begin, or the ranges of genes leave no room for a valid
// case.
Result<std::unique_ptr<SearchAlgorithm>> MakeSearch(const Experiment& experiment, std::uint32_t search_id,
                                                    std::vector<sim::TestCase> cases = {});

// SearchRow::make of a class with a static Create.
template <typename Search>
Result<std::unique_ptr<SearchAlgorithm>> Make(const SearchSetup& setup) {
  TRY(auto search, Search::Create(setup));
  return std::unique_ptr<SearchAlgorithm>(std::move(search));
}

}  // namespace gauntlet
