// gauntlet compare: two sets of runs, by the statistics that the thesis uses and by those that it lacks; or
// what searches give for the same number of runs.
#include <fmt/format.h>
#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include "analysis/figures/box_figure.h"
#include "analysis/statistics/comparison.h"
#include "analysis/tables/table.h"
#include "base/printable.h"
#include "cli/commands.h"
#include "cli/options/options.h"
#include "cli/output/budget_comparison.h"
#include "cli/output/output_file.h"
#include "controllers/registry.h"
#include "proto/json_text.h"
#include "study/questions/search_yield.h"
#include "study/sets/set_pair.h"

namespace gauntlet {
namespace {

using Json = nlohmann::ordered_json;

struct CompareOptions {
  std::vector<std::string> sets;
  bool budget = false;
  std::string metric = "fitness";
  std::string svg;
  bool mixed = false;
  bool paired = false;
  bool unpaired = false;
  bool json = false;
};

struct Outcome {
  RunSet first;
  RunSet second;
  std::vector<std::string> notes;  // of both, and what differs where that was asked for
  SetPair held;

  const analysis::Comparison& comparison() const { return held.comparison; }
  // Whether each value stands for itself, so that tests of single values are right.
  bool alone() const { return !held.paired && !comparison().relatives; }
};

Json IntervalJson(const std::optional<analysis::Interval>& interval) {
  return interval ? Json::array({interval->low, interval->high}) : Json();
}

Json OptionalJson(const std::optional<double>& value) {
  return value ? Json(*value) : Json();
}

Json BoxJson(const analysis::BoxPlot& box) {
  return {{"rule", analysis::kBoxRule},           {"lower_whisker", box.lower_whisker},
          {"lower_quartile", box.lower_quartile}, {"median", box.median},
          {"upper_quartile", box.upper_quartile}, {"upper_whisker", box.upper_whisker},
          {"outliers", box.outliers.size()}};
}

Json SetJson(const RunSet& set, const analysis::BoxPlot& box) {
  Json origins = Json::array();
  for (const RunOrigin& origin : set.origins) {
    origins.push_back({{"campaign", origin.place},
                       {"experiment", origin.experiment.name},
                       {"controller", origin.experiment.controller},
                       {"version", origin.software_version}});
  }
  return {{"set", set.values.name},
          {"unit", set.unit},
          {"units", set.values.clusters.size()},
          {"origins", std::move(origins)},
          {"box", BoxJson(box)}};
}

Json DifferenceJson(const SetPair& held) {
  const analysis::Comparison& c = held.comparison;
  if (held.paired)
    return {{"mean", held.paired->difference}, {"interval", IntervalJson(held.paired->interval)}};
  if (!c.relatives && !c.yes_no) return {};
  return {{"mean", c.difference}, {"interval", IntervalJson(c.difference_interval)}};
}

Json PairedJson(const SetPair& held) {
  if (!held.paired) return {};
  return {{"cases", held.paired->cases},     {"left_out", held.left_out},
          {"units", held.paired->units},     {"larger", held.paired->larger},
          {"smaller", held.paired->smaller}, {"effect", held.paired->effect}};
}

std::string ComparisonJson(const Outcome& outcome, const std::string& metric) {
  const analysis::Comparison& c = outcome.comparison();
  const bool alone = outcome.alone();
  const auto exact = [&](double analysis::ExactRankTest::*p) {
    return c.exact && alone ? Json((*c.exact).*p) : Json();
  };
  const auto single = [&](double p) { return alone ? Json(p) : Json(); };
  return JsonText({{"metric", metric},
                   {"n1", c.first.n},
                   {"n2", c.second.n},
                   {"mean", {c.first.mean, c.second.mean}},
                   {"sd", {OptionalJson(c.first.sd), OptionalJson(c.second.sd)}},
                   {"median", {c.first.median, c.second.median}},
                   {"rank_sum1", c.test.rank_sum1},
                   {"rank_sum2", c.test.rank_sum2},
                   {"u1", c.test.u1},
                   {"u2", c.test.u2},
                   {"a", c.test.a},
                   {"a_interval", alone ? IntervalJson(c.interval) : Json()},
                   {"a_interval_method", c.interval_method},
                   {"a_cluster_interval", Json()},
                   {"a_cluster_interval_method", alone ? c.cluster_method : "none: see difference"},
                   {"p_less", single(c.test.p_less)},
                   {"p_greater", single(c.test.p_greater)},
                   {"p_two_sided", single(c.test.p_two_sided)},
                   {"p_exact_less", exact(&analysis::ExactRankTest::p_less)},
                   {"p_exact_greater", exact(&analysis::ExactRankTest::p_greater)},
                   {"method", c.method},
                   {"effect", c.effect},
                   {"verdict", outcome.held.words},
                   {"p", OptionalJson(outcome.held.p)},
                   {"p_method", outcome.held.p_by},
                   {"difference", DifferenceJson(outcome.held)},
                   {"paired", PairedJson(outcome.held)},
                   {"sets", {SetJson(outcome.first, c.first_box), SetJson(outcome.second, c.second_box)}},
                   {"notes", outcome.notes}});
}

std::string IntervalText(const std::optional<analysis::Interval>& interval, const std::string& method) {
  return interval ? fmt::format("{:.3f} to {:.3f} ({})", interval->low, interval->high, method) : method;
}

// Right only where each value stands for itself.
std::string RankTestText(const analysis::Comparison& c) {
  Table figures({"", ""});
  figures.AddRow({"A (1 exceeds 2)", fmt::format("{:.4f}, effect: {} (0.56 small, 0.64 medium, 0.71 large)",
                                                 c.test.a, c.effect)});
  figures.AddRow({"its interval", IntervalText(c.interval, c.interval_method)});
  figures.AddRow({"p, 1 less", fmt::format("{:.4g}", c.test.p_less)});
  figures.AddRow({"p, 1 greater", fmt::format("{:.4g}", c.test.p_greater)});
  figures.AddRow({"p, two-sided", fmt::format("{:.4g}", c.test.p_two_sided)});
  figures.AddRow({"by", std::string(c.test.method)});
  if (c.exact) {
    figures.AddRow(
        {"exact p", fmt::format("less {:.4g}, greater {:.4g}", c.exact->p_less, c.exact->p_greater)});
  }
  return figures.ToText();
}

std::string ComparisonText(const Outcome& outcome, const std::string& metric) {
  const analysis::Comparison& c = outcome.comparison();
  const bool ranked = outcome.alone() && !c.yes_no;
  std::vector<Column> columns = {"", "set", ">n", ">units", ">mean", ">sd", ">median", ">quartiles"};
  if (ranked) columns.insert(columns.end(), {">rank sum", ">U"});
  Table sets(std::move(columns));
  const auto add = [&](const char* number, const RunSet& set, const analysis::Description& d,
                       const analysis::BoxPlot& box, double rank_sum, double u) {
    std::vector<Cell> row = {number,
                             Printable(set.values.name),
                             fmt::format("{}", d.n),
                             fmt::format("{} ({})", set.values.clusters.size(), set.unit),
                             FormatFitness(d.mean),
                             d.sd ? FormatFitness(*d.sd) : "-",
                             FormatFitness(d.median),
                             fmt::format("{:.3f} {:.3f}", box.lower_quartile, box.upper_quartile)};
    if (ranked) row.insert(row.end(), {fmt::format("{:.1f}", rank_sum), fmt::format("{:.1f}", u)});
    sets.AddRow(std::move(row));
  };
  add("1", outcome.first, c.first, c.first_box, c.test.rank_sum1, c.test.u1);
  add("2", outcome.second, c.second, c.second_box, c.test.rank_sum2, c.test.u2);

  std::string text = fmt::format("{}\n\n{}\n", Printable(metric), sets.ToText());
  if (ranked) text += RankTestText(c) + "\n";
  text += fmt::format("  {}\n", Wrapped(outcome.held.words, 110, 2));
  for (const std::string& note : outcome.notes) {
    text += fmt::format("  note: {}\n", Wrapped(Printable(note), 110, 2));
  }
  return text;
}

Result<Outcome> Compute(const CompareOptions& options) {
  if (options.sets.size() != 2) {
    return InvalidInput(fmt::format(
        "{} sets of runs were named, two are compared: A and B (--budget takes any number of searches)",
        options.sets.size()));
  }
  TRY(RunSet first, ReadRunSet(options.sets[0], options.metric));
  TRY(RunSet second, ReadRunSet(options.sets[1], options.metric));
  const std::vector<std::string> differences = WhatDiffers(first, second);
  if (!differences.empty() && !options.mixed) {
    return InvalidInput(fmt::format(
        "{}: not like for like{}; --mixed compares them nevertheless", differences.front(),
        differences.size() > 1 ? fmt::format(" (and {} more differences)", differences.size() - 1) : ""));
  }
  const Pairing pairing = options.paired     ? Pairing::kDemanded
                          : options.unpaired ? Pairing::kNever
                                             : Pairing::kWhereShared;
  TRY(SetPair held, HoldAgainst(first, second, options.metric, "set 1", "set 2", pairing));
  Outcome outcome{std::move(first), std::move(second), {}, std::move(held)};
  for (const std::string& difference : differences) {
    outcome.notes.push_back("not like for like: " + difference);
  }
  for (const RunSet* set : {&outcome.first, &outcome.second}) {
    outcome.notes.insert(outcome.notes.end(), set->notes.begin(), set->notes.end());
  }
  if (outcome.first.origins.empty() != outcome.second.origins.empty()) {
    outcome.notes.emplace_back(
        "a CSV file does not say what its runs are of: nobody has checked that they are like for like");
  }
  return outcome;
}

std::string AxisName(const Outcome& outcome, const std::string& metric) {
  if (outcome.first.origins.empty()) return metric;
  const Experiment& experiment = outcome.first.origins.front().experiment;
  const auto* scenario = controllers::FindScenario(experiment);
  const auto* info = scenario == nullptr ? nullptr : controllers::FindMetric(*scenario, metric);
  return info == nullptr || info->unit.empty() ? metric : fmt::format("{}, {}", metric, info->unit);
}

std::string Drawing(const Outcome& outcome, const std::string& metric) {
  const analysis::Comparison& c = outcome.comparison();
  return analysis::DrawBoxes(
      {.title =
           fmt::format("{}: {} against {}", metric, outcome.first.values.name, outcome.second.values.name),
       .outcome = fmt::format("A = {:.3f} ({}), {}", c.test.a, c.effect,
                              analysis::TestInWords(outcome.held.p, outcome.held.p_by)),
       .axis_name = AxisName(outcome, metric),
       .boxes = {{"1: " + outcome.first.values.name, c.first_box, c.first.mean, c.first.n},
                 {"2: " + outcome.second.values.name, c.second_box, c.second.mean, c.second.n}}});
}

Result<ExitCode> CompareBudgets(CommandContext& context, const CompareOptions& options) {
  std::vector<YieldSet> sets;
  for (const std::string& text : options.sets) {
    TRY(YieldSet set, ReadYields(text));
    sets.push_back(std::move(set));
  }
  TRY(CheckSameBudget(sets));
  context.out << (options.json ? JsonText(BudgetJson(sets)) : BudgetText(sets)) << std::flush;
  return kExitDone;
}

Result<ExitCode> RunCompare(CommandContext& context, const CompareOptions& options) {
  if (options.budget) return CompareBudgets(context, options);
  TRY(const Outcome outcome, Compute(options));
  if (!options.svg.empty()) {
    TRY(WriteOutputFile(options.svg, Drawing(outcome, options.metric)));
    PrintMessage(context, fmt::format("wrote {}", options.svg));
  }
  context.out << (options.json ? ComparisonJson(outcome, options.metric)
                               : ComparisonText(outcome, options.metric))
              << std::flush;
  return kExitDone;
}

}  // namespace

void AddCompare(CommandParser& parser) {
  const auto [command, options] = parser.Add(
      "compare", "test whether one set of runs is worse than another, and by how much", RunCompare);
  command
      .add_option(
          "SET", options.sets,
          "two sets of runs, A and B, each DIR[:SUBSET] or FILE.csv[:COLUMN]; commas join several to one set")
      ->required();
  CLI::Option* budget =
      command.add_flag("--budget", options.budget,
                       "compare campaigns instead, by the different failures that their searches found");
  AddValue(command, "--metric", "NAME", options.metric,
           "the value to compare: fitness (the default), total_failure, failure_type or a metric of the "
           "scenario ('gauntlet list')")
      ->excludes(budget);
  AddValue(command, "--svg", "F", options.svg, "draw box plots of both sets")->excludes(budget);
  command
      .add_flag("--mixed", options.mixed,
                "also compare runs of different scenarios, scenario parameters or versions, and say so")
      ->excludes(budget);
  CLI::Option* paired = command.add_flag(
      "--paired", options.paired, "compare case by case, also where one set has cases that the other lacks");
  command
      .add_flag("--unpaired", options.unpaired,
                "do not compare case by case, though both are of the same cases")
      ->excludes(paired)
      ->excludes(budget);
  paired->excludes(budget);
  command.add_flag("--json", options.json, "print the result as one JSON document");
  command.footer(
      R"(The subsets of a campaign have one value for each run:
  final       the newest evaluation of every member of the population (the default); for 'random' and
              'evaluate', all cases. The fitness of selected cases is biased, because luck helped to select them:
              simulate them again with fresh seeds first ('gauntlet evaluate --from').
  all         every run
  random:N    N runs, drawn at random; always the same ones
  worst:N     the N runs of lowest fitness; of equal ones, the earlier
  search:K:   before one of these: only search K of a sweep

What is printed is the one test that is right for the sets. Where all cases of the smaller set are cases of the
other, they are compared case by case (Wilcoxon's signed ranks; of yes/no metrics McNemar's test). Runs of one
evolution or of one case resemble each other: then the means of whole evolutions or cases are compared, and fewer
than six of either set give no p. Else the test is Mann-Whitney's U, with the normal approximation (corrected for
ties and continuity) and exact up to 10,000 pairs; Vargha and Delaney's A is the probability that a run of the first
set exceeds a run of the second; of yes/no metrics it is Fisher's, with the difference of the shares and their
ratio. Lower fitness means a tougher case. Which controller is better, 'gauntlet compare-controllers' says.

--budget compares searches that had equally many runs. Each campaign holds one search with several seeds; DIR,DIR,...
joins campaigns of one seed each. It counts the cells, as in an archive search, with a case that failed in at least
half of its runs with fresh seeds. Simulate these first: 'gauntlet confirm DIR --elites' for an archive search,
'gauntlet confirm DIR --all-failing' for any other. The first campaign is tested against each of the others.

Examples:
  gauntlet compare --budget campaigns/archive campaigns/random-deletion campaigns/random
  gauntlet compare campaigns/random:random:100 campaigns/evolved-1,campaigns/evolved-2
  gauntlet compare DIR:all results.csv:fitness --json
  gauntlet compare before after --metric food_delivered --svg boxes.svg)");
}

}  // namespace gauntlet
