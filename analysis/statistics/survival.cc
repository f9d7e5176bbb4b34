#include "analysis/statistics/survival.h"

#include <algorithm>
#include <cmath>

#include "analysis/statistics/distributions.h"
#include "base/check.h"

namespace gauntlet::analysis {
namespace {

// The first time at which `curve` (of a step) is below one half; where it is exactly one half for a while,
// the middle of that while, as for the median of an even number of values.
template <typename Curve>
std::optional<double> TimeOfOneHalf(const std::vector<SurvivalStep>& steps, Curve curve) {
  constexpr double kRounding = 1e-9;
  for (std::size_t i = 0; i < steps.size(); ++i) {
    const double value = curve(steps[i]);
    if (value > 0.5 + kRounding) continue;
    if (value < 0.5 - kRounding || i + 1 == steps.size()) return steps[i].time;
    return (steps[i].time + steps[i + 1].time) / 2.0;
  }
  return std::nullopt;
}

}  // namespace

SurvivalCurve KaplanMeier(std::span<const Duration> durations, double confidence) {
  GAUNTLET_CHECK(!durations.empty(), "a survival curve needs durations");
  GAUNTLET_CHECK(confidence > 0.0 && confidence < 1.0, "a confidence lies between 0 and 1");
  std::vector<Duration> sorted(durations.begin(), durations.end());
  for (const Duration& duration : sorted) {
    GAUNTLET_CHECK(duration.time >= 0.0 && std::isfinite(duration.time), "a duration is finite, at least 0");
  }
  std::sort(sorted.begin(), sorted.end(),
            [](const Duration& a, const Duration& b) { return a.time < b.time; });

  const double z = NormalQuantile(0.5 + confidence / 2.0);
  SurvivalCurve curve;
  double survival = 1.0;
  double greenwood = 0.0;  // variance of its logarithm
  Interval interval{1.0, 1.0};
  for (std::size_t begin = 0; begin < sorted.size();) {
    std::size_t end = begin;
    std::size_t happened = 0;
    for (; end < sorted.size() && sorted[end].time == sorted[begin].time; ++end) {
      if (sorted[end].happened) ++happened;
    }
    const std::size_t at_risk = sorted.size() - begin;
    if (happened > 0) {
      const auto r = static_cast<double>(at_risk);
      const auto d = static_cast<double>(happened);
      if (happened < at_risk) {
        survival *= 1.0 - d / r;
        greenwood += d / (r * (r - d));
        const double factor = std::exp(z * std::sqrt(greenwood));
        interval = {survival / factor, std::min(1.0, survival * factor)};
      } else {
        survival = 0.0;
        interval.low = 0.0;
      }
      curve.steps.push_back({sorted[begin].time, at_risk, happened, survival, interval});
    }
    begin = end;
  }

  curve.median = TimeOfOneHalf(curve.steps, [](const SurvivalStep& step) { return step.survival; });
  // At survival 0 the formula gives no interval, hence no end for the median either.
  std::vector<SurvivalStep> inner = curve.steps;
  std::erase_if(inner, [](const SurvivalStep& step) { return step.survival == 0.0; });
  curve.median_low = TimeOfOneHalf(inner, [](const SurvivalStep& step) { return step.interval.low; });
  curve.median_high = TimeOfOneHalf(inner, [](const SurvivalStep& step) { return step.interval.high; });
  return curve;
}

}  // namespace gauntlet::analysis
