// What every command of the command line gets, and how it answers.
#pragma once

#include <functional>
#include <memory>
#include <ostream>
#include <string>
#include <vector>

#include "base/result.h"
#include "master/report/campaign_status.h"
#include "master/report/stored_campaign.h"
#include "master/session/campaign_session.h"
#include "slurm/slurm_client.h"

namespace gauntlet::master {

// A contract with scripts.
enum ExitCode : int {
  kExitDone = 0,
  kExitNegative = 1,  // a check came out negative
  kExitUsage = 2,     // usage, configuration or input
  kExitStopped = 3,   // stopped, can be resumed
  kExitInternal = 4,
};

// The campaigns behind the commands; replaced by tests.
struct CampaignService {
  std::function<Result<SessionReport>(const std::string& directory, const Experiment& experiment,
                                      const std::vector<sim::TestCase>& cases, const SessionOptions& options)>
      start = StartCampaign;
  std::function<Status(const std::string& directory, const std::vector<SearchPlan>& searches,
                       const std::string& slurm)>
      prepare = PrepareCampaign;
  std::function<Result<SessionReport>(const std::string& directory, const SessionOptions& options)> resume =
      ResumeCampaign;
  std::function<Result<CampaignSummary>(const std::string& directory)> read = ReadCampaign;
  std::function<Status(const std::string& directory, const std::function<void(const StoredRun&)>& visit)>
      for_each_run = ForEachStoredRun;
  std::function<Result<std::string>(const std::string& directory)> status = ReadStatus;
  std::function<Result<bool>(const std::string& directory)> lives = MasterLives;
  std::function<Status(const std::string& directory)> stop = RequestStop;
  std::function<Result<CampaignReplay>(const std::string& directory, RunId run)> replay = ReplayCampaignRun;
};

struct CommandContext {
  std::ostream& out;  // results
  std::ostream& err;  // progress and messages
  bool err_is_terminal = false;
  bool out_is_terminal = false;
  std::string program = "gauntlet";  // how hints begin
  CampaignService service;
  std::function<std::unique_ptr<slurm::SlurmClient>()> slurm = [] {
    return std::make_unique<slurm::CommandLineSlurm>();
  };
};

// "gauntlet: MESSAGE", one line whatever the message holds.
void PrintMessage(CommandContext& context, std::string_view message);
// Prints the error and gives the exit code of its kind: kInternal 4, kNoSpace 3, all others 2.
ExitCode Fail(CommandContext& context, const Error& error);

}  // namespace gauntlet::master
