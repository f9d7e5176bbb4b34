// Drives one search of a campaign: asks the search, submits runs, stores what comes back, and tells the
// search once it is durable, in logical order. Everything it decides is a function of the experiment and the
// stored results.
#pragma once

#include <chrono>
#include <deque>
#include <functional>
#include <optional>
#include <vector>

#include "master/campaign/state_digest.h"
#include "master/dispatch/clock.h"
#include "master/dispatch/evaluation_backend.h"
#include "master/experiment/experiment.h"
#include "master/search/search_algorithm.h"
#include "master/store/result_store.h"
#include "sim/random/random_stream.h"

namespace gauntlet::master {

enum class StopWish {
  kNone,
  kAfterRuns,  // let the runs that have begun end
  kNow,        // what runs is simulated again some day
};

enum class CampaignEnd { kFinished, kStopped };

// What a person wants to see while it runs.
struct CampaignProgress {
  SearchProgress search;
  std::uint64_t runs_done = 0;     // stored, earlier sessions included
  std::uint64_t runs_planned = 0;  // 0 = unknown
  double runs_per_second = 0.0;    // over the last seconds
  double best_fitness = 0.0;       // of the population at the last complete generation; NaN before the first
  double mean_fitness = 0.0;
  std::uint64_t total_failures = 0;  // runs so far
  std::uint64_t runs_failed = 0;     // verdict other than completed
  WorkerStatistics workers;
  double elapsed_seconds = 0.0;             // of this session
  std::optional<double> remaining_seconds;  // at the present rate
};

// The id of run number `sequence` (1, 2, ...) of a search: searches do not share numbers, so ids do not
// depend on which search was faster.
RunId RunIdOf(SearchId search, std::uint64_t sequence);

// What the seeds of a campaign's runs are derived for.
sim::SeedPurpose PurposeOf(SearchKind kind);

// StoredRun::spec_hash.
std::uint64_t SpecHash(std::string_view spec);

class CampaignRunner {
 public:
  struct Parts {
    const Experiment& experiment;
    SearchId search_id = 1;
    sim::SeedPurpose purpose = sim::SeedPurpose::kSearch;
    SearchAlgorithm& search;
    EvaluationBackend& backend;
    ResultStore& store;
    const Clock& clock;
  };
  explicit CampaignRunner(const Parts& parts);

  // Brings the search to the newest stored state and takes up the results stored after it. Call once, before
  // Run. Error: what is stored does not fit the experiment (kCorrupt) or cannot be read.
  Status Restore();

  // Until the search has finished, `stop` answers kNow, or it has answered kAfterRuns and what was running
  // has ended. `on_progress` is called about ten times a second. Error: the store or the backend failed;
  // whatever was acknowledged is stored.
  Result<CampaignEnd> Run(const std::function<StopWish()>& stop,
                          const std::function<void(const CampaignProgress&)>& on_progress);

  // Runs stored, earlier sessions included.
  std::uint64_t runs_done() const { return runs_done_; }

 private:
  // The fields of a result that the search and the digest need.
  struct PendingRun {
    StoredRun run;  // `spec` and `result` are handed to the store and empty afterwards
    bool durable = false;
  };
  struct PendingEvaluation {
    EvaluationRequest request;
    std::vector<PendingRun> runs;
  };

  Status AskSearch();
  void Store(FinishedRun finished);
  Status ApplyCommits();
  void Count(const StoredRun& run);
  void StoreEvents();
  // Tells the search every leading evaluation whose runs are all durable; saves state at boundaries.
  void TellCompleted();
  PendingRun* Find(RunId id);
  CampaignProgress Progress(TimePoint started);

  Parts parts_;
  std::deque<PendingEvaluation> pending_;
  std::map<RunId, StoredRun>
      stored_ahead_;              // results that a former session stored and the saved state has not seen
  std::uint64_t at_backend_ = 0;  // submitted and not finished
  RunId last_asked_ = 0;
  RunId last_told_ = 0;
  RunId saved_until_ = 0;
  ResultsDigest digest_;
  std::uint64_t runs_done_ = 0;
  std::uint64_t total_failures_ = 0;
  std::uint64_t runs_failed_ = 0;
  double best_fitness_;
  double mean_fitness_;
  std::deque<std::pair<TimePoint, std::uint64_t>> rate_samples_;
};

}  // namespace gauntlet::master
