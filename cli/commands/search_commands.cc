// gauntlet evolve and gauntlet random: a search on a pool of workers of this machine.
#include <set>

#include <CLI/CLI.hpp>

#include "cli/commands.h"
#include "cli/dry_run.h"
#include "cli/options/sweep.h"
#include "cli/run_campaign.h"
#include "search/search_table.h"
#include "study/questions/baselines.h"
#include "study/questions/empty_arena.h"

namespace gauntlet {
namespace {

struct SearchOptions : LocalOptions {
  SweepOptions sweep;
  bool needs_passing = false;  // a run without obstacles that does not fail
};

struct EvolveOptions : SearchOptions {
  bool even_if_it_fails = false;
};

struct RandomOptions : SearchOptions {
  std::string cases;
};

// A search for obstacles that make a swarm fail needs one that does not always fail without any. Gives the
// runs without obstacles of the first search.
Result<FailureTally> CheckEmptyArenas(const std::vector<SearchPlan>& searches, const SearchOptions& options) {
  FailureTally first;
  std::set<std::string> checked;  // controllers
  for (const SearchPlan& search : searches) {
    const Experiment& experiment = search.experiment;
    if (!HasBaseline(experiment.search.algorithm) || !checked.insert(experiment.controller).second) continue;
    // What keeps a run from being simulated at all, the campaign itself will tell better.
    const Result<FailureTally> tally = FirstEmptyRuns(experiment, options.dry_run);
    if (!tally) continue;
    if (checked.size() == 1) first = *tally;
    if (options.needs_passing) {
      TRY(CheckEmptyArena(experiment, *tally));
    }
  }
  return first;
}

// Runs the experiment with `extra` settings, once or as a sweep.
Result<ExitCode> RunSearches(CommandContext& context, const SearchOptions& options,
                             const std::vector<ExtraSet>& extra) {
  std::vector<ExtraSet> all = SetsOf(options.size);
  all.insert(all.end(), extra.begin(), extra.end());
  TRY(const std::vector<SearchPlan> searches, PlanSearches(options.experiment, all, options.sweep));
  if (!options.running.quiet) TellOfIdleSettings(context, searches);
  FailureTally without_obstacles;
  if (options.needs_passing || options.dry_run) {
    TRY(without_obstacles, CheckEmptyArenas(searches, options));
  }
  TRY(CampaignRun campaign, LocalRun(context, searches, options));
  if (options.dry_run) return PrintDryRun(context, campaign, searches, without_obstacles);
  campaign.looks_at_empty_arena = HasBaseline(searches.front().experiment.search.algorithm);
  campaign.run = [&](const SessionOptions& session) {
    return context.campaigns.Start(campaign.directory, searches, session);
  };
  return RunCampaign(context, campaign);
}

Result<ExitCode> RunEvolve(CommandContext& context, const EvolveOptions& options) {
  SearchOptions search = options;
  search.needs_passing = !options.even_if_it_fails;
  return RunSearches(context, search, {});
}

Result<ExitCode> RunRandom(CommandContext& context, const RandomOptions& options) {
  std::vector<ExtraSet> extra = {{"random", "search.algorithm", "random"}};
  if (!options.cases.empty()) extra.push_back({"--cases", "search.cases", options.cases});
  return RunSearches(context, options, extra);
}

}  // namespace

void AddEvolve(CommandParser& parser) {
  const auto [command, options] =
      parser.Add("evolve", "evolve test cases in which the swarm fails", RunEvolve);
  AddLocalOptions(command, options, /*sizes=*/true);
  AddSweepOptions(command, options.sweep);
  command.add_flag("--even-if-it-fails-without-obstacles", options.even_if_it_fails,
                   "go on though the first 5 runs without obstacles all fail, so that no layout is to blame");
  command.footer(
      R"(Evolves test cases with the experiment's search on workers of this machine, shows the progress, and ends
with a table of the toughest cases. Ctrl-C stops the campaign (exit 3), and 'gauntlet resume DIR' continues it.
The same experiment, settings and seed give the same result for any number of workers.

With --sweep or --seeds the campaign holds many searches. They share the workers, so that no core waits for the
end of a generation. Each search gives the same result as 'evolve' with its --set and --seed; 'show' lists them.

Examples:
  gauntlet evolve flocking
  gauntlet evolve flocking --generations 100 --workers 8 --dir campaigns/long
  gauntlet evolve flocking --seed random --set search.crossover=uniform --json > result.json
  gauntlet evolve flocking --seeds 1..10 --dry-run
  gauntlet evolve flocking --sweep search.mutation_probability=0.02,0.05,0.1 --seeds 1..10
  gauntlet evolve my-experiment.toml --set controller_parameters.bird_speed=0.1)");
}

void AddRandom(CommandParser& parser) {
  const auto [command, options] =
      parser.Add("random", "simulate random test cases, a baseline for an evolution", RunRandom);
  AddLocalOptions(command, options, /*sizes=*/false);
  AddSweepOptions(command, options.sweep);
  AddValue(command, "--cases", "N", options.cases,
           "number of test cases (default: the experiment's search.cases)");
  command.footer(
      R"(Generates valid random test cases by the experiment's rules and simulates each of them once, or K times
with --set search.replicates=K. 'show' then reports all cases as the population.

Examples:
  gauntlet random flocking --cases 200
  gauntlet random flocking --cases 1000 --seed 7 --dir campaigns/baseline
  gauntlet random flocking --cases 100 --sweep scenario_parameters.birds=3,5,7)");
}

}  // namespace gauntlet
