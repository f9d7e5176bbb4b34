// The search of a stored campaign: made, and brought to where its newest state stands.
#pragma once

#include <functional>
#include <memory>
#include <string>

#include "base/result.h"
#include "master/campaign/state_digest.h"
#include "master/directory/search_plans.h"
#include "master/store/result_store.h"
#include "search/search_algorithm.h"

namespace gauntlet {

// The search as it was before its first evaluation. kCorrupt when it is a list of given test cases and the
// store does not hold them. `restored`: RestoreSearch comes next, so random search takes its cases from the
// store as well, which is several times as fast as to draw them again.
Result<std::unique_ptr<SearchAlgorithm>> MakeStoredSearch(const SearchPlan& plan, ResultStore& store,
                                                          bool restored = false);
// The same, to be restored, of a search whose individuals are known.
Result<std::unique_ptr<SearchAlgorithm>> MakeStoredSearch(const SearchPlan& plan,
                                                          std::vector<Individual> individuals);

// Whether the search has come to the end of the length that its experiment gives it now: one that was made
// longer since it ended has not. Takes no look at its runs.
bool HasFinished(const StoredSearch& stored, const Experiment& experiment, const SearchAlgorithm& search);

// What a search is to know of a stored run. kCorrupt when its metrics or trajectories are wanted and
// do not read back.
Result<RunOutcome> OutcomeOf(const StoredRun& run, bool with_metrics, bool with_ways = false);

// How far a search had come when its newest state was saved.
struct SavedProgress {
  std::string state;      // SearchAlgorithm::Save; empty when none was saved
  RunId last_run = 0;     // the last that it has seen; before the first: one less than that one's id
  ResultsDigest results;  // of all that it has seen
};
// Who looks at all stored runs of a search, also at those that its newest state has not seen, in their order.
struct RunReader {
  std::function<Status(const StoredRun& run, const RunOutcome& outcome)> take = nullptr;
  bool with_metrics = false;
  std::function<Status()> end = nullptr;  // when all were taken
};
// Brings a search that was just made to its newest state. Error: the state or the runs that it has seen
// cannot be read, or do not fit the search (SearchAlgorithm::Restore); that of `reader`.
Result<SavedProgress> RestoreSearch(SearchId id, ResultStore& store, SearchAlgorithm& search,
                                    const RunReader& reader = {});

}  // namespace gauntlet
