// The status of a campaign as status and watch show it.
#pragma once

#include <string>

#include "master/cli/command_context.h"

namespace gauntlet::master {

// What a campaign does now, and the jobs of a submitted one that no master serves: for a person, or as one
// JSON document.
Result<std::string> CurrentStatus(CommandContext& context, const std::string& directory, bool json);

}  // namespace gauntlet::master
