// Drives the searches of a campaign, which share one backend and one store, until they have finished.
#pragma once

#include <deque>
#include <functional>
#include <utility>
#include <vector>

#include "base/result.h"
#include "base/system/clock.h"
#include "master/campaign/campaign_status.h"
#include "master/dispatch/evaluation_backend.h"
#include "master/session/search_driver.h"
#include "master/store/result_store.h"

namespace gauntlet {

enum class StopWish {
  kNone,
  kAfterRuns,  // let the runs that have begun end
  kNow,        // what runs is simulated again some day
};

class SearchLoop {
 public:
  // The drivers are those of searches 1, 2, ... in this order; all parts outlive the loop.
  struct Parts {
    std::vector<SearchDriver*> searches;
    EvaluationBackend& backend;
    ResultStore& store;
    const Clock& clock;
    EvaluationFeed* feed = nullptr;  // of the only search, a stream; else nullptr
  };
  explicit SearchLoop(const Parts& parts) : parts_(parts) {}

  // Call once, before Run: restores all searches.
  Status Restore();

  // Until all searches have finished, the feed is drained and the backend's audits are done, `stop` answers
  // kNow, or it has answered kAfterRuns and what was running has ended. `on_progress` is called about five
  // times a second. Error: the store or the backend failed; whatever was acknowledged is stored.
  Result<CampaignEnd> Run(const std::function<StopWish()>& stop,
                          const std::function<void(const CampaignProgress&)>& on_progress);

  // What the backend has reported since: into the store and the log. Run does so by itself.
  void StoreEvents();
  // Runs stored, earlier sessions included.
  std::uint64_t runs_done() const;

 private:
  SearchDriver& DriverOf(RunId run) { return *parts_.searches.at(SearchOf(run) - 1); }
  Status Advance();
  Status ApplyCommits();
  void StoreResults(std::vector<FinishedRun> finished);
  Status EndSession();
  // Of a stream: lets the feed add cases and hand out answers, and has the backend wait for more of them.
  Status TurnFeed();
  CampaignProgress Progress();

  Parts parts_;
  std::deque<SearchDriver*> waiting_;   // have not begun
  std::vector<SearchDriver*> running_;  // at most a few at a time, so that no more specs are held than needed
  std::deque<std::pair<TimePoint, std::uint64_t>> rate_samples_;
};

}  // namespace gauntlet
