// What a campaign has stored, read while no master serves it.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "base/result.h"
#include "master/directory/search_plans.h"
#include "master/experiment/experiment.h"
#include "master/report/campaign_summary.h"
#include "master/report/replay.h"
#include "master/store/result_store.h"

namespace gauntlet::master {

// CheckStored for every search.
Status CheckAllStored(const std::vector<SearchPlan>& plans, ResultStore& store);

// Of an only search its summary; of several the totals, with one summary each in `searches`.
Result<CampaignSummary> SummariseAll(const std::vector<SearchPlan>& plans, ResultStore& store);

// The next three open the campaign in `dir` for reading. Error kInUse (with the owner) while a living master
// holds it.

// Checks and summarises everything, for `show`.
Result<CampaignSummary> ReadCampaign(const std::string& dir);

// The runs of a campaign of one search in logical order, for `evaluate --json`.
Status ForEachStoredRun(const std::string& dir, const std::function<void(const StoredRun&)>& visit);

struct CampaignReplay {
  Experiment experiment;
  ReplayReport report;
};
Result<CampaignReplay> ReplayCampaignRun(const std::string& dir, RunId run);

}  // namespace gauntlet::master
