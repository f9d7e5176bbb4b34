#include "study/sets/failure_groups.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "analysis/statistics/clusters.h"

namespace gauntlet {
namespace {

// 0 for two ways without a place; ways that cannot be one failure are infinitely far apart.
double Distance(const FailureWay& a, const FailureWay& b) {
  if (a.kind != b.kind || a.place.has_value() != b.place.has_value())
    return std::numeric_limits<double>::infinity();
  return a.place ? (*a.place - *b.place).norm() : 0.0;
}

}  // namespace

FailureWays::FailureWays(const controllers::ScenarioInfo& scenario,
                         const sim::Parameters& scenario_parameters, const sim::TestCase& test_case)
    : descriptor_(scenario.failures) {
  if (scenario.failures.passages) passages_ = scenario.failures.passages(scenario_parameters, test_case);
}

FailureWay FailureWays::Of(controllers::MetricValues metrics) const {
  FailureWay way{descriptor_.KindOf(metrics), descriptor_.PlaceOf(metrics)};
  if (!way.place || passages_.empty()) return way;
  const auto distance = [&](const sim::Vec2& passage) { return (passage - *way.place).norm(); };
  way.place = *std::ranges::min_element(passages_, {}, distance);
  return way;
}

std::size_t TypicalWay(std::span<const FailureWay> ways) {
  const auto alike = [&](const FailureWay& way) {
    return std::ranges::count_if(ways, [&](const FailureWay& other) {
      return other.kind == way.kind && other.place.has_value() == way.place.has_value();
    });
  };
  const auto scatter = [&](const FailureWay& way) {
    double sum = 0.0;
    for (const FailureWay& other : ways) {
      if (const double distance = Distance(way, other); distance < std::numeric_limits<double>::infinity())
        sum += distance;
    }
    return sum;
  };
  const auto typical = std::ranges::min_element(
      ways, {}, [&](const FailureWay& way) { return std::pair(-alike(way), scatter(way)); });
  return static_cast<std::size_t>(typical - ways.begin());
}

std::vector<std::size_t> GroupWays(const controllers::ScenarioInfo& scenario,
                                   std::span<const FailureWay> ways) {
  return analysis::GroupByDistance(
      ways.size(), [&](std::size_t a, std::size_t b) { return Distance(ways[a], ways[b]); },
      scenario.failures.SameWithin());
}

std::string DescribeWay(const controllers::ScenarioInfo& scenario, const FailureWay& way) {
  std::string text;
  if (way.kind < scenario.failures.kinds.size()) text = scenario.failures.kinds[way.kind].what;
  if (way.place) {
    const auto shown = [](double metres) { return std::round(10.0 * metres) / 10.0 + 0.0; };  // no "-0.0"
    text += fmt::format("{}near ({:.1f}, {:.1f})", text.empty() ? "" : ", ", shown(way.place->x()),
                        shown(way.place->y()));
  }
  return text.empty() ? "a failure" : text;
}

}  // namespace gauntlet
