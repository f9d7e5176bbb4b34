#include "report/figures/study_figures.h"

#include <algorithm>
#include <iterator>

#include <fmt/format.h>

#include "analysis/figures/tuning_figure.h"
#include "base/number_text.h"
#include "report/figures/set_comparison.h"
#include "report/tables/data_table.h"

namespace gauntlet {
namespace {

std::string DrawRobustnessOf(const StudySection& section) {
  analysis::RobustnessFigure figure;
  figure.title = section.title;
  figure.outcome = "Robustness analysis: one value changed at a time. " + section.sentences.back();
  figure.low = "easier cases than the baseline";
  figure.high = "tougher cases";
  for (const TriedParameter& parameter : section.tuning->parameters) {
    analysis::RobustnessGroup& group = figure.groups.emplace_back();
    group.parameter = parameter.key;
    for (const TriedValue& value : parameter.values) {
      group.points.push_back({.value = value.value,
                              .remark = fmt::format("median {:.3f}, {} simulations", value.median,
                                                    FormatCount(value.simulations)),
                              .is_baseline = value.is_baseline,
                              .a = value.a,
                              .interval = value.interval,
                              .exceeds = value.exceeds});
    }
  }
  return analysis::DrawRobustness(figure);
}

std::string RobustnessCsv(const TuningResult& tuning) {
  std::vector<std::vector<Cell>> rows;
  for (const TriedParameter& parameter : tuning.parameters) {
    for (const TriedValue& value : parameter.values) {
      std::vector<Cell> row = {parameter.key,         value.value,
                               value.is_baseline,     std::uint64_t{value.evolutions},
                               value.simulations,     NumberCell(value.median),
                               NumberCell(value.mean)};
      if (value.is_baseline) {
        row.resize(row.size() + 4);
      } else {
        row.insert(row.end(),
                   {NumberCell(value.a), value.interval ? NumberCell(value.interval->low) : Cell(),
                    value.interval ? NumberCell(value.interval->high) : Cell(), NumberCell(value.p_holm)});
      }
      rows.push_back(std::move(row));
    }
  }
  return CsvText({"parameter", "value", "baseline", "evolutions", "simulations each", "median", "mean", "A",
                  "A low", "A high", "p (Holm)"},
                 rows);
}

std::string DrawConsistencyOf(const StudySection& section) {
  const auto& enough = section.tuning->enough;
  const std::string outcome =
      enough ? fmt::format("Consistency analysis: {} repeats are enough", *enough)
             : std::string("Consistency analysis: more repeats are needed than were looked at");
  return analysis::DrawConsistency({section.title, outcome, section.tuning->consistency});
}

std::string ConsistencyCsv(const TuningResult& tuning) {
  std::vector<std::vector<Cell>> rows;
  for (const analysis::Consistency& one : tuning.consistency)
    rows.push_back({std::uint64_t{one.size}, NumberCell(one.median_a), NumberCell(one.max_a)});
  return CsvText({"repeats in a set", "median A", "largest A"}, rows);
}

std::vector<NamedFigure> TuningFigures(const StudySection& section, const std::string& suffix) {
  std::vector<NamedFigure> figures = {
      {"robustness" + suffix, "What each value of a parameter does",
       "A row for each value of a parameter, while all others keep the baseline's. The dot is A: the "
       "probability that an evolution of the baseline ends with a higher fitness (easier cases) than one "
       "with "
       "this value. To the right of the middle the value finds tougher cases, to the left easier ones; "
       "within "
       "the grey band the difference is not large. Lines are 95 % intervals; a line that crosses the middle "
       "may be a matter of chance.",
       [&section] { return DrawRobustnessOf(section); },
       [&section] { return RobustnessCsv(*section.tuning); }}};
  if (section.tuning->consistency.empty()) return figures;
  figures.push_back(
      {"consistency" + suffix, "How many repeats are enough",
       "Sets of evolutions that differ in nothing are held against one another: the more "
       "evolutions in a set, the nearer A comes to 0.5. From the size on at which the largest A "
       "(red) stays within the grey band, a large difference is no matter of chance.",
       [&section] { return DrawConsistencyOf(section); },
       [&section] { return ConsistencyCsv(*section.tuning); }});
  return figures;
}

}  // namespace

std::vector<NamedFigure> FiguresOf(const StudyReport& report, const StudySection& section) {
  if (section.tuning) {
    const auto tunings = std::ranges::count_if(
        report.sections, [](const StudySection& one) { return one.tuning.has_value(); });
    return TuningFigures(section, tunings == 1 ? "" : "-" + section.name);
  }
  if (!section.compared) return {};
  const ComparedSets& compared = *section.compared;
  return {{section.name, section.title, std::string(kReadingOfBoxes),
           [&] { return DrawSets(section.name, section.title, compared.metric, compared.sets); },
           [&compared] { return SetsCsv(compared.metric, compared.sets); }}};
}

std::vector<NamedFigure> FiguresOf(const StudyReport& report) {
  std::vector<NamedFigure> figures;
  for (const StudySection& section : report.sections)
    std::ranges::move(FiguresOf(report, section), std::back_inserter(figures));
  return figures;
}

}  // namespace gauntlet
