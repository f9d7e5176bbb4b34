// --dry-run of the commands that begin a campaign on this machine.
#pragma once

#include <vector>

#include "cli/command_line.h"
#include "cli/run_campaign.h"
#include "search/failure_tally.h"

namespace gauntlet {

// Says what the campaign would ask for and cost here, as text or JSON, after a few measured runs; makes no
// file. `without_obstacles`: runs of the empty arena, where some were looked at.
Result<ExitCode> PrintDryRun(CommandContext& context, const CampaignRun& campaign,
                             const std::vector<SearchPlan>& searches,
                             const FailureTally& without_obstacles = {});

}  // namespace gauntlet
