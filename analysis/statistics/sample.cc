#include "analysis/statistics/sample.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <string>

#include "analysis/statistics/distributions.h"
#include "base/check.h"

namespace gauntlet::analysis {
namespace {

std::vector<double> Sorted(std::span<const double> values) {
  const Status status = CheckSample(values, "a sample");
  GAUNTLET_CHECK(status.ok(), status.error().message);
  std::vector<double> sorted(values.begin(), values.end());
  std::sort(sorted.begin(), sorted.end());
  return sorted;
}

double SortedQuantile(const std::vector<double>& sorted, double probability) {
  GAUNTLET_CHECK(probability >= 0.0 && probability <= 1.0, "a quantile needs a probability in [0, 1]");
  const auto n = static_cast<double>(sorted.size());
  // Positions that are whole numbers but for rounding are whole numbers: the fuzz of R's quantile().
  constexpr double kFuzz = 4.0 * std::numeric_limits<double>::epsilon();
  const double position = 1.0 + probability * (n - 1.0);
  const double whole = std::floor(position + kFuzz);
  double part = position - whole;
  if (std::fabs(part) < kFuzz) part = 0.0;
  const auto at = [&](double place) {
    return sorted[static_cast<std::size_t>(std::clamp(place, 1.0, n)) - 1];
  };
  const double low = at(whole);
  const double high = at(whole + 1.0);
  return low == high ? low : (1.0 - part) * low + part * high;
}

// Median and hinges of Tukey's five-number summary (R's fivenum).
std::array<double, 3> TukeyHinges(const std::vector<double>& sorted) {
  const auto n = static_cast<double>(sorted.size());
  const double depth = std::floor((n + 3.0) / 2.0) / 2.0;
  const auto at = [&](double place) {
    return 0.5 * (sorted[static_cast<std::size_t>(std::floor(place)) - 1] +
                  sorted[static_cast<std::size_t>(std::ceil(place)) - 1]);
  };
  return {at(depth), at((n + 1.0) / 2.0), at(n + 1.0 - depth)};
}

}  // namespace

Status CheckSample(std::span<const double> values, std::string_view name) {
  if (values.empty()) return InvalidInput(std::string(name) + " is empty: at least one value is needed");
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (std::isfinite(values[i])) continue;
    return InvalidInput(std::string(name) + ": value " + std::to_string(i + 1) + " is " +
                        (std::isnan(values[i]) ? "not a number" : "infinite") +
                        ", only finite numbers can be compared");
  }
  return Ok();
}

Description Describe(std::span<const double> values) {
  const std::vector<double> sorted = Sorted(values);
  const auto n = static_cast<double>(sorted.size());
  Description description;
  description.n = sorted.size();
  description.minimum = sorted.front();
  description.median = SortedQuantile(sorted, 0.5);
  description.maximum = sorted.back();
  // The second pass takes back what rounding did to the first, so that equal values have exactly no spread.
  description.mean = std::accumulate(sorted.begin(), sorted.end(), 0.0) / n;
  double rest = 0.0;
  for (const double value : sorted) rest += value - description.mean;
  description.mean = std::clamp(description.mean + rest / n, sorted.front(), sorted.back());
  if (sorted.size() > 1) {
    double squares = 0.0;
    for (const double value : sorted) squares += (value - description.mean) * (value - description.mean);
    description.sd = std::sqrt(squares / (n - 1.0));
  }
  return description;
}

Interval MeanInterval(std::span<const double> values, double confidence) {
  GAUNTLET_CHECK(values.size() >= 2, "a single value has no spread");
  const Description description = Describe(values);
  const auto n = static_cast<double>(values.size());
  const double half =
      StudentUpperQuantile((1.0 - confidence) / 2.0, n - 1.0) * description.sd.value() / std::sqrt(n);
  return {description.mean - half, description.mean + half};
}

double Quantile(std::span<const double> values, double probability) {
  return SortedQuantile(Sorted(values), probability);
}

BoxPlot MakeBoxPlot(std::span<const double> values) {
  const std::vector<double> sorted = Sorted(values);
  BoxPlot box;
  const auto [lower, median, upper] = TukeyHinges(sorted);
  box.lower_quartile = lower;
  box.median = median;
  box.upper_quartile = upper;
  const double length = upper - lower;
  const auto inside = [&](double value) {
    return value >= box.lower_quartile - 1.5 * length && value <= box.upper_quartile + 1.5 * length;
  };
  box.lower_whisker = *std::find_if(sorted.begin(), sorted.end(), inside);
  box.upper_whisker = *std::find_if(sorted.rbegin(), sorted.rend(), inside);
  std::copy_if(sorted.begin(), sorted.end(), std::back_inserter(box.outliers),
               [&](double value) { return !inside(value); });
  const double notch = 1.58 * length / std::sqrt(static_cast<double>(sorted.size()));
  box.lower_notch = median - notch;
  box.upper_notch = median + notch;
  return box;
}

}  // namespace gauntlet::analysis
