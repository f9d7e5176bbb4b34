#include "report/ui/campaign_feed.h"

#include <algorithm>
#include <utility>

#include "master/directory/campaign_ownership.h"
#include "master/directory/search_plans.h"
#include "master/store/run_numbers.h"

namespace gauntlet {

CampaignFeed::CampaignFeed(std::string directory) {
  facts_.directory = std::move(directory);
}

Status CampaignFeed::Look() {
  TRY(const CampaignView campaign, ViewCampaign(facts_.directory, Checked::kTotals));
  SqliteStore& store = *campaign.store;
  TRY(facts_.plans, ReadSearchPlans(campaign.directory));
  if (store.meta().campaign_id != campaign_id_) {
    campaign_id_ = store.meta().campaign_id;
    facts_.runs.clear();
    seen_.clear();
  }
  for (SearchId search = 1; search <= facts_.plans.size(); ++search) {
    if (seen_.size() < search) seen_.push_back(RunIdOf(search, 1) - 1);
    TRY(ReadRunsOf(search, store));
  }
  TRY(std::vector<StoredEvent> events, store.LoadEvents());
  const std::size_t dropped = events.size() - std::min(kMostEvents, events.size());
  events_.assign(events.begin() + static_cast<std::ptrdiff_t>(dropped), events.end());
  return Ok{};
}

Status CampaignFeed::ReadRunsOf(SearchId search, ResultStore& store) {
  RunId& seen = seen_[search - 1];
  return store.ForEachRow(search, seen, [&](const StoredRun& run) {
    if (run.id != seen + 1) return Ok{};
    facts_.runs.push_back(FactsOfRow(run));
    seen = run.id;
    return Ok{};
  });
}

const RunFacts* CampaignFeed::toughest() const {
  const RunFacts* toughest = nullptr;
  for (const RunFacts& run : facts_.runs) {
    if (run.completed && (toughest == nullptr || run.fitness < toughest->fitness)) toughest = &run;
  }
  return toughest;
}

}  // namespace gauntlet
