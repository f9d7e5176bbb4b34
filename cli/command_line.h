// gauntlet's command line (the contract is in README.md and ARCHITECTURE.md): what every command gets, and
// how it answers.
#pragma once

#include <functional>
#include <memory>
#include <ostream>
#include <string>
#include <string_view>
#include <vector>

#include "master/session/campaign_service.h"
#include "slurm/slurm_client.h"

namespace gauntlet {

// A contract with scripts.
enum ExitCode : int {
  kExitDone = 0,
  kExitNegative = 1,  // a check came out negative
  kExitUsage = 2,     // usage, configuration or input
  kExitStopped = 3,   // stopped, can be resumed
  kExitInternal = 4,
};

struct CommandContext {
  std::ostream& out;  // results
  std::ostream& err;  // progress and messages
  bool err_is_terminal = false;
  bool out_is_terminal = false;
  std::string program = "gauntlet";  // how hints begin
  CampaignService& campaigns = CampaignsOnDisk();
  // Instead of what a campaign's own cluster file says, in tests.
  std::function<std::unique_ptr<slurm::SlurmClient>()> slurm = nullptr;
  std::string version = "gauntlet";  // what --version prints
};

// "gauntlet: MESSAGE", one line whatever the message holds.
void PrintMessage(CommandContext& context, std::string_view message);
// Prints the error and gives the exit code of its kind: kInternal 4, kNoSpace 3, all others 2. An error that
// a command returns comes here by itself.
ExitCode Fail(CommandContext& context, const Error& error);

// Runs the command that `arguments` (without the program's name) ask for. Never throws.
ExitCode RunCommandLine(const std::vector<std::string>& arguments, CommandContext& context);

}  // namespace gauntlet
