// gauntlet's command line (the contract is in README.md and ARCHITECTURE.md).
#pragma once

#include <string>
#include <vector>

#include "master/cli/command_context.h"

namespace gauntlet::master {

// Runs the command that `arguments` (without the program's name) ask for. Never throws.
ExitCode RunCommandLine(const std::vector<std::string>& arguments, CommandContext& context);

}  // namespace gauntlet::master
