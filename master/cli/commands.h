// The commands: each adds itself to the parser and, when it was chosen, puts its work into `chosen`.
#pragma once

#include "master/cli/command_context.h"

namespace CLI {
class App;
}

namespace gauntlet::master {

void AddListCommand(CLI::App& app, CommandAction& chosen);
void AddEvolveCommand(CLI::App& app, CommandAction& chosen);
void AddRandomCommand(CLI::App& app, CommandAction& chosen);
void AddEvaluateCommand(CLI::App& app, CommandAction& chosen);
void AddResumeCommand(CLI::App& app, CommandAction& chosen);
void AddShowCommand(CLI::App& app, CommandAction& chosen);
void AddReplayCommand(CLI::App& app, CommandAction& chosen);

}  // namespace gauntlet::master
