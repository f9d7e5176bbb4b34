#include "report/figures/settings/margin_figure.h"

#include <fmt/format.h>

#include "analysis/figures/line_figure.h"
#include "analysis/statistics/proportions.h"

namespace gauntlet {
namespace {

// The fit in steps of equal probability, each with the interval of its runs; the share that is crossed.
std::string DrawMargin(const Margin& margin) {
  const std::vector<MarginLevel>& levels = margin.estimate->levels;
  analysis::FigureLine fit{.name = "failing runs"};
  for (std::size_t first = 0; first < levels.size();) {
    std::size_t end = first;
    std::uint32_t runs = 0;
    std::uint32_t failures = 0;
    for (; end < levels.size() && levels[end].fit == levels[first].fit; ++end) {
      runs += static_cast<std::uint32_t>(levels[end].runs);
      failures += static_cast<std::uint32_t>(levels[end].failures);
    }
    const analysis::Interval interval = analysis::WilsonInterval(failures, runs, 0.95);
    for (; first < end; ++first) {
      fit.x.push_back(levels[first].value);
      fit.y.push_back(levels[first].fit);
      fit.low.push_back(interval.low);
      fit.high.push_back(interval.high);
    }
  }
  const VariedKey& key = margin.plan.key;
  const analysis::FigureLine share{.name = fmt::format("{:.0f} %", 100.0 * margin.plan.share),
                                   .x = {key.low, key.high},
                                   .y = {margin.plan.share, margin.plan.share}};
  return analysis::DrawLines(
      {.title = "Failures along " + key.key.path,
       .outcome = OutcomeOf(margin),
       .x_name = key.key.unit.empty() ? key.key.path : key.key.path + ", " + std::string(key.key.unit),
       .panels = {{"share of failing runs", {fit, share}, 0.0, 1.0}}});
}

}  // namespace

std::vector<NamedFigure> MarginFigures(const CampaignFacts& facts) {
  std::vector<NamedFigure> figures;
  for (const Margin& one : facts.margins) {
    if (!one.estimate) continue;
    figures.push_back({fmt::format("margin-{}", figures.size() + 1),
                       "Failures along " + one.plan.key.key.path,
                       "How many runs fail at a value, as a fit that never turns back; the band is the 95 % "
                       "interval of the runs of each step.",
                       [one] { return DrawMargin(one); }, [one] { return LevelTable(one).ToCsv(); }});
  }
  return figures;
}

}  // namespace gauntlet
