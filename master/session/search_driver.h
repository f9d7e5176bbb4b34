// One search of a campaign: asks it, hands its runs to the backend, stores what comes back, and tells the
// search once it is durable, in logical order. Everything it decides is a function of the experiment and the
// stored results.
#pragma once

#include <cstdint>
#include <deque>
#include <functional>
#include <limits>
#include <map>
#include <vector>

#include "master/campaign/state_digest.h"
#include "master/directory/search_plans.h"
#include "master/dispatch/evaluation_backend.h"
#include "master/session/evaluation_feed.h"
#include "master/store/result_store.h"
#include "master/store/run_numbers.h"
#include "search/search_algorithm.h"

namespace gauntlet {

class SearchDriver {
 public:
  struct Parts {
    const SearchPlan& plan;
    SearchAlgorithm& search;
    EvaluationBackend& backend;
    ResultStore& store;
    // A run that has come back, before it is stored; it still has its spec.
    std::function<void(const StoredRun&, const FinishedRun&)> on_run = {};
    EvaluationFeed* feed = nullptr;  // told of evaluations whose runs are all durable; may be nullptr
  };
  explicit SearchDriver(const Parts& parts);

  // Brings the search to the newest stored state and takes up the results stored after it. Call once, before
  // the rest. Error: what is stored does not fit the experiment (kCorrupt) or cannot be read.
  Status Restore();

  // Tells the search what is complete, asks for more and submits it; saves state at boundaries. Error: what
  // is stored contradicts what the search asks for.
  Status Advance();
  // A run of this search has come back: hands it to the store.
  void Store(FinishedRun finished);
  // A run of this search has become durable.
  void Committed(RunId id);
  // Advance, for the last time: tells what is complete without asking for more.
  void TellCompleted();

  SearchId id() const { return parts_.plan.id; }
  bool finished() const { return pending_.empty() && parts_.search.Progress().finished; }
  // The last run of the newest evaluation that the search was told; before the first run: one less than its
  // id.
  RunId last_told() const { return last_told_; }
  // Evaluations that have been asked for and not been told.
  bool pending() const { return !pending_.empty(); }
  // Runs that have been submitted and not come back.
  std::uint64_t at_backend() const { return at_backend_; }

  SearchProgress Progress() const { return parts_.search.Progress(); }
  std::uint64_t runs_planned() const;
  const SearchTotals& totals() const { return totals_; }  // of the runs stored, earlier sessions included
  // Of the last complete generation; NaN before the first.
  double best_fitness() const { return best_fitness_; }
  double mean_fitness() const { return mean_fitness_; }

 private:
  struct PendingRun {
    StoredRun
        run;  // afterwards without `spec` and `result`, which the store has, and with what the search wants
    bool durable = false;
  };
  struct PendingEvaluation {
    EvaluationRequest request;
    std::vector<PendingRun> runs;
  };

  static constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

  Status Ask();
  void Answer(const PendingEvaluation& evaluation) const;
  // Ticks that the individual's runs took so far, or its parents'; 0 = unknown.
  double PredictedLength(const EvaluationRequest& request) const;
  void SaveState();
  // The evaluation that holds it; nullptr when none does.
  PendingEvaluation* FindEvaluation(RunId id);
  PendingRun* Find(RunId id);

  Parts parts_;
  bool has_generations_;  // else everybody is evaluated once, without children
  std::deque<PendingEvaluation> pending_;
  // Results that a former session stored and the saved state has not seen.
  std::map<RunId, StoredRun> stored_ahead_;
  std::uint64_t at_backend_ = 0;
  std::map<IndividualId, double> ticks_;  // of the newest run of those who may run or breed again
  RunId last_asked_;
  RunId last_told_;
  RunId saved_until_;
  ResultsDigest digest_;
  SearchTotals totals_;
  double best_fitness_ = kNone;
  double mean_fitness_ = kNone;
};

}  // namespace gauntlet
