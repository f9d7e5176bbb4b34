// gauntlet master: a search whose workers come from elsewhere.
#include <filesystem>

#include <CLI/CLI.hpp>

#include "master/cli/commands.h"
#include "master/cli/run_campaign.h"

namespace gauntlet::master {
namespace {

struct MasterOptions {
  ExperimentOptions experiment;
  SizeOptions size;
  ServingOptions serving;
  BindOptions bind;
  bool resume = false;
};

ExitCode RunMaster(CommandContext& context, const MasterOptions& options) {
  const std::string& wanted = options.experiment.directory;
  if (options.resume && wanted.empty())
    return Fail(context, InvalidInput("--resume needs --dir: which campaign is to go on?"));
  const Result<Experiment> experiment = LoadExperimentWith(options.experiment, SetsOf(options.size));
  if (!experiment) return Fail(context, experiment.error());
  std::error_code ignored;
  const bool goes_on = options.resume && std::filesystem::exists(wanted + "/campaign.db", ignored);
  const Result<std::string> directory =
      goes_on ? Result<std::string>(wanted) : NewDirectory(wanted, *experiment);
  if (!directory) return Fail(context, directory.error());

  CampaignRun campaign;
  campaign.directory = *directory;
  campaign.session.workers = 0;
  campaign.serving = options.serving;
  campaign.bind = options.bind;
  campaign.run = [&](const SessionOptions& session) {
    return goes_on ? context.campaigns.Resume(*directory, session)
                   : context.campaigns.Start(*directory, {{"", *experiment}}, session);
  };
  return RunCampaign(context, campaign);
}

}  // namespace

void AddMaster(CommandParser& parser) {
  const auto [command, options] =
      parser.Add("master", "a search whose workers come from elsewhere", RunMaster);
  AddExperimentOptions(command, options.experiment);
  AddSizeOptions(command, options.size);
  AddServingOptions(command, options.serving);
  AddBindOptions(command, options.bind);
  command.get_option("--bind")->required();
  command.add_flag("--resume", options.resume, "go on with the campaign in --dir when there is one");
  command.footer(
      R"(Evolves like 'evolve', but starts no workers: they find the master through access.json in the campaign's
directory ('gauntlet-worker --dir DIR' on any machine that sees it). Everything is encrypted, and only workers
with the keys in access.json are let in, on loopback too (unless --insecure). Ctrl-C or SIGTERM
stops the master alone (exit 3): workers finish, keep their results and wait 10 minutes for a successor.
'gauntlet stop DIR' lets the workers go too.

Examples:
  gauntlet master flocking --bind 'tcp://0.0.0.0:*' --dir /shared/flocking-1
  gauntlet master flocking --bind 'tcp://0.0.0.0:*' --dir /shared/flocking-1 --resume)");
}

}  // namespace gauntlet::master
