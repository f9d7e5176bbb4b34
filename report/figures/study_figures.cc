#include "report/figures/study_figures.h"

#include <algorithm>
#include <iterator>

#include <fmt/format.h>

#include "analysis/figures/tuning_figure.h"
#include "analysis/tables/table.h"
#include "base/number_text.h"
#include "report/figures/set_comparison.h"
#include "study/study_tables.h"

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
  Table table({"parameter", "value", "baseline", "evolutions", "simulations each", "median", "mean", "A",
               "A low", "A high", "p (Holm)"});
  for (const TriedParameter& parameter : tuning.parameters) {
    for (const TriedValue& value : parameter.values) {
      const bool compared = !value.is_baseline;
      const bool interval = compared && value.interval;
      table.AddRow({parameter.key, value.value, value.is_baseline, value.evolutions, value.simulations,
                    value.median, value.mean, compared ? Cell(value.a) : Cell(),
                    interval ? Cell(value.interval->low) : Cell(),
                    interval ? Cell(value.interval->high) : Cell(), compared ? Cell(value.p_holm) : Cell()});
    }
  }
  return table.ToCsv();
}

std::string DrawConsistencyOf(const StudySection& section) {
  const auto& enough = section.tuning->enough;
  const std::string outcome =
      enough ? fmt::format("Consistency analysis: {} repeats are enough", *enough)
             : std::string("Consistency analysis: more repeats are needed than were looked at");
  return analysis::DrawConsistency({section.title, outcome, section.tuning->consistency});
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
       [&section] { return ConsistencyTable(*section.tuning).ToCsv(); }});
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
