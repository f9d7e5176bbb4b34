// What still breaks a repaired controller: searches that begin anew against it and, to compare, against the
// original one. They are a campaign of their own beside the repair.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "base/result.h"
#include "master/directory/search_plans.h"

namespace gauntlet {

struct Repair;

// The directory of the searches against what a repair in `dir` has given.
std::string ProofOf(const std::string& dir);

// A genetic search of about `runs` runs against either controller, and an archive search where the scenario
// says along which metrics failures differ and the runs can fill a cell. Of a repair that has come to its
// end.
std::vector<SearchPlan> ProofSearches(const Repair& repair, int runs);

// What one kind of search found against both.
struct FreshSearch {
  std::string title;  // "genetic algorithm"
  struct Found {
    std::uint64_t runs = 0;
    std::uint64_t failures = 0;
    std::size_t cells = 0;        // of the archive, that were filled
    std::vector<double> fitness;  // of the runs with a result
  };
  Found before;
  Found after;
  bool archive = false;
};
// None where there are no such searches, or they have not come to their end. Errors: those of
// OpenStoredCampaign.
Result<std::vector<FreshSearch>> ReadFreshSearches(const std::string& dir);

}  // namespace gauntlet
