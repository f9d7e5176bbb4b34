// A campaign's summary and the results of `evaluate` as JSON: what scripts rely on.
#pragma once

#include <string>
#include <vector>

#include "master/cli/evaluation.h"
#include "master/report/campaign_summary.h"
#include "master/report/replay.h"

namespace gauntlet::master {

// One JSON document, indented, ending with '\n'. Seeds, hashes and ids above 2^53 are strings; a fitness that
// does not exist (nothing completed) is null.
std::string SummaryJson(const CampaignSummary& summary, const std::string& directory);

// {"cases": [{file, fitness, refused, error, runs: [{id, seed, fitness, verdict, metrics, failure, hash}]}],
// ...}. `summary` is of the campaign that simulated them; nullptr when no case could be simulated.
std::string EvaluationJson(const std::vector<EvaluatedCase>& cases, const CampaignSummary* summary,
                           const std::string& directory);
// {"run", "reproduced", "stored_hash", "hash", "differences": [...], "verdict", "fitness"}.
std::string ReplayJson(const ReplayReport& report);

}  // namespace gauntlet::master
