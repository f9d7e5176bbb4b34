#include "study/sets/failure_groups.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>

#include "analysis/statistics/comparison.h"
#include "analysis/statistics/proportions.h"

namespace gauntlet {
namespace {

// Values and how many have them, without "".
std::map<std::string, int> CountsOf(std::span<const std::string> values) {
  std::map<std::string, int> counts;
  for (const std::string& value : values) {
    if (!value.empty()) ++counts[value];
  }
  return counts;
}

}  // namespace

FailurePlaces::FailurePlaces(const controllers::ScenarioInfo& scenario,
                             const sim::Parameters& scenario_parameters, const sim::TestCase& test_case)
    : descriptor_(scenario.failures) {
  if (scenario.failures.passages) passages_ = scenario.failures.passages(scenario_parameters, test_case);
}

std::string FailurePlaces::Of(controllers::MetricValues metrics) const {
  std::optional<sim::Vec2> place = descriptor_.PlaceOf(metrics);
  if (!place) return "";
  const auto distance = [&](const sim::Vec2& passage) { return (passage - *place).norm(); };
  if (!passages_.empty()) place = *std::ranges::min_element(passages_, {}, distance);
  const double side = descriptor_.SameWithin();
  const auto shown = [&](double metres) { return side * std::round(metres / side) + 0.0; };  // no "-0.0"
  return fmt::format("near ({:.1f}, {:.1f})", shown(place->x()), shown(place->y()));
}

std::optional<LeadingFeature> LeadingOf(std::span<const std::string> values) {
  LeadingFeature leading;
  for (const auto& [value, runs] : CountsOf(values)) {
    leading.of += runs;
    if (runs <= leading.runs) continue;
    leading.value = value;
    leading.runs = runs;
  }
  if (leading.of == 0) return std::nullopt;
  const analysis::Interval share =
      analysis::WilsonInterval(static_cast<std::uint32_t>(leading.runs),
                               static_cast<std::uint32_t>(leading.of), analysis::kConfidence);
  leading.leads = leading.of >= static_cast<int>(kRunsForGroup) && share.low > 0.5;
  return leading;
}

std::optional<double> AgreementWithin(std::span<const std::vector<std::string>> cases) {
  // Of two runs that are drawn from one case, and of two from cases that are drawn.
  double within = 0.0, of_two_cases = 0.0, count = 0.0;
  std::map<std::string, double> shares;  // of a value, summed over cases
  double squares = 0.0;                  // of shares in one case, likewise
  for (const std::vector<std::string>& values : cases) {
    const std::map<std::string, int> counts = CountsOf(values);
    double runs = 0.0, pairs = 0.0;
    for (const auto& [value, many] : counts) {
      runs += many;
      pairs += many * (many - 1.0);
    }
    if (runs < 2.0) continue;
    ++count;
    within += pairs / (runs * (runs - 1.0));
    for (const auto& [value, many] : counts) {
      const double share = many / runs;
      shares[value] += share;
      squares += share * share;
    }
  }
  if (count < 2.0) return std::nullopt;
  within /= count;
  for (const auto& [value, sum] : shares) of_two_cases += sum * sum;
  of_two_cases = (of_two_cases - squares) / (count * (count - 1.0));
  constexpr double kRounding = 1e-12;
  if (of_two_cases > 1.0 - kRounding) return std::nullopt;
  return (within - of_two_cases) / (1.0 - of_two_cases);
}

}  // namespace gauntlet
