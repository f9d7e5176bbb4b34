#include "analysis/statistics/proportions.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <vector>

#include "analysis/statistics/distributions.h"
#include "analysis/statistics/sample.h"
#include "base/check.h"

namespace gauntlet::analysis {
namespace {

void CheckCounts(std::uint32_t hits, std::uint32_t trials) {
  GAUNTLET_CHECK(trials > 0 && hits <= trials, "a share needs trials, and at most as many hits");
}

}  // namespace

Interval WilsonInterval(std::uint32_t hits, std::uint32_t trials, double confidence) {
  CheckCounts(hits, trials);
  CheckConfidence(confidence);
  const double n = trials;
  const double share = hits / n;
  const double z = NormalQuantile(0.5 + confidence / 2.0);
  const double scale = 1.0 + z * z / n;
  const double centre = (share + z * z / (2.0 * n)) / scale;
  const double half = z * std::sqrt(share * (1.0 - share) / n + z * z / (4.0 * n * n)) / scale;
  return {hits == 0 ? 0.0 : centre - half, hits == trials ? 1.0 : centre + half};
}

Interval AgrestiCoullInterval(double hits, double trials, double confidence) {
  CheckConfidence(confidence);
  const double z = NormalQuantile(0.5 + confidence / 2.0);
  const double n = trials + z * z;
  const double centre = (hits + z * z / 2.0) / n;
  const double half = z * std::sqrt(centre * (1.0 - centre) / n);
  return {std::max(0.0, centre - half), std::min(1.0, centre + half)};
}

Interval MeanShareInterval(std::span<const double> shares, double trials, double confidence) {
  const Description described = Describe(shares);
  const double mean = described.mean;
  const auto cases = static_cast<double>(shares.size());
  // Cases of which none, or all, were hit may all be alike, or each decided by one trial.
  double effective = cases;
  if (described.sd && *described.sd > 0.0)
    effective =
        std::clamp(mean * (1.0 - mean) * cases / (*described.sd * *described.sd), 1.0, cases * trials);
  return AgrestiCoullInterval(mean * effective, effective, confidence);
}

Interval DifferenceInterval(std::uint32_t hits1, std::uint32_t trials1, std::uint32_t hits2,
                            std::uint32_t trials2, double confidence) {
  const Interval first = WilsonInterval(hits1, trials1, confidence);
  const Interval second = WilsonInterval(hits2, trials2, confidence);
  const double p1 = static_cast<double>(hits1) / trials1;
  const double p2 = static_cast<double>(hits2) / trials2;
  return {p1 - p2 - std::hypot(p1 - first.low, second.high - p2),
          p1 - p2 + std::hypot(first.high - p1, p2 - second.low)};
}

FisherTest FisherExact(std::uint32_t hits1, std::uint32_t trials1, std::uint32_t hits2,
                       std::uint32_t trials2) {
  CheckCounts(hits1, trials1);
  CheckCounts(hits2, trials2);
  GAUNTLET_CHECK(trials1 <= std::numeric_limits<std::uint32_t>::max() - trials2, "too many trials");
  // How many of all hits fall into the first set: hypergeometric. Its weights follow from each other,
  // outwards from the largest one, which is put to 1; nothing overflows, and what underflows is less than
  // 1e-308 of it.
  const std::uint32_t hits = hits1 + hits2;
  const std::uint32_t fewest = hits > trials2 ? hits - trials2 : 0;
  const std::uint32_t most = std::min(hits, trials1);
  // Weight of k + 1 in terms of that of k.
  const auto ratio = [&](std::uint32_t k) {
    return (static_cast<double>(hits) - k) * (static_cast<double>(trials1) - k) /
           ((k + 1.0) * (static_cast<double>(trials2) - hits + k + 1.0));
  };
  std::vector<double> weights(most - fewest + 1);
  const auto mode = static_cast<std::uint32_t>((trials1 + 1.0) * (hits + 1.0) /
                                               (static_cast<double>(trials1) + trials2 + 2.0));
  const std::uint32_t start = std::clamp(mode, fewest, most);
  weights[start - fewest] = 1.0;
  for (std::uint32_t k = start; k < most; ++k) weights[k + 1 - fewest] = weights[k - fewest] * ratio(k);
  for (std::uint32_t k = start; k > fewest; --k) weights[k - 1 - fewest] = weights[k - fewest] / ratio(k - 1);

  const double total = std::accumulate(weights.begin(), weights.end(), 0.0);
  const double as_rare = weights[hits1 - fewest] * (1.0 + 1e-7);  // equal but for rounding: R's margin
  FisherTest test{.p_less = 0.0, .p_greater = 0.0, .p_two_sided = 0.0};
  for (std::uint32_t k = fewest; k <= most; ++k) {
    const double p = weights[k - fewest] / total;
    if (k <= hits1) test.p_less += p;
    if (k >= hits1) test.p_greater += p;
    if (weights[k - fewest] <= as_rare) test.p_two_sided += p;
  }
  for (double* p : {&test.p_less, &test.p_greater, &test.p_two_sided}) *p = std::min(1.0, *p);
  test.odds_ratio = (hits1 + 0.5) * (trials2 - hits2 + 0.5) / ((trials1 - hits1 + 0.5) * (hits2 + 0.5));
  return test;
}

}  // namespace gauntlet::analysis
