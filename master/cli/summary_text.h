// A campaign's summary and the results of `evaluate` for a person at a terminal.
#pragma once

#include <string>
#include <vector>

#include "master/cli/evaluation.h"
#include "master/report/campaign_summary.h"

namespace gauntlet::master {

// How the commands in hints begin and which campaign they name.
struct HintContext {
  std::string program = "gauntlet";
  std::string directory;
};

// Ends with the next commands to try.
std::string SummaryText(const CampaignSummary& summary, const HintContext& context);
std::string EvaluationText(const std::vector<EvaluatedCase>& cases, const HintContext& context);

}  // namespace gauntlet::master
