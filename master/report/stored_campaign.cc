#include "master/report/stored_campaign.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <utility>

#include "master/directory/campaign_ownership.h"
#include "master/report/campaign_progress.h"
#include "master/report/stored_check.h"
#include "master/report/stored_search.h"
#include "master/store/run_numbers.h"

namespace gauntlet::master {
namespace {

// Totals over searches; what has no meaning over several stays empty.
CampaignSummary TotalsOf(const std::vector<CampaignSummary>& searches) {
  CampaignSummary totals;
  totals.experiment = searches.front().experiment;
  totals.search = "sweep";
  totals.seed = searches.front().seed;
  totals.finished = true;
  totals.progress.finished = true;
  constexpr double kNoFitness = std::numeric_limits<double>::quiet_NaN();
  totals.best_fitness = totals.mean_fitness = totals.worst_fitness = kNoFitness;
  for (const CampaignSummary& one : searches) {
    totals.runs_done += one.runs_done;
    totals.runs_failed += one.runs_failed;
    totals.total_failures += one.total_failures;
    totals.distinct_individuals += one.distinct_individuals;
    Add(one.progress, totals.progress);
    totals.finished = totals.finished && one.finished;
    totals.nondeterministic = std::max(totals.nondeterministic, one.nondeterministic);  // each has all
    totals.best_fitness = std::fmin(totals.best_fitness, one.best_fitness);
    totals.worst_fitness = std::fmax(totals.worst_fitness, one.worst_fitness);
  }
  totals.progress.finished = totals.finished;
  return totals;
}

}  // namespace

Status CheckAllStored(const std::vector<SearchPlan>& plans, ResultStore& store) {
  for (std::size_t i = 0; i < plans.size(); ++i) {
    const Status whole = CheckStored(plans[i].experiment, static_cast<SearchId>(i + 1), store);
    if (!whole) return whole;
  }
  return Ok{};
}

Result<CampaignSummary> SummariseAll(const std::vector<SearchPlan>& plans, ResultStore& store) {
  std::vector<CampaignSummary> searches;
  for (std::size_t i = 0; i < plans.size(); ++i) {
    const auto id = static_cast<SearchId>(i + 1);
    const Result<std::unique_ptr<SearchAlgorithm>> search = MakeStoredSearch(plans[i].experiment, id, store);
    if (!search) return search.error();
    Result<CampaignSummary> summary = Summarise(plans[i].experiment, id, **search, store);
    if (!summary) return summary;
    summary->settings = plans[i].settings;
    searches.push_back(*std::move(summary));
  }
  if (plans.size() == 1) return std::move(searches.front());
  CampaignSummary totals = TotalsOf(searches);
  totals.searches = std::move(searches);
  return totals;
}

Result<CampaignSummary> ReadCampaign(const std::string& dir) {
  Result<CampaignView> campaign = ViewCampaign(dir);
  if (!campaign) return campaign.error();
  const Result<std::vector<SearchPlan>> plans = ReadSearchPlans(campaign->directory);
  if (!plans) return plans.error();
  if (Status whole = CheckAllStored(*plans, *campaign->store); !whole) return whole.error();
  return SummariseAll(*plans, *campaign->store);
}

Status ForEachStoredRun(const std::string& dir, const std::function<void(const StoredRun&)>& visit) {
  Result<CampaignView> campaign = ViewCampaign(dir);
  if (!campaign) return campaign.error();
  return campaign->store->ForEachRun(kOnlySearch, 0, visit);
}

Result<CampaignReplay> ReplayCampaignRun(const std::string& dir, RunId run) {
  Result<CampaignView> campaign = ViewCampaign(dir);
  if (!campaign) return campaign.error();
  const Result<std::vector<SearchPlan>> plans = ReadSearchPlans(campaign->directory);
  if (!plans) return plans.error();
  Result<ReplayReport> report = ReplayRun(*campaign->store, run);
  if (!report) return report.error();
  const std::size_t search = SearchOf(run) - 1;
  if (search >= plans->size())
    return Error{ErrorKind::kCorrupt,
                 fmt::format("run {} is of a search that the campaign does not have", run)};
  const Experiment& experiment = (*plans)[search].experiment;
  if (report->damage.empty()) {
    if (Status belongs = CheckSeed(experiment, report->stored); !belongs) return belongs.error();
  }
  return CampaignReplay{experiment, std::move(*report)};
}

}  // namespace gauntlet::master
