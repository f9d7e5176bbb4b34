// gauntlet evolve, gauntlet random: a search on a pool of workers.
#include <memory>

#include <CLI/CLI.hpp>

#include "master/cli/commands.h"
#include "master/cli/common_options.h"
#include "master/cli/run_campaign.h"

namespace gauntlet::master {
namespace {

ExitCode RunSearch(CommandContext& context, const CommonOptions& options,
                   const std::vector<ExtraSet>& extra) {
  const Result<Experiment> experiment = LoadExperimentWith(options, extra);
  if (!experiment) return Fail(context, experiment.error());
  if (experiment->search.kind == SearchKind::kCases) {
    return Fail(context, InvalidInput("search.algorithm = cases needs a list of cases: use 'evaluate'"));
  }
  const Result<int> workers = ParseWorkers(options.workers);
  if (!workers) return Fail(context, workers.error());
  const Result<std::string> directory = NewDirectory(options, *experiment, context.program);
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

void AddEvolveCommand(CLI::App& app, CommandAction& chosen) {
  CLI::App* command = app.add_subcommand("evolve", "evolve test cases in which the swarm fails");
  const auto options = std::make_shared<CommonOptions>();
  AddCommonOptions(*command, *options);
  command->footer(
      "\nEvolves test cases with the experiment's search on a local pool of workers, shows progress, and "
      "ends\n"
      "with a table of the toughest cases. Ctrl-C stops cleanly (exit 3); 'gauntlet resume DIR' goes on.\n"
      "Same experiment, settings and seed: same result, whatever the number of workers.\n"
      "\n"
      "Examples:\n"
      "  gauntlet evolve flocking\n"
      "  gauntlet evolve flocking --generations 100 --workers 8 --dir campaigns/long\n"
      "  gauntlet evolve flocking --seed random --set search.crossover=uniform --json > result.json\n"
      "  gauntlet evolve my-experiment.toml --set controller_parameters.bird_speed=0.1");
  command->callback([options, &chosen] {
    chosen = [options](CommandContext& context) { return RunSearch(context, *options, {}); };
  });
}

void AddRandomCommand(CLI::App& app, CommandAction& chosen) {
  CLI::App* command =
      app.add_subcommand("random", "random test cases: the baseline to hold an evolution against");
  const auto options = std::make_shared<CommonOptions>();
  const auto cases = std::make_shared<std::string>();
  AddCommonOptions(*command, *options);
  command->add_option("--cases", *cases, "how many test cases (default: the experiment's search.cases)")
      ->type_name("N");
  command->footer(
      "\nGenerates valid random test cases by the experiment's rules and simulates each once (more with\n"
      "--set search.replicates=K). The population that 'show' reports are all cases.\n"
      "\n"
      "Examples:\n"
      "  gauntlet random flocking --cases 200\n"
      "  gauntlet random flocking --cases 1000 --seed 7 --dir campaigns/baseline");
  command->callback([options, cases, &chosen] {
    chosen = [options, cases](CommandContext& context) {
      std::vector<ExtraSet> extra = {{"random", "search.algorithm=random"}};
      if (!cases->empty()) extra.push_back({"--cases", "search.cases=" + *cases});
      return RunSearch(context, *options, extra);
    };
  });
}

}  // namespace gauntlet::master
