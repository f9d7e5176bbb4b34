#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
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

  void Add(const std::string& figure, Cell cell) const {
    figures[analysis.name + "." + figure] = std::move(cell);
  }
  // Of the set `which` a row, whose cells are figures too where they have a name.
  void AddRow(const std::string& which, const std::string& set,
              const std::vector<std::pair<std::string, Cell>>& cells, Table& table) const {
    std::vector<Cell> row = {set};
    for (const auto& [figure, cell] : cells) {
      if (!figure.empty()) Add(fmt::format("{}.{}", which, figure), cell);
      row.push_back(cell);
    }
    table.AddRow(std::move(row));
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

double PercentOfZeros(const std::vector<double>& values) {
  return 100.0 * static_cast<double>(std::ranges::count(values, 0.0)) / static_cast<double>(values.size());
}

constexpr std::array kTwoSets = {"first", "second"};

// What the sets have cost, of which so many runs were compared: simulations of the parts that their cases
// come from, and of those that they were simulated in again.
Status AddBudget(const Desk& desk, const std::array<std::size_t, 2>& compared) {
  Table table(
      {"set", ">simulations", ">distinct cases", ">cases to choose from", ">re-simulations", ">compared"});
  for (std::size_t i = 0; i < kTwoSets.size(); ++i) {
    const std::string set = desk.analysis.Key(kTwoSets[i]);
    PartCost made;
    PartCost again;
    std::set<std::string> sources;
    for (const StudySet& one : SplitStudySets(set)) {
      const std::string source = desk.runs.SourceOf(one.part);
      TRY(const auto cost, desk.runs.CostOf(source));
      if (sources.insert(source).second) made += cost;
      if (source == one.part) continue;
      TRY(const auto second, desk.runs.CostOf(one.part));
      again += second;
    }
    table.AddRow({set, CountCell(made.runs), CountCell(made.distinct_cases), CountCell(made.cases),
                  CountCell(again.runs), CountCell(compared[i])});
    desk.Add(fmt::format("{}.budget", kTwoSets[i]),
             fmt::format("{} / {} / {}", made.cases, compared[i], made.runs));
  }
  desk.section.tables.push_back(std::move(table));
  return Ok{};
}

void AddSet(const Desk& desk, const std::string& which, const RunSet& set,
            const analysis::Description& description, double rank_sum, double other_u, Table& table) {
  const std::vector<double> values = ValuesOf(set);
  const auto n = static_cast<double>(values.size());
  desk.AddRow(which, set.values.name,
              {{"n", WholeCell(values.size())},
               {"", fmt::format("{} ({})", set.values.clusters.size(), set.unit)},
               {"mean", FitnessCell(description.mean)},
               {"sd", FitnessCell(description.sd.value_or(0.0))},
               {"", FitnessCell(description.median)},
               {"zeros", DecimalCell(PercentOfZeros(values), 1)},
               {"rank_sum", DecimalCell(rank_sum, 1)},
               {"mean_rank", DecimalCell(rank_sum / n, 2)},
               {"u", DecimalCell(other_u, 1)}},
              table);
}

Status Compare(const Desk& desk) {
  TRY(const auto first, desk.runs.Set(desk.analysis.Key("first"), desk.Metric()));
  TRY(const auto second, desk.runs.Set(desk.analysis.Key("second"), desk.Metric()));
  TRY(const auto c, analysis::Compare(first.values, second.values));
  desk.section.compared = ComparedSets{desk.Metric(), {first.values, second.values}};
  Table sets({"set", ">n", ">units", ">mean", ">sd", ">median", ">zero %", ">rank sum", ">mean rank", ">U"});
  // The thesis prints n1 n2 + n1 (n1 + 1) / 2 - R1 as the U of the first set, which is our U of the second.
  AddSet(desk, "first", first, c.first, c.test.rank_sum1, c.test.u2, sets);
  AddSet(desk, "second", second, c.second, c.test.rank_sum2, c.test.u1, sets);
  desk.section.tables.push_back(std::move(sets));

  const std::string expect = desk.analysis.Key("expect");
  const bool less = expect != "greater";
  const double p = less ? c.test.p_less : c.test.p_greater;
  const bool apart = c.first_box.upper_quartile < c.second_box.lower_quartile ||
                     c.second_box.upper_quartile < c.first_box.lower_quartile;
  desk.Add("a", DecimalCell(c.test.a, 4));
  desk.Add("a_reverse", DecimalCell(1.0 - c.test.a, 4));
  desk.Add("p", DigitsCell(p, 2));
  desk.Add("boxes", apart ? "no overlap" : "overlap");
  desk.section.sentences.push_back(fmt::format(
      "A (first exceeds second) {:.3f}, effect: {}; 95 % intervals: {} of single runs, {} of whole units. "
      "One-tailed p (first {}) {:.2g}. Boxes: {}.",
      c.test.a, c.effect, IntervalCell(c.interval).text, IntervalCell(c.cluster_interval).text,
      less ? "less" : "greater", p, apart ? "no overlap" : "they overlap"));
  if (less && c.first.minimum == 0.0) {
    const double zeros = PercentOfZeros(ValuesOf(second)) / 100.0;
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
  return AddBudget(desk, {c.first.n, c.second.n});
}

// Whether a value is within what the analysis asks for.
std::function<bool(double)> BoundsOf(const StudyAnalysis& analysis) {
  const auto bound = [&](const std::string& key, double otherwise) {
    return ParseNumber<double>(analysis.Key(key)).value_or(otherwise);
  };
  constexpr double kEndless = std::numeric_limits<double>::infinity();
  return [at_least = bound("at_least", -kEndless), at_most = bound("at_most", kEndless),
          above = bound("above", -kEndless), below = bound("below", kEndless)](double value) {
    return value >= at_least && value <= at_most && value > above && value < below;
  };
}

// How many runs of one set, or of two, have a value within bounds.
Status Count(const Desk& desk) {
  const auto in_bounds = BoundsOf(desk.analysis);
  Table table({"set", ">runs", ">" + desk.analysis.Key("what"), ">%", ">95 % interval (Wilson)"});
  std::vector<std::pair<std::uint32_t, std::uint32_t>> shares;
  for (const char* which : kTwoSets) {
    const std::string name = desk.analysis.Key(which);
    if (name.empty()) continue;
    TRY(const auto set, desk.runs.Set(name, desk.Metric()));
    const std::vector<double> values = ValuesOf(set);
    if (values.empty()) return InvalidInput(name + ": no run has a value of " + desk.Metric());
    const auto hits = static_cast<std::uint32_t>(std::ranges::count_if(values, in_bounds));
    const auto of = static_cast<std::uint32_t>(values.size());
    const double percent = 100.0 * hits / of;
    const analysis::Interval interval = analysis::WilsonInterval(hits, of, analysis::kConfidence);
    desk.AddRow(which, name,
                {{"of", WholeCell(of)},
                 {"count", WholeCell(hits)},
                 {"percent", DecimalCell(percent, 1)},
                 {"", fmt::format("{:.1f} to {:.1f}", 100.0 * interval.low, 100.0 * interval.high)}},
                table);
    desk.Add(fmt::format("{}.none", which), hits == 0 ? "none" : fmt::format("{} of {}", hits, of));
    shares.emplace_back(hits, of);
  }
  desk.section.tables.push_back(std::move(table));
  if (shares.size() < 2) return Ok{};
  const analysis::FisherTest test =
      analysis::FisherExact(shares[0].first, shares[0].second, shares[1].first, shares[1].second);
  const bool less = desk.analysis.Key("expect") == "less";
  const double p = less ? test.p_less : test.p_greater;
  desk.Add("p", DigitsCell(p, 2));
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
  std::array<std::size_t, 2> compared{};
  std::uint64_t fewest = std::numeric_limits<std::uint64_t>::max();  // failures of a set
  for (std::size_t i = 0; i < kTwoSets.size(); ++i) {
    const std::string which = kTwoSets[i];
    const std::string set_name = desk.analysis.Key(which);
    TRY(const auto failures, desk.runs.Set(set_name, controllers::kTotalFailure));
    TRY(const auto types, desk.runs.Set(set_name, "failure_type"));
    counts[i].assign(names.size(), 0);
    for (const double type : ValuesOf(types)) {
      if (type < static_cast<double>(names.size())) ++counts[i][static_cast<std::size_t>(type)];
    }
    const std::vector<double> flags = ValuesOf(failures);
    const auto failed = std::ranges::count(flags, 1.0);
    const analysis::UnseenTypes unseen = analysis::EstimateUnseenTypes(counts[i]);
    for (std::size_t type = 0; type < names.size(); ++type)
      desk.Add(fmt::format("{}.type_{}", which, type), WholeCell(counts[i][type]));
    desk.Add(which + ".of", WholeCell(flags.size()));
    desk.Add(which + ".types", WholeCell(unseen.seen));
    desk.Add(which + ".failures", WholeCell(unseen.failures));
    table.AddRow({set_name, CountCell(flags.size()), CountCell(failed), CountCell(unseen.failures),
                  fmt::format("{} of {}", unseen.seen, names.size()), DecimalCell(unseen.chao1, 1),
                  DecimalCell(unseen.chance_of_new, 4)});
    compared[i] = flags.size();
    fewest = std::min<std::uint64_t>(fewest, unseen.failures);
  }
  desk.section.tables.push_back(std::move(table));
  bool inside = true;
  Table by_type({">type", "what it is", ">first", ">second"});
  for (std::size_t type = 0; type < names.size(); ++type) {
    inside = inside && (counts[1][type] == 0 || counts[0][type] > 0);
    by_type.AddRow({type, names[type], CountCell(counts[0][type]), CountCell(counts[1][type])});
  }
  desk.section.tables.push_back(std::move(by_type));
  desk.Add("second_in_first", inside ? "subset" : "no subset");
  const double first = analysis::RarefiedTypes(counts[0], fewest);
  const double second = analysis::RarefiedTypes(counts[1], fewest);
  desk.section.sentences.push_back(fmt::format(
      "The second set's types are {} of the first's. In {} failures drawn from either set, {:.1f} and "
      "{:.1f} types are expected (rarefaction): like for like, that is the comparison.",
      inside ? "a subset" : "no subset", FormatCount(fewest), first, second));
  if (desk.analysis.Key("expect") == "greater") desk.Claim(first > second);
  if (desk.analysis.Key("expect") == "subset") desk.Claim(inside);
  return AddBudget(desk, compared);
}

// In which generation the searches' populations have the most types of failure, on average.
Status Peak(const Desk& desk) {
  TRY(const auto searches, desk.runs.All(desk.analysis.Key("part"), "failure_type"));
  std::size_t generations = std::numeric_limits<std::size_t>::max();
  for (const auto& runs : searches) {
    const auto last = std::ranges::max_element(runs, {}, &SelectedRun::generation);
    generations = std::min<std::size_t>(generations, last == runs.end() ? 0 : last->generation);
  }
  Table table({">generation", ">types in it, mean", ">types so far, mean"});
  std::size_t best = 0;
  double most = -1.0;
  std::vector<std::set<double>> all(searches.size());
  for (std::size_t generation = 1; generation <= generations; ++generation) {
    double in_it = 0.0;
    double so_far = 0.0;
    for (std::size_t search = 0; search < searches.size(); ++search) {
      std::set<double> types;
      for (const SelectedRun& run : searches[search]) {
        if (run.generation == generation && run.value) types.insert(*run.value);
      }
      all[search].insert(types.begin(), types.end());
      in_it += static_cast<double>(types.size()) / static_cast<double>(searches.size());
      so_far += static_cast<double>(all[search].size()) / static_cast<double>(searches.size());
    }
    if (in_it > most) {
      most = in_it;
      best = generation;
    }
    if (generation == 1 || generation % 10 == 0)
      table.AddRow({generation, DecimalCell(in_it, 2), DecimalCell(so_far, 2)});
  }
  desk.Add("generation", WholeCell(best));
  desk.Add("types", DecimalCell(most, 2));
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
      table.AddRow({minutes, DigitsCell(quarter, 4), DigitsCell(analysis::Quantile(values, 0.5), 4),
                    DigitsCell(three_quarters, 4), DigitsCell(analysis::Quantile(values, 0.95), 4),
                    DecimalCell(means[window], 2)});
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
  desk.Add("steady_minutes", steady ? Cell(*steady) : "never");
  desk.Add("median", median);
  desk.Add("plateau", DecimalCell(plateau, 2));
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
