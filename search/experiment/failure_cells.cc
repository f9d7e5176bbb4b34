#include "search/experiment/failure_cells.h"

#include <algorithm>
#include <cmath>
#include <string_view>

#include <fmt/format.h>

#include "base/nearest_name.h"
#include "base/parse_number.h"
#include "base/split.h"
#include "controllers/registry.h"

namespace gauntlet {
namespace {

Result<controllers::DescriptorAxis> ParseAxis(const std::string& text,
                                              const controllers::ScenarioInfo& scenario) {
  const std::vector<std::string> parts = Split(text, ':');
  const auto wrong = [&](const std::string& what) {
    return InvalidInput(fmt::format("search.cells: '{}': {}", text, what));
  };
  if (parts.size() != 4) return wrong("METRIC:FROM:TO:PARTS is needed, as in x:-3:3:5");
  const auto from = ParseNumber<double>(parts[1]);
  const auto to = ParseNumber<double>(parts[2]);
  const auto count = ParseNumber<int>(parts[3]);
  if (!from || !to || !std::isfinite(*from) || !std::isfinite(*to))
    return wrong(fmt::format("{} to {} are no two numbers", parts[1], parts[2]));
  if (*from >= *to) return wrong(fmt::format("the range from {} to {} is empty", parts[1], parts[2]));
  if (!count || *count < 1 || *count > kMostCells)
    return wrong(fmt::format("{} parts: a whole number from 1 to {} is needed", parts[3], kMostCells));
  if (controllers::FindMetric(scenario, parts[0]) == nullptr)
    return wrong(fmt::format("{} does not report it: {}", scenario.name,
                             UnknownName("metric", parts[0], scenario.metrics)));
  return controllers::DescriptorAxis{parts[0], *from, *to, *count};
}

}  // namespace

Result<std::vector<controllers::DescriptorAxis>> ParseCells(const std::string& text,
                                                            const controllers::ScenarioInfo& scenario) {
  std::vector<controllers::DescriptorAxis> axes;
  double cells = 1.0;
  std::istringstream stream(text);
  for (std::string word; stream >> word;) {
    TRY(auto axis, ParseAxis(word, scenario));
    if (std::ranges::find(axes, axis.metric, &controllers::DescriptorAxis::metric) != axes.end())
      return InvalidInput(fmt::format("search.cells: '{}' stands twice", axis.metric));
    cells *= axis.parts;
    axes.push_back(std::move(axis));
  }
  if (cells > kMostCells)
    return InvalidInput(fmt::format("search.cells: {} cells; {} are the most", cells, kMostCells));
  return axes;
}

std::vector<controllers::DescriptorAxis> CellsOf(const Experiment& experiment) {
  const controllers::ScenarioInfo* scenario = controllers::FindScenario(experiment);
  if (scenario == nullptr) return {};
  if (!experiment.search.cells.empty()) return ParseCells(experiment.search.cells, *scenario).value();
  return scenario->failures.axes;
}

std::optional<BrokenRule> CheckCells(const Experiment& experiment) {
  const controllers::ScenarioInfo* scenario = controllers::FindScenario(experiment);
  if (scenario == nullptr || experiment.search.cells.empty()) return std::nullopt;
  const Result<std::vector<controllers::DescriptorAxis>> cells =
      ParseCells(experiment.search.cells, *scenario);
  if (!cells) return BrokenRule{"search.cells", cells.error().message};
  if (cells->empty()) return BrokenRule{"search.cells", "search.cells names no metric"};
  return std::nullopt;
}

}  // namespace gauntlet
