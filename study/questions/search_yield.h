// What searches have given for their runs: in how many ways the swarm was broken, and with how few obstacles.
// Only cases count that `gauntlet confirm` has seen fail again with fresh seeds.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "base/result.h"
#include "search/experiment/experiment.h"

namespace gauntlet {

// A case that fails in at least half of its runs with fresh seeds.
struct ConfirmedCase {
  std::size_t cell = 0;  // of the grid over its scenario's descriptor axes, by these runs
  std::size_t obstacles = 0;
  std::uint64_t found = 0;  // runs of the search up to the first one in which it failed
};

// Of one search.
struct SearchYield {
  std::string place;  // the campaign's directory, with the search's number where it has several
  Experiment experiment;
  std::uint64_t runs = 0;
  std::size_t cases = 0;  // different ones that were simulated again
  std::vector<ConfirmedCase> confirmed;
};

// Cells that hold a confirmed case of at most so many obstacles.
std::size_t CellsWith(const SearchYield& yield, std::size_t most_obstacles);
// Runs after which such cases had been found in so many cells; nothing: they never were.
std::optional<std::uint64_t> RunsUntil(const SearchYield& yield, std::size_t cells,
                                       std::size_t most_obstacles);

// Searches that differ in their seeds only.
struct YieldSet {
  std::string name;   // as it was given
  std::string title;  // of the searches, "archive search"
  std::vector<SearchYield> searches;
};
// `text` is a campaign's directory, or several with commas in between. Of an archive search its elites are
// looked at, of any other all different cases that failed. Errors: those of OpenStoredCampaign; a scenario
// that does not say along which metrics failures differ; searches that differ in more than their seeds; cases
// that nobody has confirmed, with the command that does.
Result<YieldSet> ReadYields(const std::string& text);

// Why the searches may not be held against each other: they have not as many runs, or do not test the same.
Status CheckSameBudget(const std::vector<YieldSet>& sets);

}  // namespace gauntlet
