// What `show` says of a campaign: a plain struct, so that the terminal table, the JSON and reports agree.
#pragma once

#include <cstdint>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "base/mean_and_range.h"
#include "base/result.h"
#include "controllers/failure_descriptor.h"
#include "master/campaign/campaign_status.h"
#include "master/campaign/observed_reproducibility.h"
#include "master/directory/search_plans.h"
#include "master/store/result_store.h"
#include "search/search_algorithm.h"
#include "sim/run_result.h"

namespace gauntlet {

struct PopulationMember {
  IndividualId id = 0;
  std::vector<IndividualId> parents;
  std::uint32_t birth_generation = 0;
  double fitness = 0.0;
  sim::Genome genome;
  std::vector<RunId> runs;         // of this individual, in logical order
  std::string name = "";           // of a given case, that of its file; else ""
  std::uint64_t failing_runs = 0;  // of them, by the scenario's condition
};

struct GenerationSummary {
  std::uint32_t generation = 0;
  std::uint64_t runs = 0;
  std::uint64_t total_failures = 0;
  MeanAndRange fitness;  // of the completed runs
};

// Runs that ended alike without a result: the same verdict and, of refusals, the same rule.
struct RunsWithoutResult {
  sim::Verdict verdict = sim::Verdict::kRefused;
  std::string rule;     // "no-room-to-spawn"; "" when the messages do not begin with one
  std::string message;  // of the first of them
  std::uint64_t runs = 0;
  RunId first_run = 0;  // the first of them
};

// How far one search has come, or all of a campaign, and what became of the runs that are stored.
struct SearchTally {
  SearchProgress progress;
  std::uint64_t runs_done = 0;
  std::uint64_t runs_failed = 0;  // verdict other than completed
  std::uint64_t total_failures = 0;
  std::uint64_t failing_runs = 0;  // by the scenario's condition (ScenarioInfo::failing)
  std::uint64_t distinct_individuals = 0;
  MeanAndRange fitness;  // of the population
  bool finished = false;

  void Add(const SearchTally& other);
};

// What one search came to.
struct SearchSummary : SearchTally {
  std::string settings;  // in a sweep, what tells it from the others
  std::string search;    // its name
  std::uint64_t seed = 0;
  std::string failing;                        // the scenario's condition in words; "" = a total failure
  controllers::FailureTypes types;            // that the scenario declares
  std::map<int, std::uint64_t> runs_of_type;  // total failures of each that came up
  std::uint64_t untyped_failures = 0;         // total failures of none of the types
  std::vector<RunsWithoutResult> runs_without_result;      // most frequent first
  std::vector<std::pair<std::string, double>> statistics;  // of the search itself
  std::vector<GenerationSummary> generations;
  std::vector<PopulationMember> population;
  ArchiveView archive = {};  // without axes when the search keeps none
  std::string state_hash;
};

// What a campaign came to; the tally is that of all its searches.
struct CampaignSummary : SearchTally {
  std::string experiment;
  SearchesProgress each;
  std::vector<SearchSummary> searches;  // in the order of their numbers
  std::uint64_t nondeterministic = 0;   // second results of a spec that differed from the first
  std::uint64_t lone_verdicts = 0;      // runs that were given up on the word of a single worker
  ObservedReproducibility reproducibility;
  // The controllers that plug-ins bring: what is to blame when results differ.
  std::set<std::string> plugin_controllers = {};
  std::string as_of = "";  // CampaignView::as_of

  // nullptr of a sweep.
  const SearchSummary* OnlySearch() const { return searches.size() == 1 ? &searches.front() : nullptr; }
};

// Results in the events of all masters that differed from another of the same spec.
Result<std::uint64_t> CountNondeterministic(ResultStore& store);
// Runs that were given up on the word of a single worker, because there was no other, under all masters.
Result<std::uint64_t> CountLoneVerdicts(ResultStore& store);

// What is stored: population, fitness figures and state_hash are those of the last complete generation; runs
// and failures count everything.
Result<CampaignSummary> Summarise(const std::vector<SearchPlan>& plans, ResultStore& store);
// The same of a store whose rows were not held against one another yet: they are on the way (RowCheck).
Result<CampaignSummary> CheckAndSummarise(const std::vector<SearchPlan>& plans, ResultStore& store);
// How far all searches together have come and what they have met, without a look at a single run: the fields
// of a summary that `status` tells.
Result<CampaignSummary> SummariseTotals(const std::vector<SearchPlan>& plans, ResultStore& store);

}  // namespace gauntlet
