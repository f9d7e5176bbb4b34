// A campaign's summary and the result of `replay`: for a person at a terminal, and as the
// JSON that scripts rely on.
#pragma once

#include <string>
#include <vector>

#include "master/campaign/campaign_summary.h"
#include "master/campaign/replay.h"
#include "study/questions/confirmations.h"

namespace gauntlet {

// How the commands in hints begin and which campaign they name.
struct HintContext {
  std::string program = "gauntlet";
  std::string directory;
};

// Ends with the next commands to try.
std::string SummaryText(const CampaignSummary& summary, const CampaignAnswers& answers,
                        const HintContext& context);

// The total failures by the types that the scenario declares, of each search.
std::string TypesText(const CampaignSummary& summary);

// One JSON document, indented, ending with '\n'. Seeds, hashes and ids above 2^53 are strings; a fitness that
// does not exist (nothing completed) is null.
std::string SummaryJson(const CampaignSummary& summary, const CampaignAnswers& answers,
                        const std::string& directory);
// {"run", "reproduced", "stored_hash", "hash", "differences": [...], "verdict", "fitness"}.
std::string ReplayJson(const ReplayReport& report);

}  // namespace gauntlet
