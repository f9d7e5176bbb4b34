// gauntlet master: a search whose workers come from elsewhere.
#include <algorithm>

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include "cli/commands.h"
#include "cli/options/stop_signal.h"
#include "cli/run_campaign.h"
#include "master/directory/campaign_directory.h"
#include "master/directory/campaign_ownership.h"
#include "report/tables/search_columns.h"
#include "search/search_table.h"

namespace gauntlet {
namespace {

struct MasterOptions {
  ExperimentOptions experiment;
  SizeOptions size;
  ServingOptions serving;
  BindOptions bind;
  bool resume = false;
};

// Which typed settings the campaign has to be made longer for ("key=value"). Error: one that it was not begun
// with, and that nothing can change any more.
Result<std::vector<std::string>> LengthsToChange(const MasterOptions& options, const Experiment& experiment,
                                                 const std::vector<std::string>& typed) {
  const std::string& dir = options.experiment.directory;
  TRY(const CampaignView view, ViewCampaign(dir, Checked::kTotals));
  TRY(const std::vector<SearchPlan> plans, ReadSearchPlans(view.directory));
  const SearchPlan& begun = plans.front();
  const auto refuse = [&](const std::string& what) {
    return InvalidInput(
        fmt::format("--resume: {} was not begun with {}; only its length may change: leave that out, "
                    "or name another --dir",
                    dir, what));
  };
  if (!options.experiment.seed.empty() && experiment.seed != begun.experiment.seed)
    return refuse("--seed " + options.experiment.seed);
  const SearchColumns differing({begun, {"", experiment, {}}});
  std::vector<std::string> lengths;
  for (const std::string& set : typed) {
    const std::string key = set.substr(0, set.find('='));
    if (std::ranges::count(differing.columns(), key, &DataColumn::name) == 0) continue;
    if (key != RowOf(begun.experiment).info.length) return refuse(set);
    lengths.push_back(set);
  }
  return lengths;
}

// The campaign goes on as the options say, or not at all.
Status Obey(CommandContext& context, const MasterOptions& options, const Experiment& experiment) {
  const std::vector<ExtraSet> extra = SetsOf(options.size);
  TRY(const std::vector<std::string> typed, JoinSets(options.experiment.sets, extra));
  if (typed.empty() && options.experiment.seed.empty()) return Ok{};
  TRY(const std::vector<std::string> lengths, LengthsToChange(options, experiment, typed));
  if (lengths.empty()) return Ok{};
  const std::string& dir = options.experiment.directory;
  const Result<std::string> change = context.campaigns.Extend(dir, lengths, StopSignal::Requested);
  if (!change) return AsTyped(change.error(), extra);
  if (!options.serving.quiet) PrintMessage(context, fmt::format("{} goes on: {}", dir, *change));
  return Ok{};
}

Result<ExitCode> RunMaster(CommandContext& context, const MasterOptions& options) {
  const std::string& wanted = options.experiment.directory;
  if (options.resume && wanted.empty())
    return InvalidInput("--resume needs --dir: which campaign is to go on?");
  TRY(const Experiment experiment, LoadExperimentWith(options.experiment, SetsOf(options.size)));
  const bool goes_on = options.resume && CampaignDirectory::IsCampaign(wanted);
  TRY(const std::string directory, goes_on ? Result<std::string>(wanted) : NewDirectory(wanted, experiment));

  CampaignRun campaign;
  campaign.directory = directory;
  campaign.session.workers = 0;
  campaign.serving = options.serving;
  campaign.bind = options.bind;
  campaign.run = [&](const SessionOptions& session) -> Result<SessionReport> {
    if (!goes_on) return context.campaigns.Start(directory, {{"", experiment}}, session);
    TRY(Obey(context, options, experiment));
    return context.campaigns.Resume(directory, session);
  };
  return RunCampaign(context, campaign);
}

}  // namespace

void AddMaster(CommandParser& parser) {
  const auto [command, options] =
      parser.Add("master", "serve a search to workers that connect from elsewhere", RunMaster);
  AddExperimentOptions(command, options.experiment);
  AddSizeOptions(command, options.size);
  AddServingOptions(command, options.serving);
  AddBindOptions(command, options.bind);
  command.get_option("--bind")->required();
  command.add_flag(
      "--resume", options.resume,
      "continue the campaign in --dir if there is one; of its settings, only the length may differ");
  command.footer(
      R"(Runs a search like 'evolve', but starts no workers. Start 'gauntlet-worker --dir DIR' on any machine that sees
the campaign's directory: the worker finds the master through the file access.json in it. Unless --insecure is
given, everything is encrypted and only workers with the keys in access.json are admitted, on loopback too.
Ctrl-C or SIGTERM stops the master alone (exit 3): the workers finish their runs, keep the results and wait 10
minutes for a new master. 'gauntlet stop DIR' stops the workers too.

Examples:
  gauntlet master flocking --bind 'tcp://0.0.0.0:*' --dir /shared/flocking-1
  gauntlet master flocking --bind 'tcp://0.0.0.0:*' --dir /shared/flocking-1 --resume)");
}

}  // namespace gauntlet
