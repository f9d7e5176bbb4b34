#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <set>

#include <fmt/format.h>

#include "analysis/statistics/comparison.h"
#include "analysis/statistics/proportions.h"
#include "analysis/statistics/unseen_types.h"
#include "base/number_text.h"
#include "base/parse_number.h"
#include "study/study_report.h"

namespace gauntlet {
namespace {

// What an analysis is computed with.
struct Desk {
  const StudyAnalysis& analysis;
  StudyRuns& runs;
  StudyFigures& figures;
  StudySection& section;

  void Add(const std::string& figure, double number, std::string text) const {
    figures[analysis.name + "." + figure] = {number, std::move(text)};
  }
  void Add(const std::string& figure, std::string text) const {
    figures[analysis.name + "." + figure] = {std::nullopt, std::move(text)};
  }
  void Claim(bool holds) const {
    const std::string text = analysis.Key("claim");
    section.claim = StudyClaim{text.empty() ? analysis.Key("title") : text, holds};
  }
  std::string Metric() const {
    const std::string metric = analysis.Key("metric");
    return metric.empty() ? "fitness" : metric;
  }
  void AddNotes(const RunSet& set) const {
    section.sentences.insert(section.sentences.end(), set.notes.begin(), set.notes.end());
  }
};

std::vector<double> ValuesOf(const RunSet& set) {
  std::vector<double> values;
  for (const auto& cluster : set.values.clusters) values.insert(values.end(), cluster.begin(), cluster.end());
  return values;
}

// The parts whose cases a set consists of, and those that it was simulated in, which may be the same.
Result<std::pair<PartCost, PartCost>> CostsOf(const Desk& desk, const std::string& set) {
  PartCost made;
  PartCost again;
  std::set<std::string> sources;
  for (const StudySet& one : SplitStudySets(set)) {
    const std::string source = desk.runs.SourceOf(one.part);
    TRY(const auto cost, desk.runs.CostOf(source));
    if (sources.insert(source).second) {
      made.runs += cost.runs;
      made.cases += cost.cases;
      made.distinct_cases += cost.distinct_cases;
    }
    if (source == one.part) continue;
    TRY(const auto second, desk.runs.CostOf(one.part));
    again.runs += second.runs;
  }
  return std::pair(made, again);
}

// What the sets have cost: simulations, distinct cases, re-simulations.
Status AddBudget(const Desk& desk, const std::vector<std::pair<std::string, std::size_t>>& sets) {
  Table table(
      {"set", ">simulations", ">distinct cases", ">cases to choose from", ">re-simulations", ">compared"});
  const char* names[] = {"first", "second"};
  for (std::size_t i = 0; i < sets.size(); ++i) {
    const auto& [set, compared] = sets[i];
    TRY(const auto costs, CostsOf(desk, set));
    const auto& [made, again] = costs;
    table.AddRow({set, FormatCount(made.runs), FormatCount(made.distinct_cases), FormatCount(made.cases),
                  FormatCount(again.runs), FormatCount(compared)});
    desk.Add(fmt::format("{}.budget", names[i]),
             fmt::format("{} / {} / {}", made.cases, compared, made.runs));
  }
  desk.section.tables.push_back(std::move(table));
  return Ok{};
}

void AddSetFigures(const Desk& desk, const std::string& which, const RunSet& set,
                   const analysis::Description& description, double rank_sum, double other_u, Table& table) {
  const std::vector<double> values = ValuesOf(set);
  const auto n = static_cast<double>(values.size());
  const double zeros = 100.0 * static_cast<double>(std::ranges::count(values, 0.0)) / n;
  const double sd = description.sd.value_or(0.0);
  desk.Add(which + ".n", n, fmt::format("{}", values.size()));
  desk.Add(which + ".mean", description.mean, FormatFitness(description.mean));
  desk.Add(which + ".sd", sd, FormatFitness(sd));
  desk.Add(which + ".rank_sum", rank_sum, fmt::format("{:.1f}", rank_sum));
  desk.Add(which + ".mean_rank", rank_sum / n, fmt::format("{:.2f}", rank_sum / n));
  desk.Add(which + ".u", other_u, fmt::format("{:.1f}", other_u));
  desk.Add(which + ".zeros", zeros, fmt::format("{:.1f}", zeros));
  table.AddRow({set.values.name, fmt::format("{}", values.size()),
                fmt::format("{} ({})", set.values.clusters.size(), set.unit), FormatFitness(description.mean),
                FormatFitness(sd), FormatFitness(description.median), fmt::format("{:.1f}", zeros),
                fmt::format("{:.1f}", rank_sum), fmt::format("{:.2f}", rank_sum / n),
                fmt::format("{:.1f}", other_u)});
}

Status Compare(const Desk& desk) {
  TRY(const auto first, desk.runs.Set(desk.analysis.Key("first"), desk.Metric()));
  TRY(const auto second, desk.runs.Set(desk.analysis.Key("second"), desk.Metric()));
  TRY(const auto c, analysis::Compare(first.values, second.values));
  desk.section.compared = ComparedSets{desk.Metric(), {first.values, second.values}};
  Table sets({"set", ">n", ">units", ">mean", ">sd", ">median", ">zero %", ">rank sum", ">mean rank", ">U"});
  // The thesis prints n1 n2 + n1 (n1 + 1) / 2 - R1 as the U of the first set, which is our U of the second.
  AddSetFigures(desk, "first", first, c.first, c.test.rank_sum1, c.test.u2, sets);
  AddSetFigures(desk, "second", second, c.second, c.test.rank_sum2, c.test.u1, sets);
  desk.section.tables.push_back(std::move(sets));

  const std::string expect = desk.analysis.Key("expect");
  const bool less = expect != "greater";
  const double p = less ? c.test.p_less : c.test.p_greater;
  const bool apart = c.first_box.upper_quartile < c.second_box.lower_quartile ||
                     c.second_box.upper_quartile < c.first_box.lower_quartile;
  desk.Add("a", c.test.a, fmt::format("{:.4f}", c.test.a));
  desk.Add("a_reverse", 1.0 - c.test.a, fmt::format("{:.4f}", 1.0 - c.test.a));
  desk.Add("p", p, fmt::format("{:.2g}", p));
  desk.Add("boxes", apart ? "no overlap" : "overlap");
  desk.section.sentences.push_back(fmt::format(
      "A (first exceeds second) {:.3f}, effect: {}; 95 % intervals: {} of single runs, {} of whole units. "
      "One-tailed p (first {}) {:.2g}. Boxes: {}.",
      c.test.a, c.effect, IntervalCell(c.interval).text, IntervalCell(c.cluster_interval).text,
      less ? "less" : "greater", p, apart ? "no overlap" : "they overlap"));
  if (less && c.first.minimum == 0.0) {
    const double zeros = desk.figures.at(desk.analysis.name + ".second.zeros").number.value_or(0.0) / 100.0;
    desk.section.sentences.push_back(
        fmt::format("A share z = {:.3f} of the second set is zero too, so A cannot be below z / 2 = {:.3f}.",
                    zeros, zeros / 2.0));
  }
  desk.AddNotes(first);
  desk.AddNotes(second);
  if (!expect.empty()) {
    bool holds = p < kThesisLevel;
    if (const auto effect = ParseNumber<double>(desk.analysis.Key("effect"))) {
      const auto& interval = c.cluster_interval ? c.cluster_interval : c.interval;
      holds = holds && interval && (less ? 1.0 - interval->high : interval->low) > *effect;
    }
    desk.Claim(holds);
  }
  return AddBudget(desk,
                   {{desk.analysis.Key("first"), c.first.n}, {desk.analysis.Key("second"), c.second.n}});
}

struct Bounds {
  double at_least = -std::numeric_limits<double>::infinity();
  double at_most = std::numeric_limits<double>::infinity();
  double above = -std::numeric_limits<double>::infinity();
  double below = std::numeric_limits<double>::infinity();
  bool Holds(double value) const {
    return value >= at_least && value <= at_most && (value > above || std::isinf(above)) &&
           (value < below || std::isinf(below));
  }
};

Result<Bounds> BoundsOf(const StudyAnalysis& analysis) {
  Bounds bounds;
  for (const auto& [key, bound] :
       {std::pair("at_least", &bounds.at_least), std::pair("at_most", &bounds.at_most),
        std::pair("above", &bounds.above), std::pair("below", &bounds.below)}) {
    const std::string text = analysis.Key(key);
    if (text.empty()) continue;
    const auto number = ParseNumber<double>(text);
    if (!number) return InvalidInput(fmt::format("{} is '{}', expected a number", key, text));
    *bound = *number;
  }
  return bounds;
}

// How many runs of one set, or of two, have a value within bounds.
Status Count(const Desk& desk) {
  TRY(const auto bounds, BoundsOf(desk.analysis));
  Table table({"set", ">runs", ">" + desk.analysis.Key("what"), ">%", ">95 % interval (Wilson)"});
  std::vector<std::pair<std::uint32_t, std::uint32_t>> shares;
  std::vector<std::pair<std::string, std::size_t>> sets;
  for (const char* which : {"first", "second"}) {
    const std::string name = desk.analysis.Key(which);
    if (name.empty()) continue;
    TRY(const auto set, desk.runs.Set(name, desk.Metric()));
    const std::vector<double> values = ValuesOf(set);
    if (values.empty()) return InvalidInput(name + ": no run has a value of " + desk.Metric());
    const auto hits = static_cast<std::uint32_t>(
        std::ranges::count_if(values, [&](double value) { return bounds.Holds(value); }));
    const auto of = static_cast<std::uint32_t>(values.size());
    const double percent = 100.0 * hits / of;
    const analysis::Interval interval = analysis::WilsonInterval(hits, of, analysis::kConfidence);
    desk.Add(fmt::format("{}.count", which), hits, fmt::format("{}", hits));
    desk.Add(fmt::format("{}.of", which), of, fmt::format("{}", of));
    desk.Add(fmt::format("{}.percent", which), percent, fmt::format("{:.1f}", percent));
    desk.Add(fmt::format("{}.none", which), hits == 0 ? "none" : fmt::format("{} of {}", hits, of));
    table.AddRow({name, fmt::format("{}", of), fmt::format("{}", hits), fmt::format("{:.1f}", percent),
                  fmt::format("{:.1f} to {:.1f}", 100.0 * interval.low, 100.0 * interval.high)});
    shares.emplace_back(hits, of);
    sets.emplace_back(name, of);
  }
  desk.section.tables.push_back(std::move(table));
  if (shares.size() < 2) return Ok{};
  const analysis::FisherTest test =
      analysis::FisherExact(shares[0].first, shares[0].second, shares[1].first, shares[1].second);
  const bool less = desk.analysis.Key("expect") == "less";
  const double p = less ? test.p_less : test.p_greater;
  desk.Add("p", p, fmt::format("{:.2g}", p));
  desk.section.sentences.push_back(
      fmt::format("Fisher's exact test, one-tailed (first {}): p {:.2g}.", less ? "less" : "greater", p));
  if (!desk.analysis.Key("expect").empty()) desk.Claim(p < kThesisLevel);
  return Ok{};
}

// Which types of failure two sets have.
Status Types(const Desk& desk) {
  std::array<std::vector<std::uint64_t>, 2> counts;
  Table table({"set", ">runs", ">total failures", ">of a type", ">types", ">types expected in all (Chao1)",
               ">chance that the next is new"});
  const std::vector<std::string> names = desk.runs.FailureTypes(desk.analysis.Key("first"));
  std::vector<std::pair<std::string, std::size_t>> sets;
  for (std::size_t i = 0; i < 2; ++i) {
    const std::string which = i == 0 ? "first" : "second";
    const std::string set_name = desk.analysis.Key(which);
    TRY(const auto failures, desk.runs.Set(set_name, "total_failure"));
    TRY(const auto types, desk.runs.Set(set_name, "failure_type"));
    counts[i].assign(names.size(), 0);
    for (const double type : ValuesOf(types)) {
      if (type < static_cast<double>(names.size())) ++counts[i][static_cast<std::size_t>(type)];
    }
    const std::vector<double> flags = ValuesOf(failures);
    const auto failed = std::ranges::count(flags, 1.0);
    const analysis::UnseenTypes unseen = analysis::EstimateUnseenTypes(counts[i]);
    for (std::size_t type = 0; type < names.size(); ++type) {
      desk.Add(fmt::format("{}.type_{}", which, type), static_cast<double>(counts[i][type]),
               fmt::format("{}", counts[i][type]));
    }
    desk.Add(which + ".of", static_cast<double>(flags.size()), fmt::format("{}", flags.size()));
    desk.Add(which + ".types", static_cast<double>(unseen.seen), fmt::format("{}", unseen.seen));
    desk.Add(which + ".failures", static_cast<double>(unseen.failures), fmt::format("{}", unseen.failures));
    table.AddRow({set_name, FormatCount(flags.size()), FormatCount(static_cast<std::uint64_t>(failed)),
                  FormatCount(unseen.failures), fmt::format("{} of {}", unseen.seen, names.size()),
                  fmt::format("{:.1f}", unseen.chao1), fmt::format("{:.4f}", unseen.chance_of_new)});
    sets.emplace_back(set_name, flags.size());
  }
  desk.section.tables.push_back(std::move(table));
  bool inside = true;
  Table by_type({">type", "what it is", ">first", ">second"});
  for (std::size_t type = 0; type < names.size(); ++type) {
    inside = inside && (counts[1][type] == 0 || counts[0][type] > 0);
    by_type.AddRow(
        {fmt::format("{}", type), names[type], FormatCount(counts[0][type]), FormatCount(counts[1][type])});
  }
  desk.section.tables.push_back(std::move(by_type));
  desk.Add("second_in_first", inside ? "subset" : "no subset");
  const std::uint64_t fewest = std::min(analysis::EstimateUnseenTypes(counts[0]).failures,
                                        analysis::EstimateUnseenTypes(counts[1]).failures);
  const double first = analysis::RarefiedTypes(counts[0], fewest);
  const double second = analysis::RarefiedTypes(counts[1], fewest);
  desk.section.sentences.push_back(fmt::format(
      "The second set's types are {} of the first's. In {} failures drawn from either set, {:.1f} and "
      "{:.1f} types are expected (rarefaction): like for like, that is the comparison.",
      inside ? "a subset" : "no subset", FormatCount(fewest), first, second));
  if (desk.analysis.Key("expect") == "greater") desk.Claim(first > second);
  if (desk.analysis.Key("expect") == "subset") desk.Claim(inside);
  return AddBudget(desk, sets);
}

// In which generation the searches' populations have the most types of failure, on average.
Status Peak(const Desk& desk) {
  TRY(const auto searches, desk.runs.TypesByGeneration(desk.analysis.Key("part")));
  std::size_t generations = std::numeric_limits<std::size_t>::max();
  for (const auto& search : searches) generations = std::min(generations, search.size());
  Table table({">generation", ">types in it, mean", ">types so far, mean"});
  std::size_t best = 0;
  double most = -1.0;
  for (std::size_t generation = 0; generation < generations; ++generation) {
    double in_it = 0.0;
    double so_far = 0.0;
    for (const auto& search : searches) {
      const std::set<int> types(search[generation].begin(), search[generation].end());
      std::set<int> all;
      for (std::size_t i = 0; i <= generation; ++i) all.insert(search[i].begin(), search[i].end());
      in_it += static_cast<double>(types.size()) / static_cast<double>(searches.size());
      so_far += static_cast<double>(all.size()) / static_cast<double>(searches.size());
    }
    if (in_it > most) {
      most = in_it;
      best = generation + 1;
    }
    if (generation == 0 || (generation + 1) % 10 == 0) {
      table.AddRow(
          {fmt::format("{}", generation + 1), fmt::format("{:.2f}", in_it), fmt::format("{:.2f}", so_far)});
    }
  }
  desk.Add("generation", static_cast<double>(best), fmt::format("{}", best));
  desk.Add("types", most, fmt::format("{:.2f}", most));
  desk.section.tables.push_back(std::move(table));
  desk.section.sentences.push_back(fmt::format(
      "The mean of {} searches is largest in generation {}: {:.2f} types.", searches.size(), best, most));
  return Ok{};
}

// Counts per window of time: when they become steady, and how large they then are.
Status Windows(const Desk& desk) {
  const auto seconds = ParseNumber<double>(desk.analysis.Key("seconds"));
  if (!seconds || *seconds <= 0.0) return InvalidInput("seconds have to be a number above 0");
  TRY(const auto runs, desk.runs.Windows(desk.analysis.Key("first"), desk.analysis.Key("prefix")));
  const std::size_t windows = runs.front().size();
  std::vector<double> means(windows, 0.0);
  Table table({">minutes", ">25 %", ">50 %", ">75 %", ">95 %", ">mean"});
  double highest_quarter = 0.0;
  double highest_three_quarters = 0.0;
  for (std::size_t window = 0; window < windows; ++window) {
    std::vector<double> values;
    for (const auto& run : runs) {
      if (window < run.size()) values.push_back(run[window]);
    }
    for (const double value : values) means[window] += value / static_cast<double>(values.size());
    const double quarter = analysis::Quantile(values, 0.25);
    const double three_quarters = analysis::Quantile(values, 0.75);
    highest_quarter = std::max(highest_quarter, quarter);
    highest_three_quarters = std::max(highest_three_quarters, three_quarters);
    const double minutes = static_cast<double>(window + 1) * *seconds / 60.0;
    if (std::fmod(minutes, 10.0) == 0.0) {
      table.AddRow(
          {NumberText(minutes), fmt::format("{:.4g}", quarter),
           fmt::format("{:.4g}", analysis::Quantile(values, 0.5)), fmt::format("{:.4g}", three_quarters),
           fmt::format("{:.4g}", analysis::Quantile(values, 0.95)), fmt::format("{:.2f}", means[window])});
    }
  }
  // Steady: three windows in a row whose mean is at least 90 % of that of the last third.
  const std::size_t late = windows - windows / 3;
  double plateau = 0.0;
  std::vector<double> late_values;
  for (const auto& run : runs)
    late_values.insert(late_values.end(),
                       run.begin() + static_cast<std::ptrdiff_t>(std::min(late, run.size())), run.end());
  for (const double value : late_values) plateau += value / static_cast<double>(late_values.size());
  std::optional<double> steady;
  for (std::size_t window = 0; window + 3 <= windows && !steady && plateau > 0.0; ++window) {
    const auto begin = means.begin() + static_cast<std::ptrdiff_t>(window);
    if (std::all_of(begin, begin + 3, [&](double mean) { return mean >= 0.9 * plateau; }))
      steady = static_cast<double>(window) * *seconds / 60.0;
  }
  const double median = analysis::Quantile(late_values, 0.5);
  const auto nothing = std::ranges::count_if(runs, [](const auto& run) {
    return std::ranges::all_of(run, [](double value) { return value == 0.0; });
  });
  const auto moves = [](double highest) {
    return highest == 0.0 ? std::string("0 throughout") : fmt::format("up to {}", NumberText(highest));
  };
  if (steady) {
    desk.Add("steady_minutes", *steady, NumberText(*steady));
  } else {
    desk.Add("steady_minutes", "never");
  }
  desk.Add("median", median, NumberText(median));
  desk.Add("plateau", plateau, fmt::format("{:.2f}", plateau));
  desk.Add("lower_quartile", moves(highest_quarter));
  desk.Add("quartiles", moves(highest_three_quarters));
  desk.section.tables.push_back(std::move(table));
  desk.section.sentences.push_back(
      fmt::format("{} runs. Mean of the last third {:.2f} per {} s; steady (three windows of at least 90 % "
                  "of it) {}; nothing "
                  "at all in {} runs.",
                  runs.size(), plateau, NumberText(*seconds),
                  steady ? fmt::format("from {} min", NumberText(*steady)) : "never", nothing));
  return Ok{};
}

struct AnalysisKind {
  std::string_view name;
  Status (*compute)(const Desk&);
};
constexpr AnalysisKind kKinds[] = {
    {"compare", Compare}, {"count", Count}, {"types", Types}, {"peak", Peak}, {"windows", Windows}};

}  // namespace

Result<StudySection> Analyse(const StudyAnalysis& analysis, StudyRuns& runs, StudyFigures& figures) {
  if (analysis.tuning) return AnalyseTuning(analysis, runs, figures);
  StudySection section;
  section.name = analysis.name;
  section.title = analysis.Key("title");
  for (const AnalysisKind& kind : kKinds) {
    if (kind.name != analysis.kind) continue;
    TRY(kind.compute({analysis, runs, figures, section}));
  }
  return section;
}

}  // namespace gauntlet
