#include "cli/output/budget_comparison.h"

#include <fmt/format.h>

#include <array>
#include <limits>
#include <nlohmann/json.hpp>
#include <optional>
#include <string_view>

#include "analysis/statistics/comparison.h"
#include "analysis/statistics/multiple_tests.h"
#include "analysis/statistics/rank_test.h"
#include "analysis/statistics/sample.h"
#include "base/printable.h"
#include "cli/output/table.h"

namespace gauntlet {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::size_t kAnySize = std::numeric_limits<std::size_t>::max();

constexpr std::string_view kReading =
    "cells: of the grid over how the swarm fails, those with a case that failed in at least half of its runs "
    "with fresh seeds; up to 3, up to 2, one: with a case of so few obstacles; runs to 5, to 10: until cases "
    "of up to 3 obstacles had been found in so many cells. cases: of a search that keeps elites these, of "
    "others all that failed. Elites are late: a smaller one takes the place of a larger one found before.";
constexpr std::size_t kSmall = 3;  // obstacles

double NumberOf(std::size_t count) {
  return static_cast<double>(count);
}

// Nothing: never.
template <std::size_t kCells>
std::optional<double> RunsUntilCells(const SearchYield& yield) {
  const std::optional<std::uint64_t> runs = RunsUntil(yield, kCells, kSmall);
  return runs ? std::optional(static_cast<double>(*runs)) : std::nullopt;
}
template <std::size_t kMost>
std::optional<double> CellsUpTo(const SearchYield& yield) {
  return NumberOf(CellsWith(yield, kMost));
}

// What is compared.
struct Measure {
  std::string_view key;    // in JSON
  std::string_view title;  // over a column
  std::optional<double> (*of)(const SearchYield& yield);
};
constexpr std::array kMeasures = std::to_array<Measure>({
    {"cells", "cells", CellsUpTo<kAnySize>},
    {"cells_with_up_to_3", "up to 3", CellsUpTo<3>},
    {"cells_with_up_to_2", "up to 2", CellsUpTo<2>},
    {"cells_with_1", "one", CellsUpTo<1>},
    {"runs_until_5_cells_with_up_to_3", "runs to 5", RunsUntilCells<5>},
    {"runs_until_10_cells_with_up_to_3", "runs to 10", RunsUntilCells<10>},
});

// One value for each search; what was never reached counts as one run more than there were.
struct Values {
  std::vector<double> all;
  double never = 0.0;   // what stands for it
  bool reached = true;  // by all searches
};
Values ValuesOf(const YieldSet& set, const Measure& measure) {
  Values values{.all = {}, .never = static_cast<double>(set.searches.front().runs + 1)};
  for (const SearchYield& one : set.searches) {
    const std::optional<double> value = measure.of(one);
    values.reached = values.reached && value.has_value();
    values.all.push_back(value.value_or(values.never));
  }
  return values;
}

// Of the first set against each other one, adjusted for their number.
std::vector<double> PValues(const std::vector<YieldSet>& sets, const Measure& measure) {
  const Values first = ValuesOf(sets.front(), measure);
  std::vector<double> p;
  for (std::size_t i = 1; i < sets.size(); ++i) {
    const Values other = ValuesOf(sets[i], measure);
    const auto exact = analysis::ExactMannWhitney(first.all, other.all);
    p.push_back(exact ? exact->p_two_sided : analysis::MannWhitney(first.all, other.all).p_two_sided);
  }
  return analysis::HolmAdjusted(p);
}

std::string YieldNumber(double value) {
  return fmt::format("{:.4g}", value);
}

std::string MedianText(const YieldSet& set, const Measure& measure) {
  const Values values = ValuesOf(set, measure);
  const double median = analysis::Describe(values.all).median;
  return median < values.never ? YieldNumber(median) : "never";
}

std::string MeanText(const YieldSet& set, const Measure& measure) {
  const Values values = ValuesOf(set, measure);
  if (!values.reached) return "-";
  const double mean = analysis::Describe(values.all).mean;
  const int decimals = mean < 100.0 ? 1 : 0;
  if (values.all.size() < 2) return fmt::format("{:.{}f}", mean, decimals);
  const analysis::Interval interval = analysis::MeanInterval(values.all, analysis::kConfidence);
  return fmt::format("{:.{}f} ({:.{}f} to {:.{}f})", mean, decimals, interval.low, decimals, interval.high,
                     decimals);
}

struct Counts {
  std::size_t cases = 0;
  std::size_t confirmed = 0;
};
Counts CountsOf(const YieldSet& set) {
  Counts counts;
  for (const SearchYield& one : set.searches) {
    counts.cases += one.cases;
    counts.confirmed += one.confirmed.size();
  }
  return counts;
}

std::string ConfirmedText(const Counts& counts) {
  if (counts.cases == 0) return "-";
  return fmt::format("{:.1f} %", 100.0 * NumberOf(counts.confirmed) / NumberOf(counts.cases));
}

std::vector<std::string> Head(std::vector<std::string> head) {
  for (const Measure& measure : kMeasures) head.push_back(fmt::format(">{}", measure.title));
  return head;
}

std::string Medians(const std::vector<YieldSet>& sets) {
  Table table(Head({"set", "searches", ">cases", ">confirmed"}));
  for (const YieldSet& set : sets) {
    const Counts counts = CountsOf(set);
    std::vector<std::string> row = {Printable(set.name),
                                    fmt::format("{} x {}", set.searches.size(), set.title),
                                    fmt::format("{}", counts.cases), ConfirmedText(counts)};
    for (const Measure& measure : kMeasures) row.push_back(MedianText(set, measure));
    table.AddRow(row);
  }
  return table.ToText();
}

std::string Means(const std::vector<YieldSet>& sets) {
  Table table(Head({"set"}));
  for (const YieldSet& set : sets) {
    std::vector<std::string> row = {Printable(set.name)};
    for (const Measure& measure : kMeasures) row.push_back(MeanText(set, measure));
    table.AddRow(row);
  }
  return table.ToText();
}

std::string Tests(const std::vector<YieldSet>& sets) {
  Table table(Head({"set"}));
  std::vector<std::vector<std::string>> rows;
  for (std::size_t i = 1; i < sets.size(); ++i) rows.push_back({Printable(sets[i].name)});
  for (const Measure& measure : kMeasures) {
    const std::vector<double> p = PValues(sets, measure);
    for (std::size_t i = 0; i < rows.size(); ++i) rows[i].push_back(fmt::format("{:.2g}", p[i]));
  }
  for (const std::vector<std::string>& row : rows) table.AddRow(row);
  return table.ToText();
}

Json IntervalJson(const Values& values) {
  if (!values.reached || values.all.size() < 2) return {};
  const analysis::Interval interval = analysis::MeanInterval(values.all, analysis::kConfidence);
  return {interval.low, interval.high};
}

Json MeasureJson(const YieldSet& set, const Measure& measure) {
  const Values values = ValuesOf(set, measure);
  const analysis::Description description = analysis::Describe(values.all);
  Json all = Json::array();
  for (const double value : values.all) all.push_back(value < values.never ? Json(value) : Json());
  return {{"median", description.median < values.never ? Json(description.median) : Json()},
          {"mean", values.reached ? Json(description.mean) : Json()},
          {"mean_interval", IntervalJson(values)},
          {"values", std::move(all)}};
}

}  // namespace

std::string BudgetText(const std::vector<YieldSet>& sets) {
  const std::string runs = FormatCount(sets.front().searches.front().runs);
  std::string text =
      fmt::format("What {} runs of a search give, medians over the searches\n{}", runs, Medians(sets));
  text += fmt::format("\nMeans, with their 95 % intervals (Student's t)\n{}", Means(sets));
  if (sets.size() > 1) {
    text += fmt::format("\np of {} against each of the others (Mann-Whitney, two-sided, after Holm)\n{}",
                        Printable(sets.front().name), Tests(sets));
  }
  return text + "\n  " + Wrapped(kReading, 110, 2) + "\n";
}

Json BudgetJson(const std::vector<YieldSet>& sets) {
  Json all = Json::array();
  for (const YieldSet& set : sets) {
    const Counts counts = CountsOf(set);
    Json one = {{"set", set.name},
                {"search", set.title},
                {"searches", set.searches.size()},
                {"cases", counts.cases},
                {"confirmed", counts.confirmed}};
    for (const Measure& measure : kMeasures) one[measure.key] = MeasureJson(set, measure);
    all.push_back(std::move(one));
  }
  if (sets.size() > 1) {
    for (const Measure& measure : kMeasures) {
      const std::vector<double> p = PValues(sets, measure);
      for (std::size_t i = 1; i < sets.size(); ++i) all[i][measure.key]["p"] = p[i - 1];
    }
  }
  return {{"runs", sets.front().searches.front().runs}, {"sets", std::move(all)}};
}

}  // namespace gauntlet
