// gauntlet probability: how likely is it that a swarm fails, over stated conditions?
#include <CLI/CLI.hpp>

#include "base/parse_number.h"
#include "cli/commands.h"
#include "cli/options/sweep.h"
#include "cli/run_campaign.h"
#include "master/directory/campaign_directory.h"
#include "search/search_table.h"
#include "study/probabilities/probability_result.h"

namespace gauntlet {
namespace {

struct ProbabilityOptions : LocalOptions {
  std::vector<std::string> vary;
  std::string on;
  std::string below;
  std::string budget;
  std::string within;
  bool plain = false;

  bool Any() const {
    return !vary.empty() || !on.empty() || !below.empty() || !budget.empty() || !within.empty() || plain ||
           !experiment.sets.empty() || !running.slurm.empty() || dry_run;
  }
};

Result<SearchPlan> PlanProbability(CommandContext& context, const ProbabilityOptions& options) {
  std::vector<ExtraSet> extra = {{"probability", "search.algorithm", "probability"},
                                 {"probability", "search.replicates", "1"}};
  for (const std::string& text : options.vary) {
    const std::size_t equals = text.find('=');
    if (equals == std::string::npos || equals == 0)
      return InvalidInput("--vary " + text +
                          ": KEY=LOW..HIGH, KEY=LOW..HIGH:log, KEY=LOW..HIGH:normal or "
                          "KEY=A:2|B:1 is needed");
    extra.push_back({"--vary " + text.substr(0, equals + 1), "conditions." + text.substr(0, equals),
                     text.substr(equals + 1)});
  }
  if (!options.below.empty()) {
    if (const auto p = ParseNumber<double>(options.below); p && (*p <= 0.0 || *p >= 1.0))
      return InvalidInput("--below " + options.below + ": want a probability between 0 and 1");
    extra.push_back({"--below", "probability.below", options.below});
  }
  if (!options.budget.empty()) extra.push_back({"--budget", "probability.runs", options.budget});
  if (!options.within.empty()) extra.push_back({"--within", "probability.within", options.within});
  if (options.plain) extra.push_back({"--plain", "probability.plain", "true"});
  SearchPlan plan;
  TRY(plan.experiment, LoadExperimentWith(options.experiment, extra));
  if (options.on.empty()) {
    plan.cases = {EmptyArena(plan.experiment.arena)};
  } else {
    TRY(plan.cases, GivenCases(context, options.on, plan.experiment, options.running.quiet));
  }
  TRY(MakeSearch(plan.experiment, plan.cases));
  return plan;
}

Result<ExitCode> Tell(CommandContext& context, const ProbabilityOptions& options, const std::string& dir) {
  TRY(const FailureProbability probability, ReadProbability(dir));
  if (options.running.json) {
    context.out << ProbabilityJson(probability, dir);
  } else {
    for (const Section& section : TellProbability(probability, dir, context.program))
      context.out << ToText(section);
  }
  context.out << std::flush;
  return kExitDone;
}

Result<ExitCode> RunProbability(CommandContext& context, const ProbabilityOptions& options) {
  const std::string& first = options.experiment.experiment;
  if (CampaignDirectory::IsCampaign(first)) {
    if (options.Any())
      return InvalidInput(first + " is a campaign: what it looks for is decided, it is told again alone");
    return Tell(context, options, first);
  }
  TRY(const SearchPlan plan, PlanProbability(context, options));
  if (!options.running.quiet) TellOfIdleSettings(context, {plan});
  return RunAndTell(context, {plan}, options,
                    [&](const std::string& directory) { return Tell(context, options, directory); });
}

}  // namespace

void AddProbability(CommandParser& parser) {
  const auto [command, options] = parser.Add(
      "probability", "how likely is it that a swarm fails, over stated conditions?", RunProbability);
  AddLocalOptions(command, options, /*sizes=*/false);
  AddValue(
      command, "--vary", "KEY=DISTRIBUTION", options.vary,
      "what is drawn beside the arena, as in [conditions]: KEY=LOW..HIGH, with :log or :normal behind it, or "
      "KEY=A:2|B:1; repeatable");
  AddValue(command, "--on", "CASES", options.on,
           "arenas that are drawn of: random:N, corpus:DIR or DIR[:SUBSET] (default: new ones, by the ranges "
           "of the experiment's [genome])");
  AddValue(command, "--below", "P", options.below, "end when it is surely below or above P");
  AddValue(command, "--budget", "RUNS", options.budget, "at most (default: 20000)");
  AddValue(command, "--within", "SHARE", options.within,
           "end when half the interval is such a share of the estimate (default: 0.25; 0: never)");
  command.add_flag("--plain", options.plain, "plain samples only, however rare failures are");
  command.footer(
      R"(Draws arenas, what [conditions] of the experiment states, and a seed for each run, and counts failures. The
interval holds at every moment at once, so that it may end as soon as it is narrow enough, or surely on one side
of P. Where fewer than ten runs of a tenth of the budget fail and the experiment has [requirements], adaptive
multilevel splitting goes on from those that came nearest to failing; where it is not the conditions but the seed
that decides, this does not pay, and it says so and samples on.

It also tells how the probability falls on ways of failing, and the likeliest failures, which confirm and minimise
take. In place of EXPERIMENT may stand the directory of such a campaign, to tell it again.

Examples:
  gauntlet probability flocking
  gauntlet probability flocking --vary noise.proximity.gaussian=0..0.2 --below 0.05
  gauntlet probability flocking-required --budget 50000 --within 0.1
  gauntlet probability foraging --on corpus:corpus --vary controller_parameters.turn_rate=0.9..1.1:normal --json)");
}

}  // namespace gauntlet
