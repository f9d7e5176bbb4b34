// gauntlet evolve and gauntlet random: a search on a pool of workers of this machine.
#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include "master/cli/commands.h"
#include "master/cli/run_campaign.h"
#include "master/search/search_table.h"

namespace gauntlet::master {
namespace {

struct RandomOptions : LocalOptions {
  std::string cases;
};

// What was given on the command line for another search than this.
Status CheckSettings(const LocalOptions& options, const SearchInfo& search) {
  std::vector<ExtraSet> settings = SetsOf(options.size);
  for (const std::string& set : options.experiment.sets)
    settings.push_back({"--set", set.substr(0, set.find('=')), set});
  for (const auto& [option, set, value] : settings) {
    if (!set.starts_with("search.") || set == "search.algorithm" || Reads(search, set)) continue;
    std::string known;
    for (const Key& key : CommonKeys(BuiltInCatalogue())) {
      if (!key.path.starts_with("search.") || !Reads(search, key.path)) continue;
      known += (known.empty() ? "" : ", ") + key.path;
      if (key.path == "search.cases") known += " (random --cases N)";
    }
    return InvalidInput(fmt::format("{} {}: the search '{}' does not read {}; it reads {}", option, value,
                                    search.name, set, known));
  }
  return Ok{};
}

// Runs the experiment with `extra` settings. Refused: a search of given cases, and settings that the
// experiment's search does not read.
ExitCode RunSearch(CommandContext& context, const LocalOptions& options, const std::vector<ExtraSet>& extra) {
  std::vector<ExtraSet> all = SetsOf(options.size);
  all.insert(all.end(), extra.begin(), extra.end());
  const Result<Experiment> experiment = LoadExperimentWith(options.experiment, all);
  if (!experiment) return Fail(context, experiment.error());
  const SearchRow& search = RowOf(*experiment);
  if (search.given_cases) {
    return Fail(context, InvalidInput("search.algorithm = cases needs a list of cases: use 'evaluate'"));
  }
  if (Status meant = CheckSettings(options, search.info); !meant) return Fail(context, meant.error());
  Result<CampaignRun> campaign = LocalRun(*experiment, options);
  if (!campaign) return Fail(context, campaign.error());
  campaign->run = [&](const SessionOptions& session) {
    return context.campaigns.Start(campaign->directory, *experiment, {}, session);
  };
  return RunCampaign(context, *campaign);
}

ExitCode RunEvolve(CommandContext& context, const LocalOptions& options) {
  return RunSearch(context, options, {});
}

ExitCode RunRandom(CommandContext& context, const RandomOptions& options) {
  std::vector<ExtraSet> extra = {{"random", "search.algorithm", "random"}};
  if (!options.cases.empty()) extra.push_back({"--cases", "search.cases", options.cases});
  return RunSearch(context, options, extra);
}

}  // namespace

void AddEvolve(CommandParser& parser) {
  const auto [command, options] =
      parser.Add("evolve", "evolve test cases in which the swarm fails", RunEvolve);
  AddLocalOptions(command, options, /*sizes=*/true);
  command.footer(
      R"(Evolves test cases with the experiment's search on a local pool of workers, shows progress, and ends
with a table of the toughest cases. Ctrl-C stops cleanly (exit 3); 'gauntlet resume DIR' goes on.
Same experiment, settings and seed: same result, whatever the number of workers.

Examples:
  gauntlet evolve flocking
  gauntlet evolve flocking --generations 100 --workers 8 --dir campaigns/long
  gauntlet evolve flocking --seed random --set search.crossover=uniform --json > result.json
  gauntlet evolve my-experiment.toml --set controller_parameters.bird_speed=0.1)");
}

void AddRandom(CommandParser& parser) {
  const auto [command, options] =
      parser.Add("random", "random test cases: the baseline to hold an evolution against", RunRandom);
  AddLocalOptions(command, options, /*sizes=*/false);
  AddValue(command, "--cases", "N", options.cases,
           "how many test cases (default: the experiment's search.cases)");
  command.footer(
      R"(Generates valid random test cases by the experiment's rules and simulates each once (more often with
--set search.replicates=K). The population that 'show' reports are all cases.

Examples:
  gauntlet random flocking --cases 200
  gauntlet random flocking --cases 1000 --seed 7 --dir campaigns/baseline)");
}

}  // namespace gauntlet::master
