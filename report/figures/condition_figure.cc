#include "report/figures/condition_figure.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "analysis/figures/line_figure.h"
#include "base/parse_number.h"
#include "report/tables/conditions.h"

namespace gauntlet {
namespace {

constexpr const char* kConditionTitle = "How often it fails under each condition";

struct Point {
  std::string key;  // that varies fastest
  double value = 0.0;
  std::string rest;  // the other settings
  const Condition* condition = nullptr;
};

std::optional<Point> PointOf(const Condition& condition) {
  const std::size_t comma = condition.settings.rfind(", ");
  const std::string last =
      comma == std::string::npos ? condition.settings : condition.settings.substr(comma + 2);
  const std::size_t equals = last.find('=');
  if (equals == std::string::npos) return std::nullopt;
  const auto value = ParseNumber<double>(last.substr(equals + 1));
  if (!value || !std::isfinite(*value)) return std::nullopt;
  return Point{last.substr(0, equals), *value,
               comma == std::string::npos ? "" : condition.settings.substr(0, comma), &condition};
}

// A line for each combination of the other keys, with a band where every point has an interval.
std::vector<analysis::FigureLine> LinesOf(std::vector<Point> points) {
  std::ranges::stable_sort(points, {}, &Point::value);
  std::vector<analysis::FigureLine> lines;
  for (const Point& point : points) {
    const std::string name = point.rest.empty() ? "failing runs" : point.rest;
    auto line = std::ranges::find(lines, name, &analysis::FigureLine::name);
    if (line == lines.end()) line = lines.insert(lines.end(), {.name = name});
    const auto& interval = point.condition->interval;
    line->x.push_back(point.value);
    line->y.push_back(100.0 * point.condition->share);
    line->low.push_back(interval ? 100.0 * interval->low : std::nan(""));
    line->high.push_back(interval ? 100.0 * interval->high : std::nan(""));
  }
  for (analysis::FigureLine& line : lines) {
    if (std::ranges::none_of(line.low, [](double low) { return std::isnan(low); })) continue;
    line.low.clear();
    line.high.clear();
  }
  return lines;
}

}  // namespace

std::vector<NamedFigure> ConditionFigures(const CampaignFacts& facts) {
  const std::vector<Condition> conditions = ConditionsOf(facts.summary);
  if (conditions.size() < 2) return {};
  std::vector<Point> points;
  for (const Condition& one : conditions) {
    const auto point = PointOf(one);
    if (!point || point->key != PointOf(conditions.front())->key) return {};
    points.push_back(*point);
  }
  const analysis::LineFigure figure{.title = kConditionTitle,
                                    .outcome = RangeOf(conditions) + " of the runs",
                                    .x_name = points.front().key,
                                    .panels = {{"failing runs, %", LinesOf(points), 0.0, 100.0}}};
  return {
      {"failures-by-condition", kConditionTitle,
       "The share of runs that fail at each value of the swept key; a band holds the 95 % intervals, over "
       "cases, or over searches where there are several of a condition.",
       [figure] { return analysis::DrawLines(figure); },
       [table = ConditionsTable(conditions)] { return table.ToCsv(); }}};
}

}  // namespace gauntlet
