// gauntlet margin: at which value of a setting does a swarm begin to fail, and how sure is that?
#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include "base/number_text.h"
#include "base/parse_number.h"
#include "cli/commands.h"
#include "cli/run_campaign.h"
#include "master/directory/campaign_directory.h"
#include "search/search_table.h"
#include "study/margins/margin_result.h"

namespace gauntlet {
namespace {

struct MarginOptions : LocalOptions {
  std::vector<std::string> vary;
  std::string on;
  std::string budget;
  std::string share;
};

// A search for each key, over the same cases.
Result<std::vector<SearchPlan>> PlanMargins(CommandContext& context, const MarginOptions& options) {
  if (options.vary.empty())
    return InvalidInput("along what? --vary KEY=LOW..HIGH for each key ('gauntlet list' has them all)");
  std::vector<ExtraSet> extra = {{"margin", "search.algorithm", "margin"},
                                 {"margin", "search.replicates", "1"}};
  if (!options.budget.empty()) extra.push_back({"--budget", "margin.runs", options.budget});
  if (!options.share.empty()) extra.push_back({"--share", "margin.share", options.share});
  TRY(const Experiment experiment, LoadExperimentWith(options.experiment, extra));
  TRY(const auto varied, ParseVariedKeys(options.vary, AllKeysOf(experiment), experiment));
  TRY(const std::vector<sim::TestCase> cases,
      GivenCases(context, options.on.empty() ? "random:200" : options.on, experiment, options.running.quiet));
  std::vector<SearchPlan> plans;
  for (std::size_t i = 0; i < varied.size(); ++i) {
    const std::string& path = varied[i].key.path;
    for (const std::string& set : options.experiment.sets) {
      if (set.starts_with(path + "="))
        return InvalidInput(
            fmt::format("{} is given by --set and varied by --vary: leave one of them out", path));
    }
    SearchPlan& plan = plans.emplace_back(SearchPlan{"", experiment, cases});
    plan.experiment.margin.vary = options.vary[i];
    TRY(MakeSearch(plan.experiment, cases));
    plan.experiment.margin.vary = varied[i].ToText();
    if (varied.size() > 1) plan.settings = path;
  }
  return plans;
}

Result<ExitCode> Tell(CommandContext& context, const MarginOptions& options, const std::string& dir) {
  TRY(const std::vector<Margin> margins, ReadMargins(dir));
  if (options.running.json) {
    context.out << MarginJson(margins, dir);
  } else {
    for (const Section& section : TellMargins(margins, dir, context.program)) context.out << ToText(section);
  }
  context.out << std::flush;
  return kExitDone;
}

Result<ExitCode> RunMargin(CommandContext& context, const MarginOptions& options) {
  const std::string& first = options.experiment.experiment;
  if (CampaignDirectory::IsCampaign(first)) {
    if (!options.vary.empty() || !options.on.empty() || !options.budget.empty() || !options.share.empty() ||
        !options.experiment.sets.empty() || !options.running.slurm.empty() || options.dry_run)
      return InvalidInput(first + " is a campaign: what it looks for is decided, it is told again alone");
    return Tell(context, options, first);
  }
  TRY(const std::vector<SearchPlan> plans, PlanMargins(context, options));
  return RunAndTell(context, plans, options,
                    [&](const std::string& directory) { return Tell(context, options, directory); });
}

}  // namespace

void AddMargin(CommandParser& parser) {
  const auto [command, options] = parser.Add(
      "margin", "at which value of a setting do runs begin to fail, and how sure is that?", RunMargin);
  AddLocalOptions(command, options, /*sizes=*/false);
  AddValue(command, "--vary", "KEY=RANGE", options.vary,
           "a number and its range: KEY=LOW..HIGH or KEY=LOW..HIGH:log; repeatable, to rank several");
  AddValue(
      command, "--on", "CASES", options.on,
      "random:N (default: random:200), corpus:DIR or DIR[:SUBSET] of campaigns, as in 'gauntlet compare'");
  AddValue(command, "--budget", "RUNS", options.budget, "runs along each range, at most (default: 600)");
  AddValue(command, "--share", "P", options.share,
           "of failing runs, whose crossing is looked for (default: 0.5)");
  command.footer(
      R"(Simulates the same cases with common seeds under different values of one setting, everything else as in the
experiment, first at six values over the range and then in stages of 40 runs where failures cross the share. It
assumes that failures only become more frequent along the range, or only rarer, and nothing else of the curve's
form. The value at which they cross comes with a 95 % interval: every value that a likelihood-ratio test does not
reject, with the cases as the units. 'Above' or 'below' the share everywhere is an answer too.

Several keys are ranked by the part of its range that each can take before failures cross the share, so that the
ranges which are given decide; keys whose intervals overlap share a rank. Noise of a device that the controller's
robots do not have is refused. In place of EXPERIMENT may stand the directory of such a campaign, to tell it
again.

Examples:
  gauntlet margin flocking --vary noise.omnidirectional_camera.drop=0..0.5
  gauntlet margin flocking --vary noise.proximity.gaussian=0..0.5 --vary noise.wheels.gaussian=0..0.5
  gauntlet margin flocking --vary scenario_parameters.birds=3..15 --on corpus:corpus --budget 1200
  gauntlet margin my.toml --vary controller_parameters.turn_rate=0.1..10:log --share 0.2 --json)");
}

}  // namespace gauntlet
