// What `show` says of a campaign: a plain struct, so that the terminal table, the JSON and reports agree.
#pragma once

#include <cstdint>
#include <set>
#include <string>
#include <vector>

#include "base/result.h"
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
  std::vector<RunId> runs;  // of this individual, in logical order
  std::string name = "";    // of a given case, that of its file; else ""
};

struct GenerationSummary {
  std::uint32_t generation = 0;
  std::uint64_t runs = 0;
  std::uint64_t completed = 0;  // runs with the verdict completed; best, mean and worst are over these
  double best = 0.0;
  double mean = 0.0;
  double worst = 0.0;
  std::uint64_t total_failures = 0;
};

// Runs that ended alike without a result: the same verdict and, of refusals, the same rule.
struct RunsWithoutResult {
  sim::Verdict verdict = sim::Verdict::kRefused;
  std::string rule;     // "no-room-to-spawn"; "" when the messages do not begin with one
  std::string message;  // of the first of them
  std::uint64_t runs = 0;
  RunId first_run = 0;  // the first of them
};

// Total failures of one of the types that the scenario declares.
struct FailureCount {
  int type = 0;
  std::string name;
  std::uint64_t runs = 0;
};

struct CampaignSummary {
  std::string settings;  // of a search in a sweep, what tells it from the others
  std::string experiment;
  std::string search;  // its name; "sweep" of several
  std::uint64_t seed = 0;
  SearchProgress progress;
  std::uint64_t runs_done = 0;                         // stored
  std::uint64_t runs_failed = 0;                       // verdict other than completed
  std::vector<RunsWithoutResult> runs_without_result;  // most frequent first
  std::uint64_t distinct_individuals = 0;
  double best_fitness = 0.0;  // of the population; lower = tougher
  double mean_fitness = 0.0;
  double worst_fitness = 0.0;
  std::uint64_t total_failures = 0;
  // Where a case breaks the swarm by another condition than a total failure (ScenarioInfo::failing): which,
  // in words, and how many runs hold it. "" = by a total failure.
  std::string failing;
  std::uint64_t failing_runs = 0;
  std::string failure_note;                                // ScenarioInfo::failure_note
  std::vector<FailureCount> failure_types;                 // every one that the scenario declares
  std::uint64_t untyped_failures = 0;                      // total failures of none of these types
  std::string untyped;                                     // what they are, in words: "without a split"
  std::vector<std::pair<std::string, double>> statistics;  // of the search itself
  std::vector<GenerationSummary> generations;
  std::vector<PopulationMember> population;
  ArchiveView archive = {};  // without axes when the search keeps none
  std::string state_hash;
  std::uint64_t nondeterministic = 0;  // second results of a spec that differed from the first
  // The controller when a plug-in brings it: what is to blame when results differ.
  std::set<std::string> plugin_controllers = {};
  std::uint64_t lone_verdicts = 0;  // runs that were given up on the word of a single worker
  bool finished = false;
  std::string as_of = "";  // CampaignView::as_of
  // Of a sweep, one for each search, in the order of their numbers; the rest are then totals, and what has no
  // meaning over several searches is empty.
  std::vector<CampaignSummary> searches;
};

// Results in the events of all masters that differed from another of the same spec.
Result<std::uint64_t> CountNondeterministic(ResultStore& store);
// Runs that were given up on the word of a single worker, because there was no other, under all masters.
Result<std::uint64_t> CountLoneVerdicts(ResultStore& store);

// Gathers the summary of a search from what is stored. `search` is freshly made for the experiment; it is
// brought to the newest saved state. Population, fitness figures and state_hash are those of the last
// complete generation; runs and failures count everything stored.
Result<CampaignSummary> Summarise(const Experiment& experiment, SearchId search_id, SearchAlgorithm& search,
                                  ResultStore& store);
// How far all searches together have come and what they have met, without a look at a single run: the fields
// of a summary that `status` tells.
Result<CampaignSummary> SummariseTotals(const std::vector<SearchPlan>& plans, ResultStore& store);
// Of an only search its summary; of several the totals, with one summary each in `searches`.
Result<CampaignSummary> Summarise(const std::vector<SearchPlan>& plans, ResultStore& store);

}  // namespace gauntlet
