// Whether what a store holds fits together. SQLite's own check sees broken pages only; this sees rows that
// were deleted or changed.
#pragma once

#include <vector>

#include "base/result.h"
#include "master/directory/search_plans.h"
#include "master/store/result_store.h"
#include "sim/run_result.h"

namespace gauntlet {

// The columns of a run that copy its result say the same as the result. Error: kCorrupt, naming the run, the
// column and both values.
Status CheckCopies(const StoredRun& run, const sim::RunResult& result);

// The individual, evaluation, replicate and seed of a run belong together: the seed is derived from them,
// but for a stream of cases, whose lines may give one.
// Error: kCorrupt, naming the run.
Status CheckSeed(const Experiment& experiment, const StoredRun& run);

// The rows of a search, one after the other: each against its seed, and all against the newest state, which
// has seen none that is missing (of a finished search it has seen all).
class RowCheck {
 public:
  static Result<RowCheck> Begin(const SearchPlan& plan, ResultStore& store);

  // Errors: kCorrupt, naming the first damage.
  Status Take(const StoredRun& run);
  Status End() const;

 private:
  Error Missing(RunId run) const;

  const Experiment* experiment_ = nullptr;  // the plan's
  RunId finished_with_ = 0;
  RunId last_seen_ = 0;
  std::uint32_t generation_ = 0;
  RunId expected_ = 0;
};

// All rows of a search (RowCheck); with kEverything also the runs against their own results and specs, and
// against the individuals' test cases, for which every run is decoded once. Error: kCorrupt, naming the first
// damage; or reading failed.
Status CheckStored(const SearchPlan& plan, ResultStore& store, Checked what = Checked::kEverything);
// The same of every search.
Status CheckStored(const std::vector<SearchPlan>& plans, ResultStore& store,
                   Checked what = Checked::kEverything);

}  // namespace gauntlet
