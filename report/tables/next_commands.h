// What is most worth typing next about a campaign, as `show` and reports say it.
#pragma once

#include <string>
#include <vector>

#include "analysis/tables/section.h"
#include "master/campaign/campaign_summary.h"
#include "study/questions/confirmations.h"

namespace gauntlet {

// `program`: how the commands begin; `directory`: of the campaign.
// The command that goes on with a campaign that has not ended: of a stream the one that began it.
std::string GoOnCommand(const CampaignSummary& summary, const std::string& program,
                        const std::string& directory);

std::string ConfirmCommand(const CampaignSummary& summary, const std::string& program,
                           const std::string& directory);
std::vector<NextCommand> NextCommandsOf(const CampaignSummary& summary, const CampaignAnswers& answers,
                                        const std::string& program, const std::string& directory);

}  // namespace gauntlet
