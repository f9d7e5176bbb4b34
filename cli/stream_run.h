// A campaign whose cases come line by line on standard input (study/streams/evaluation_pipe.h).
#pragma once

#include <vector>

#include "base/result.h"
#include "cli/command_line.h"
#include "cli/options/options.h"

namespace gauntlet {

// Begins the campaign in its directory, or goes on with it there, until standard input ends. Exit codes as
// RunCampaign's.
Result<ExitCode> RunStream(CommandContext& context, const LocalOptions& options,
                           const std::vector<ExtraSet>& extra);

}  // namespace gauntlet
