// gauntlet evolve, gauntlet random: a search on a pool of workers.

#include <string_view>
#include <utility>

#include <fmt/format.h>

#include "master/cli/commands.h"
#include "master/cli/common_options.h"
#include "master/cli/run_campaign.h"

namespace gauntlet::master {
namespace {

// Options that only a genetic search reads.
Status CheckRandomOptions(const CommonOptions& options) {
  for (const auto& [option, value] :
       {std::pair("--generations", options.generations), std::pair("--population", options.population)}) {
    if (value.empty()) continue;
    return InvalidInput(
        fmt::format("{} {}: a random search has neither generations nor a population; its number of test "
                    "cases is 'random "
                    "--cases N', or --set search.cases=N",
                    option, value));
  }
  for (const std::string& set : options.sets) {
    const std::string_view key = std::string_view(set).substr(0, set.find('='));
    if (!key.starts_with("search.") || key == "search.algorithm" || key == "search.cases" ||
        key == "search.replicates") {
      continue;
    }
    return InvalidInput(fmt::format(
        "--set {}: a random search breeds nothing; of the search it reads search.cases and search.replicates",
        set));
  }
  return Ok{};
}

ExitCode RunSearch(CommandContext& context, const CommonOptions& options,
                   const std::vector<ExtraSet>& extra) {
  const Result<Experiment> experiment = LoadExperimentWith(options, extra);
  if (!experiment) return Fail(context, experiment.error());
  if (experiment->search.kind == SearchKind::kCases) {
    return Fail(context, InvalidInput("search.algorithm = cases needs a list of cases: use 'evaluate'"));
  }
  if (experiment->search.kind == SearchKind::kRandom) {
    if (Status meant = CheckRandomOptions(options); !meant) return Fail(context, meant.error());
  }
  const Result<int> workers = ParseWorkers(options.workers);
  if (!workers) return Fail(context, workers.error());
  const Result<std::string> directory = NewDirectory(options, *experiment);
  if (!directory) return Fail(context, directory.error());

  CampaignRun campaign;
  campaign.directory = *directory;
  campaign.announcement = Announcement(*experiment, *workers, *directory);
  campaign.workers = *workers;
  campaign.run = [&](const SessionOptions& session) {
    return context.service.start(*directory, *experiment, {}, session);
  };
  campaign.report = [&](const SessionReport& report) -> Status {
    PrintSummary(context, report.summary, *directory, options.json);
    return Ok{};
  };
  return RunCampaign(context, options, campaign);
}

}  // namespace

ExitCode RunEvolve(CommandContext& context, const CommonOptions& options) {
  return RunSearch(context, options, {});
}

ExitCode RunRandom(CommandContext& context, const RandomOptions& options) {
  std::vector<ExtraSet> extra = {{"random", "search.algorithm=random"}};
  if (!options.cases.empty()) extra.push_back({"--cases", "search.cases=" + options.cases});
  return RunSearch(context, options.common, extra);
}

}  // namespace gauntlet::master
