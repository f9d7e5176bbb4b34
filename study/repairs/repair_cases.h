// The cases that a repair is made with: failing ones, half of which train and half judge, and random ones.
#pragma once

#include <string>
#include <vector>

#include "base/result.h"
#include "search/experiment/experiment.h"

namespace gauntlet {

// Failing cases that say one thing: those of one search, or of one lineage where there is a single search; of
// random search each on its own.
using CaseUnit = std::vector<sim::TestCase>;

// Of a corpus, each of whose cases is a unit: those that are expected to fail.
Result<std::vector<CaseUnit>> UnitsOfCorpus(const std::string& directory, const Experiment& experiment);
// Of campaigns, each different failing case once. Errors: those of reading; cases of another scenario.
Result<std::vector<CaseUnit>> UnitsOfCampaigns(const std::vector<std::string>& directories,
                                               const Experiment& experiment);

struct RepairCaseChoice {
  std::string corpus;                      // a folder; "" = campaigns
  std::vector<std::string> from = {};      // campaigns
  std::vector<std::string> held_out = {};  // campaigns whose cases judge; empty: half of the units does
  std::size_t random = 0;                  // cases that judge
};

struct ChosenRepairCases {
  std::vector<sim::TestCase> cases;  // as a repair is handed them
  std::vector<std::string> notes;    // what a reader has to know, a sentence each
};

// At most kMostFailing failing cases, spread over the units, and as many random ones as train; the experiment
// is told how many there are of each. Whole units train or judge. Errors: above; no failing case.
inline constexpr std::size_t kMostFailing = 80;
Result<ChosenRepairCases> ChooseRepairCases(const RepairCaseChoice& choice, Experiment& experiment);

}  // namespace gauntlet
