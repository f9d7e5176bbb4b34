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
#include "analysis/tables/table.h"
#include "base/printable.h"

namespace gauntlet {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::size_t kAnySize = std::numeric_limits<std::size_t>::max();

constexpr std::string_view kReading =
    "cells: of the grid over how the swarm fails, those with a case that failed in at least half of its runs "
    "with fresh seeds; up to 3, up to 2, one: with a case of so few obstacles; runs to 5, to 10: until cases "
    "of up to 3 obstacles had been found in so many cells. cases: of a search that keeps elites these, of "
    "others all that failed. Elites are late: a smaller one takes the place of a larger one found before.";
double NumberOf(std::size_t count) {
  return static_cast<double>(count);
}

// What is compared.
struct Measure {
  std::string_view key;           // in JSON
  std::string_view title;         // over a column
  std::size_t most_obstacles;     // of the cases that count
  std::size_t runs_to_cells = 0;  // runs until so many cells hold one; 0: the number of cells

  // Nothing: never.
  std::optional<double> Of(const SearchYield& yield) const {
    if (runs_to_cells == 0) return NumberOf(CellsWith(yield, most_obstacles));
    const std::optional<std::uint64_t> runs = RunsUntil(yield, runs_to_cells, most_obstacles);
    return runs ? std::optional(static_cast<double>(*runs)) : std::nullopt;
  }
};
constexpr std::array kMeasures = std::to_array<Measure>({
    {"cells", "cells", kAnySize},
    {"cells_with_up_to_3", "up to 3", 3},
    {"cells_with_up_to_2", "up to 2", 2},
    {"cells_with_1", "one", 1},
    {"runs_until_5_cells_with_up_to_3", "runs to 5", 3, 5},
    {"runs_until_10_cells_with_up_to_3", "runs to 10", 3, 10},
});

// What the searches of a set come to by one measure.
struct Measured {
  std::vector<double>
      values;           // one for each search; what was never reached counts as a run more than there were
  double never = 0.0;   // what stands for it
  bool reached = true;  // by all searches
  double median = 0.0;
  double mean = 0.0;
  std::optional<analysis::Interval> interval = std::nullopt;  // of the mean
  // Of the first set against this one, adjusted for their number; none of the first.
  std::optional<double> p = std::nullopt;
};

Measured MeasuredOf(const YieldSet& set, const Measure& measure) {
  Measured measured{.values = {}, .never = static_cast<double>(set.searches.front().runs + 1)};
  for (const SearchYield& one : set.searches) {
    const std::optional<double> value = measure.Of(one);
    measured.reached = measured.reached && value.has_value();
    measured.values.push_back(value.value_or(measured.never));
  }
  const analysis::Description description = analysis::Describe(measured.values);
  measured.median = description.median;
  measured.mean = description.mean;
  if (measured.reached && measured.values.size() > 1)
    measured.interval = analysis::MeanInterval(measured.values, analysis::kConfidence);
  return measured;
}

// Of every set by one measure.
std::vector<Measured> AllMeasured(const std::vector<YieldSet>& sets, const Measure& measure) {
  std::vector<Measured> all;
  std::vector<double> p;
  for (const YieldSet& set : sets) {
    const Measured& one = all.emplace_back(MeasuredOf(set, measure));
    if (all.size() == 1) continue;
    const auto exact = analysis::ExactMannWhitney(all.front().values, one.values);
    p.push_back(exact ? exact->p_two_sided
                      : analysis::MannWhitney(all.front().values, one.values).p_two_sided);
  }
  p = analysis::HolmAdjusted(p);
  for (std::size_t i = 0; i < p.size(); ++i) all[i + 1].p = p[i];
  return all;
}

// The median for people, everything for programs.
Cell MedianCell(const Measured& measured) {
  Json values = Json::array();
  for (const double value : measured.values) values.push_back(value < measured.never ? Json(value) : Json());
  const bool reached = measured.median < measured.never;
  Json json = {{"median", reached ? Json(measured.median) : Json()},
               {"mean", measured.reached ? Json(measured.mean) : Json()},
               {"mean_interval", JsonValue(IntervalCell(measured.interval).value)},
               {"values", std::move(values)}};
  if (measured.p) json["p"] = *measured.p;
  return JsonCell(std::move(json), reached ? fmt::format("{:.4g}", measured.median) : "never");
}

Cell MeanCell(const Measured& measured) {
  if (!measured.reached) return {};
  const int decimals = measured.mean < 100.0 ? 1 : 0;
  if (!measured.interval) return DecimalCell(measured.mean, decimals);
  return fmt::format("{:.{}f} ({:.{}f} to {:.{}f})", measured.mean, decimals, measured.interval->low,
                     decimals, measured.interval->high, decimals);
}

Cell PCell(const Measured& measured) {
  return DigitsCell(*measured.p, 2);
}

// A row for each set from the number `from` on, its first cells followed by one for each measure.
Table BudgetTable(const std::vector<YieldSet>& sets, std::vector<Column> columns,
                  std::vector<Cell> (*first)(const YieldSet&), Cell (*cell)(const Measured&),
                  std::size_t from = 0) {
  std::vector<std::vector<Cell>> rows;
  for (const YieldSet& set : sets) rows.push_back(first(set));
  for (const Measure& measure : kMeasures) {
    columns.emplace_back(fmt::format(">{}", measure.title), std::string(measure.key));
    const std::vector<Measured> all = AllMeasured(sets, measure);
    for (std::size_t i = from; i < rows.size(); ++i) rows[i].push_back(cell(all[i]));
  }
  Table table(std::move(columns));
  for (std::size_t i = from; i < rows.size(); ++i) table.AddRow(std::move(rows[i]));
  return table;
}

std::vector<Cell> SetNameOf(const YieldSet& set) {
  return {set.name};
}

std::vector<Cell> HeadOf(const YieldSet& set) {
  std::size_t cases = 0;
  std::size_t confirmed = 0;
  for (const SearchYield& one : set.searches) {
    cases += one.cases;
    confirmed += one.confirmed.size();
  }
  const Cell share =
      cases == 0 ? Cell() : fmt::format("{:.1f} %", 100.0 * NumberOf(confirmed) / NumberOf(cases));
  return {set.name, set.title,
          Cell(fmt::format("{} x {}", set.searches.size(), set.title), set.searches.size()), cases,
          Cell(share.text, confirmed)};
}

Table Medians(const std::vector<YieldSet>& sets) {
  return BudgetTable(sets,
                     {{"set", "set"},
                      ForPrograms("search"),
                      {"searches", "searches"},
                      {">cases", "cases"},
                      {">confirmed", "confirmed"}},
                     HeadOf, MedianCell);
}

}  // namespace

std::string BudgetText(const std::vector<YieldSet>& sets) {
  std::string text = fmt::format("What {} runs of a search give, medians over the searches\n{}",
                                 FormatCount(sets.front().searches.front().runs), Medians(sets).ToText());
  text += fmt::format("\nMeans, with their 95 % intervals (Student's t)\n{}",
                      BudgetTable(sets, {"set"}, SetNameOf, MeanCell).ToText());
  if (sets.size() > 1) {
    text +=
        fmt::format("\np of {} against each of the others (Mann-Whitney, two-sided, after Holm)\n{}",
                    Printable(sets.front().name), BudgetTable(sets, {"set"}, SetNameOf, PCell, 1).ToText());
  }
  return text + "\n  " + Wrapped(kReading, 110, 2) + "\n";
}

Json BudgetJson(const std::vector<YieldSet>& sets) {
  return {{"runs", sets.front().searches.front().runs}, {"sets", Medians(sets).ToJson()}};
}

}  // namespace gauntlet
