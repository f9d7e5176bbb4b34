// How often a campaign's swarm fails without any obstacle, looked at beside what the campaign itself does.
#pragma once

#include <string>

#include "cli/command_line.h"
#include "cli/run_campaign.h"

namespace gauntlet {

// Answers `gauntlet baseline` of the campaign in `directory`, unless that is done, with workers of the kind
// that `run` has (if it has any). What stands in the way is said, and stops nothing.
void LookAtEmptyArena(CommandContext& context, const std::string& directory, const CampaignRun& run);

}  // namespace gauntlet
