// What `gauntlet compare-controllers` asks: which of two controllers fails less in the same cases?
#include <algorithm>
#include <cmath>
#include <map>
#include <span>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "analysis/statistics/comparison.h"
#include "analysis/statistics/multiple_tests.h"
#include "base/number_text.h"
#include "base/shell_quoted.h"
#include "controllers/registry.h"
#include "proto/json_text.h"
#include "proto/run_text.h"
#include "search/search_table.h"
#include "study/questions/chosen_cases.h"
#include "study/questions/corpus_experiment.h"
#include "study/questions/question_table.h"
#include "study/sets/paired_comparison.h"
#include "study/sets/run_set.h"

namespace gauntlet {
namespace {

using Json = nlohmann::ordered_json;

constexpr double kSignificance = 0.05;
constexpr std::size_t kMostNamed = 5;  // cases that a sentence names
constexpr const char* kSides[] = {"A", "B"};

// A case with both controllers.
struct Pair {
  const CaseAnswer* sides[2] = {};
  std::size_t unit = 0;

  const std::string& name() const { return sides[0]->name; }
  bool HasResults() const {
    return std::ranges::all_of(sides, [](const CaseAnswer* one) { return one->tally().runs() > 0; });
  }
  double Share(std::size_t side) const {
    const FailureTally tally = sides[side]->tally();
    return static_cast<double>(tally.failures) / tally.runs();
  }
  // In more than half of its runs.
  bool Fails(std::size_t side) const { return Share(side) > 0.5; }
};

// What stands in the way of holding the two against each other.
Status CheckAlike(const Experiment& a, const Experiment& b) {
  RunSet first;
  RunSet second;
  first.origins = {{"A", a, "", {}}};
  second.origins = {{"B", b, "", {}}};
  const std::vector<std::string> differences = WhatDiffers(first, second);
  if (!differences.empty())
    return InvalidInput(differences.front() + ": the two are to do the same, so that their failures compare");
  if (CaseHash(EmptyArena(a.arena)) == CaseHash(EmptyArena(b.arena))) return Ok{};
  return InvalidInput(
      "A and B have different arenas, so no case is one of both: --set arena.KEY=VALUE is for both");
}

// What else they differ in, which is compared as well.
std::string OtherDifferences(const Experiment& a, const Experiment& b) {
  const auto there = SettingsOf(a);
  std::map<std::string, std::string> of_b;
  for (auto& setting : SettingsOf(b)) of_b.insert(std::move(setting));
  std::string words;
  for (const auto& [key, value] : there) {
    const auto other = of_b.find(key);
    if (key.starts_with("controller") || (other != of_b.end() && other->second == value)) continue;
    words += fmt::format("{}{} {} with A, {} with B", words.empty() ? "" : "; ", key, value,
                         other == of_b.end() ? "as by default" : other->second);
  }
  return words;
}

// The search of each group with A, then of each with B: with equal seeds, so that equal cases have equal
// ones.
Call WithSearches(const Asking& asking, const ChosenCases& chosen) {
  Call call;
  const Experiment* sides[] = {&asking.experiment, &*asking.other};
  for (std::size_t side = 0; side < 2; ++side) {
    auto about = std::make_shared<Experiment>(*sides[side]);
    for (std::size_t i = 0; i < chosen.groups.size(); ++i) {
      const ChosenCases::Group& group = chosen.groups[i];
      about->seed = asking.experiment.seed + i;
      about->search = asking.experiment.search;
      about->search.algorithm = group.related ? "resimulation" : "cases";
      const std::string of = chosen.groups.size() > 1 ? fmt::format(", {}", group.place) : "";
      call.searches.push_back({fmt::format("{}: {}{}", kSides[side], about->name, of), *about});
    }
  }
  return call;
}

Result<Call> PlanComparison(const Asking& asking) {
  if (!asking.place.empty()) {
    TRY(auto answers, AnswersOfCall(asking.place, KeyOfCase));
    return Call{.directory = asking.place, .cases = std::move(answers)};
  }
  if (!asking.other)
    return InvalidInput("which is the other controller? A second EXPERIMENT, or --set-b KEY=VALUE");
  const Experiment& a = asking.experiment;
  const Experiment& b = *asking.other;
  TRY(CheckAlike(a, b));
  const std::string on = asking.Has("--on") ? asking.Value("--on") : "random:200";
  TRY(const ChosenCases chosen, ChooseCases(on, a));
  if (const std::string others = OtherDifferences(a, b); !others.empty())
    asking.say("they differ in more than the controller: " + others);
  if (!asking.quiet) {
    for (const std::string& note : chosen.notes) asking.say(note);
  }
  Call call = WithSearches(asking, chosen);
  std::size_t refused = 0;
  std::string first_refusal;
  for (std::size_t i = 0; i < chosen.groups.size(); ++i) {
    for (const sim::TestCase& one : chosen.groups[i].cases) {
      auto refusal = RefusalOf(a, one);
      if (!refusal) refusal = RefusalOf(b, one);
      if (refusal) {
        if (refused++ == 0) first_refusal = fmt::format("{}: {}", one.name, refusal->message);
        continue;
      }
      for (const std::size_t search : {i, i + chosen.groups.size()}) {
        call.searches[search].cases.push_back(one);
        call.cases.push_back({.name = one.name, .search = search, .test_case = one});
      }
    }
  }
  if (refused > 0)
    asking.say(fmt::format("{} left out, as a rule is broken ({})", Counted(refused, "case"), first_refusal));
  if (call.cases.empty()) return InvalidInput("no case is left that both swarms can be put into");
  std::ranges::stable_sort(call.cases, {}, &CaseAnswer::search);
  for (std::size_t i = call.searches.size(); i-- > 0;) {
    if (!call.searches[i].cases.empty()) continue;
    call.searches.erase(call.searches.begin() + static_cast<std::ptrdiff_t>(i));
    for (CaseAnswer& one : call.cases) one.search -= one.search > i ? 1 : 0;
  }
  std::vector<std::shared_ptr<const Experiment>> experiments;
  for (const SearchPlan& plan : call.searches)
    experiments.push_back(std::make_shared<const Experiment>(plan.experiment));
  for (CaseAnswer& one : call.cases) one.experiment = experiments[one.search];
  return call;
}

// The first half of the answers is A's, the second B's. Error: they are no such halves, or not all there.
Result<std::vector<Pair>> PairsOf(const Asking& asking, const std::string& directory,
                                  std::span<const CaseAnswer> answers) {
  const std::size_t half = answers.size() / 2;
  const bool halves = !answers.empty() && answers.size() % 2 == 0;
  std::vector<Pair> pairs;
  std::size_t alone = 0;
  for (std::size_t i = 0; halves && i < half; ++i) {
    const CaseAnswer* one[] = {&answers[i], &answers[half + i]};
    if (CaseHash(one[0]->test_case) != CaseHash(one[1]->test_case) || one[0]->experiment == nullptr) break;
    const bool related = RowOf(*one[0]->experiment).Related();
    const bool as_before = i > 0 && one[0]->search == answers[i - 1].search;
    if (!related || !as_before) ++alone;
    pairs.push_back({{one[0], one[1]}, alone});
  }
  if (!halves || pairs.size() != half)
    return InvalidInput(directory + " is no comparison of two controllers");
  const auto unfinished = std::ranges::count(answers, false, &CaseAnswer::decided);
  if (unfinished == 0) return pairs;
  return InvalidInput(
      fmt::format("{0}: {1} of {2} cases are not decided yet; '{3} resume {0}' goes on, then "
                  "'{3} compare-controllers {0}' tells",
                  PastedPath(directory), unfinished, answers.size(), asking.program));
}

// Mean of a metric over the runs of a case in which there was something to measure.
std::optional<double> MeanOf(const CaseAnswer& answer, const std::string& metric,
                             const controllers::MetricInfo* info) {
  double sum = 0.0;
  int count = 0;
  for (const CaseRun& run : answer.runs) {
    if (run.result.verdict != sim::Verdict::kCompleted) continue;
    std::optional<double> value;
    if (metric == "fitness") {
      value = run.result.fitness;
    } else if (const auto found =
                   std::ranges::find(run.result.metrics, metric, [](const auto& one) { return one.first; });
               found != run.result.metrics.end()) {
      value = MeasuredValue(info, found->second);
    }
    if (!value || !std::isfinite(*value)) continue;
    sum += *value;
    ++count;
  }
  return count == 0 ? std::optional<double>() : sum / count;
}

struct ComparedMetric {
  std::string name;
  std::string unit;
  bool yes_no = false;
  PairedComparison comparison;
  double adjusted = 1.0;  // p after Holm, of those that have one
};

PairedValues FailuresOf(const std::vector<Pair>& pairs) {
  PairedValues values{.yes_no = true, .single = true};
  for (const Pair& pair : pairs) {
    values.Add({pair.Share(0), pair.Share(1)}, pair.unit);
    for (std::size_t side = 0; side < 2; ++side) {
      const int runs = pair.sides[side]->tally().runs();
      values.single = values.single && runs == 1;
      values.runs_each[side] += runs / static_cast<double>(pairs.size());
    }
  }
  return values;
}

// Fitness and the metrics of the scenario that were measured in a case with both.
std::vector<ComparedMetric> MetricsOf(const std::vector<Pair>& pairs) {
  const controllers::ScenarioInfo* scenario = controllers::FindScenario(*pairs.front().sides[0]->experiment);
  std::vector<std::string> names = {"fitness"};
  for (const Pair& pair : pairs) {
    for (const CaseRun& run : pair.sides[0]->runs) {
      if (names.size() > 1) break;  // a run without a result has none
      for (const auto& [name, value] : run.result.metrics) names.push_back(name);
    }
  }
  std::vector<ComparedMetric> metrics;
  for (const std::string& name : names) {
    const controllers::MetricInfo* info =
        scenario == nullptr || name == "fitness" ? nullptr : controllers::FindMetric(*scenario, name);
    PairedValues values;
    for (const Pair& pair : pairs) {
      const auto a = MeanOf(*pair.sides[0], name, info);
      const auto b = MeanOf(*pair.sides[1], name, info);
      if (a && b) values.Add({*a, *b}, pair.unit);
    }
    if (values.cases.empty()) continue;
    ComparedMetric& one = metrics.emplace_back();
    one.name = name;
    one.unit = info == nullptr ? "" : info->unit;
    one.yes_no = values.yes_no = one.unit == "yes/no";
    values.single = std::ranges::all_of(pairs, [](const Pair& pair) {
      return pair.sides[0]->runs.size() == 1 && pair.sides[1]->runs.size() == 1;
    });
    for (std::size_t side = 0; side < 2; ++side)
      values.runs_each[side] = static_cast<double>(pairs.front().sides[side]->runs.size());
    one.comparison = ComparePairs(values);
  }
  std::vector<double> p;
  for (const ComparedMetric& one : metrics) {
    if (one.comparison.p) p.push_back(*one.comparison.p);
  }
  p = analysis::HolmAdjusted(p);
  auto next = p.begin();
  for (ComparedMetric& one : metrics) {
    if (one.comparison.p) one.adjusted = *next++;
  }
  return metrics;
}

Table MetricsTable(const std::vector<ComparedMetric>& metrics) {
  Table table({{"metric", "name"},
               ForPrograms("unit"),
               {">cases", "cases"},
               {">mean of A", "mean_a"},
               {">mean of B", "mean_b"},
               {"A - B (95 %)"},
               ForPrograms("difference"),
               ForPrograms("interval"),
               {">A larger", "a_larger"},
               {">smaller", "a_smaller"},
               {">effect", "effect"},
               {">p (Holm)", "p_holm"},
               ForPrograms("p"),
               ForPrograms("method")});
  for (const ComparedMetric& one : metrics) {
    const PairedComparison& c = one.comparison;
    table.AddRow({one.name, one.unit, CountCell(c.cases), FitnessCell(c.means[0]), FitnessCell(c.means[1]),
                  DifferenceInWords(c, one.yes_no), c.difference, IntervalCell(c.interval),
                  CountCell(c.larger), CountCell(c.smaller), DecimalCell(c.effect, 2),
                  c.p ? DigitsCell(one.adjusted, 2) : Cell(), c.p ? Cell(*c.p) : Cell(), c.method});
  }
  return table;
}

Table ChangedTable(const std::vector<const Pair*>& pairs) {
  Table table({{"case", "case"},
               {">failed with A", "failures_a runs_a"},
               {">with B", "failures_b runs_b"},
               {">run with A", "run_a"},
               {">with B", "run_b"}});
  for (const Pair* pair : pairs) {
    const FailureTally a = pair->sides[0]->tally();
    const FailureTally b = pair->sides[1]->tally();
    table.AddRow({pair->name(), OutOfCell(a.failures, a.runs()), OutOfCell(b.failures, b.runs()),
                  pair->sides[0]->runs.front().id, pair->sides[1]->runs.front().id});
  }
  return table;
}

std::string NamedIn(const std::vector<const Pair*>& pairs) {
  std::string names;
  for (std::size_t i = 0; i < std::min(pairs.size(), kMostNamed); ++i)
    names += fmt::format("{}{}", i == 0 ? "" : ", ", pairs[i]->name());
  if (pairs.size() > kMostNamed) names += fmt::format(" and {} more", pairs.size() - kMostNamed);
  return pairs.empty() ? "" : fmt::format(": {}", names);
}

// The side that fails less, if that is no matter of chance; "" = neither.
std::string BetterOf(const PairedComparison& failures) {
  if (!failures.p || *failures.p >= kSignificance || failures.difference == 0.0) return "";
  return failures.difference < 0.0 ? "A" : "B";
}

std::string Verdict(const PairedComparison& failures) {
  const std::string better = BetterOf(failures);
  const std::string test = analysis::TestInWords(failures.p, failures.method);
  const auto points = [](double share) { return fmt::format("{:.1f}", 100.0 * share); };
  const std::string range = DifferenceInWords(failures, /*yes_no=*/true);
  if (better.empty())
    return fmt::format("Neither is {}: A less B is {}{}; {}.",
                       failures.p ? "shown to be better" : "called better", range,
                       failures.p ? ", which may be a matter of chance" : "", test);
  const std::string worse = better == "A" ? "B" : "A";
  const analysis::Interval& interval = *failures.interval;
  const bool a_is = better == "A";
  const double least = a_is ? -interval.high : interval.low;
  const double most = a_is ? -interval.low : interval.high;
  return fmt::format("{} is better: it fails {} percentage points less often than {} ({} to {}); {}.", better,
                     points(std::abs(failures.difference)), worse, points(least), points(most), test);
}

struct Findings {
  std::vector<Pair> pairs;
  std::size_t left_out = 0;
  PairedComparison failures;
  std::vector<ComparedMetric> metrics;
  std::vector<const Pair*> mended;  // fail with B and not with A
  std::vector<const Pair*> broken;  // the other way round
};

Result<Findings> FindingsIn(const Asking& asking, const Call& call, std::span<const CaseAnswer> answers) {
  Findings found;
  TRY(found.pairs, PairsOf(asking, call.directory, answers));
  found.left_out = std::erase_if(found.pairs, [](const Pair& pair) { return !pair.HasResults(); });
  if (found.pairs.empty())
    return InvalidInput(call.directory + ": no case has a result with both controllers");
  found.failures = ComparePairs(FailuresOf(found.pairs));
  found.metrics = MetricsOf(found.pairs);
  for (const Pair& pair : found.pairs) {
    if (pair.Fails(1) && !pair.Fails(0)) found.mended.push_back(&pair);
    if (pair.Fails(0) && !pair.Fails(1)) found.broken.push_back(&pair);
  }
  return found;
}

// Both by what tells them apart: their experiments, else their controllers, else as everywhere here.
std::array<std::string, 2> NamesOf(const Findings& found) {
  const Experiment& a = *found.pairs.front().sides[0]->experiment;
  const Experiment& b = *found.pairs.front().sides[1]->experiment;
  if (a.name != b.name) return {a.name, b.name};
  if (a.controller != b.controller) return {a.controller, b.controller};
  return {kSides[0], kSides[1]};
}

std::string ComparisonJson(const Call& call, const Findings& found) {
  const PairedComparison& f = found.failures;
  const auto names = NamesOf(found);
  Json sides = Json::array();
  std::array<FailureTally, 2> tallies;
  for (std::size_t side = 0; side < 2; ++side) {
    for (const Pair& pair : found.pairs) {
      tallies[side].failures += pair.sides[side]->tally().failures;
      tallies[side].passes += pair.sides[side]->tally().passes;
    }
    const Experiment& experiment = *found.pairs.front().sides[side]->experiment;
    sides.push_back(
        {{"name", names[side]}, {"experiment", experiment.name}, {"controller", experiment.controller}});
  }
  const auto rate = [&](std::size_t side) {
    return Json{{"k", tallies[side].failures},
                {"n", tallies[side].runs()},
                {"rate", f.means[side]},
                {"interval", JsonValue(IntervalCell(f.intervals[side]).value)}};
  };
  const std::string better = BetterOf(f);
  return JsonText({{"directory", call.directory},
                   {"a", names[0]},
                   {"b", names[1]},
                   {"controllers", std::move(sides)},
                   {"cases", f.cases},
                   {"left_out", found.left_out},
                   {"unit", f.relatives ? "evolution" : "case"},
                   {"units", f.units},
                   {"better", better.empty() ? Json() : Json(names[better == kSides[0] ? 0 : 1])},
                   {"failure",
                    {{"a", rate(0)},
                     {"b", rate(1)},
                     {"difference", f.difference},
                     {"interval", JsonValue(IntervalCell(f.interval).value)},
                     {"mended", ChangedTable(found.mended).ToJson()},
                     {"broken", ChangedTable(found.broken).ToJson()},
                     {"p", f.p ? Json(*f.p) : Json()},
                     {"method", f.method}}},
                   {"metrics", MetricsTable(found.metrics).ToJson()},
                   {"verdict", Verdict(f)}});
}

Result<Told> TellComparison(const Asking& asking, const Call& call, std::span<const CaseAnswer> answers) {
  TRY(const Findings found, FindingsIn(asking, call, answers));
  const PairedComparison& f = found.failures;
  Told told{.json = ComparisonJson(call, found)};
  Table rates({"", "experiment", "controller", ">failed", "95 %"});
  for (std::size_t side = 0; side < 2; ++side) {
    const Experiment& experiment = *found.pairs.front().sides[side]->experiment;
    rates.AddRow({kSides[side], experiment.name, experiment.controller,
                  fmt::format("{:.1f} %", 100.0 * f.means[side]),
                  f.intervals[side] ? PercentCell(*f.intervals[side]) : Cell()});
  }
  const auto runs = found.pairs.front().sides[0]->runs.size();
  const std::string units = f.relatives ? fmt::format(" of {} evolutions", f.units) : "";
  told.section.lead = {fmt::format("{}{}, the same for both, {} with each controller and common seeds",
                                   Counted(f.cases, "case"), units, Counted(runs, "run"))};
  told.section.table = std::move(rates);
  told.section.sentences = {Verdict(f),
                            fmt::format("{} mended (failing with B, not with A){}.",
                                        Counted(found.mended.size(), "case"), NamedIn(found.mended)),
                            fmt::format("{} newly broken (failing with A, not with B){}.",
                                        Counted(found.broken.size(), "case"), NamedIn(found.broken))};
  if (found.left_out > 0)
    told.section.sentences.push_back(
        fmt::format("{} left out, without a result with one of them.", Counted(found.left_out, "case")));
  if (StartsProgram(*found.pairs.front().sides[0]->experiment))
    told.section.sentences.emplace_back(
        "The runs are a program's: they are paired by their cases; equal seeds are equal starts only if the "
        "program makes them so.");
  told.details =
      "\n" + MetricsTable(found.metrics).ToText() +
      "  Other metrics decide nothing; their p are adjusted for their number (Holm). effect: -1 to 1, signed "
      "ranks.\n";
  const std::string dir = PastedPath(call.directory);
  const bool broken = !found.broken.empty();
  if (broken || !found.mended.empty()) {
    const Pair& pair = broken ? *found.broken.front() : *found.mended.front();
    const RunId run = pair.sides[broken ? 0 : 1]->runs.front().id;
    told.section.commands.push_back(
        {fmt::format("{} replay {} {} --svg {}.svg", asking.program, dir, proto::RunText(run),
                     proto::RunFileName(run)),
         broken ? "see a case that A has newly broken" : "see a case that is mended, as it fails with B"});
  }
  told.section.commands.push_back(
      {fmt::format("{} compare-controllers {} --json", asking.program, dir), "all of it, for scripts"});
  return told;
}

constexpr const char* kComparisonHelp =
    R"(Simulates the same cases with both controllers, each pair of runs with a common seed, and tells which one fails
less: both rates, their difference with its interval, the cases that are mended and those that are newly broken.
'better' is decided by failures alone (p < .05); fitness and the metrics are told beside it, adjusted for their
number, and decide nothing.

The case is the unit: with one run each the test is McNemar's, exact; with --seeds-per-case K the differences of
the cases' failure shares are tested by exchanging their signs. Where cases come from evolutions these are the
units, as the members of one population are relatives: fewer than six of them give no p.

In place of the experiments may stand the directory of such a comparison, to tell it again.

Examples:
  gauntlet compare-controllers flocking-improved flocking
  gauntlet compare-controllers flocking-improved flocking --on random:500 --seed 7 --json
  gauntlet compare-controllers my.toml flocking --on corpus:corpus --seeds-per-case 10
  gauntlet compare-controllers flocking --set-b controller_parameters.turn_rate=1.2
  gauntlet compare-controllers flocking-improved flocking --on campaigns/e1,campaigns/e2,campaigns/e3)";

}  // namespace

Question ControllerQuestion() {
  using Kind = QuestionOption::Kind;
  return {.name = "compare-controllers",
          .summary = "which of two controllers fails less in the same test cases?",
          .help = kComparisonHelp,
          .place = Question::Place::kNewCampaign,
          .other = "the experiment of the other controller (B), an experiment like the first (A)",
          .options = {{"--on", "CASES",
                       "random:N (default: random:200), corpus:DIR or DIR[:SUBSET] of campaigns, as in "
                       "'gauntlet compare'"},
                      {"--seeds-per-case", "K", "runs of each case with each controller (default: 1)",
                       Kind::kValue, "search.replicates"}},
          .plan = PlanComparison,
          .tell = TellComparison};
}

}  // namespace gauntlet
