#include "report/figures/settings/repair_figure.h"

#include <algorithm>

#include <fmt/format.h>

#include "analysis/figures/line_figure.h"
#include "analysis/statistics/comparison.h"
#include "analysis/statistics/proportions.h"

namespace gauntlet {
namespace {

std::string DrawCurve(const Repair& repair, std::size_t number) {
  const VariedKey& varied = repair.plan().varied[number];
  analysis::FigureLine line{.name = "failing runs"};
  for (const RepairLevel& level : RepairCurve(repair, number)) {
    const analysis::Interval interval =
        analysis::WilsonInterval(static_cast<std::uint32_t>(level.failures),
                                 static_cast<std::uint32_t>(level.runs), analysis::kConfidence);
    line.x.push_back(NumberOf(level.value));
    line.y.push_back(static_cast<double>(level.failures) / level.runs);
    line.low.push_back(interval.low);
    line.high.push_back(interval.high);
  }
  const double original = NumberOf(repair.plan().original[number]);
  const double repaired = NumberOf(repair.course().ValuesOf(*repair.course().repaired())[number]);
  const auto upright = [](const char* name, double at) {
    return analysis::FigureLine{.name = name, .x = {at, at}, .y = {0.0, 1.0}};
  };
  return analysis::DrawLines(
      {.title = "Failures along " + varied.key.path,
       .outcome = "Training cases, all other parameters original.",
       .x_name = varied.key.unit.empty() ? varied.key.path : varied.key.path + ", " + varied.key.unit,
       .panels = {{"share of failing runs",
                   {line, upright("original", original), upright("repaired", repaired)},
                   0.0,
                   1.0}}});
}

}  // namespace

std::vector<NamedFigure> RepairFigures(const CampaignFacts& facts) {
  std::vector<NamedFigure> figures;
  if (!facts.repair || !facts.repair->finished) return figures;
  const Repair& repair = *facts.repair;
  for (std::size_t i = 0; i < repair.plan().varied.size(); ++i) {
    if (repair.plan().varied[i].listed()) continue;
    figures.push_back(
        {fmt::format("repair-{}", i + 1), "Failures along " + repair.plan().varied[i].key.path,
         "How many runs of the training cases fail at a value, with all other parameters as they "
         "were; the band is the 95 % interval.",
         [repair, i] { return DrawCurve(repair, i); },
         [repair, i] { return RepairCurveTable(repair, i).ToCsv(); }});
  }
  return figures;
}

}  // namespace gauntlet
