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

// The individual, evaluation, replicate and seed of a run belong together: the seed is derived from them.
// Error: kCorrupt, naming the run.
Status CheckSeed(const Experiment& experiment, const StoredRun& run);

// All runs of a search against their seeds and against the newest state (no run that it has seen is missing;
// of a finished search it has seen all); with kEverything also against their own results and specs, and
// against the individuals' test cases, for which every run is decoded once. Error: kCorrupt, naming the first
// damage; or reading failed.
Status CheckStored(const SearchPlan& plan, ResultStore& store, Checked what = Checked::kEverything);
// The same of every search.
Status CheckStored(const std::vector<SearchPlan>& plans, ResultStore& store,
                   Checked what = Checked::kEverything);

}  // namespace gauntlet
