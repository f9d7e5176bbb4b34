#include "analysis/statistics/paired_tests.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

#include "analysis/statistics/distributions.h"
#include "analysis/statistics/rank_test.h"
#include "analysis/statistics/sample.h"
#include "base/check.h"
#include "sim/random/random_stream.h"

namespace gauntlet::analysis {
namespace {

constexpr std::uint64_t kSubsetSeed = 1;

// P(at least `k` of `n`) of a fair coin, summed from the smallest term.
double FairCoinTail(std::uint64_t k, std::uint64_t n) {
  double sum = 0.0;
  const auto of = static_cast<double>(n);
  for (std::uint64_t i = n + 1; i-- > k;) {
    const auto heads = static_cast<double>(i);
    sum += std::exp(std::lgamma(of + 1.0) - std::lgamma(heads + 1.0) - std::lgamma(of - heads + 1.0) -
                    of * std::log(2.0));
  }
  return std::min(1.0, sum);
}

// P(at most `observed`) of the sum of those of the numbers that a fair coin picks.
double SubsetSumTail(const std::vector<std::size_t>& numbers, std::size_t observed) {
  std::vector<double> chance(observed + 1, 0.0);
  chance[0] = 1.0;
  for (const std::size_t number : numbers) {
    for (std::size_t sum = observed + 1; sum-- > 0;)
      chance[sum] = 0.5 * (chance[sum] + (sum >= number ? chance[sum - number] : 0.0));
  }
  return std::accumulate(chance.begin(), chance.end(), 0.0);
}

double SignedRankNormal(const std::vector<double>& ranks, double sum) {
  const auto n = static_cast<double>(ranks.size());
  std::vector<double> sorted = ranks;
  std::ranges::sort(sorted);
  double ties = 0.0;
  for (auto at = sorted.begin(); at != sorted.end();) {
    const auto end = std::upper_bound(at, sorted.end(), *at);
    const auto tied = static_cast<double>(end - at);
    ties += tied * tied * tied - tied;
    at = end;
  }
  const double far = std::abs(sum - n * (n + 1.0) / 4.0);
  const double sigma = std::sqrt(n * (n + 1.0) * (2.0 * n + 1.0) / 24.0 - ties / 48.0);
  return std::min(1.0, 2.0 * NormalUpperTail((far - std::min(far, 0.5)) / sigma));
}

}  // namespace

PairedTest McNemarExact(std::uint64_t only_first, std::uint64_t only_second) {
  const std::uint64_t discordant = only_first + only_second;
  if (discordant == 0) return {1.0, "no test: no pair differs"};
  return {std::min(1.0, 2.0 * FairCoinTail(std::max(only_first, only_second), discordant)), "McNemar, exact"};
}

PairedTest WilcoxonSignedRank(std::span<const double> differences) {
  std::vector<double> sizes;
  std::vector<bool> positive;
  for (const double one : differences) {
    if (one == 0.0) continue;
    sizes.push_back(std::abs(one));
    positive.push_back(one > 0.0);
  }
  if (sizes.empty()) return {1.0, "no test: no pair differs"};
  const std::vector<double> ranks = MidRanks(sizes);
  double sum = 0.0;
  std::vector<std::size_t> doubled;
  for (std::size_t i = 0; i < ranks.size(); ++i) {
    if (positive[i]) sum += ranks[i];
    doubled.push_back(static_cast<std::size_t>(std::lround(2.0 * ranks[i])));
  }
  if (ranks.size() > kMostExactDifferences)
    return {SignedRankNormal(ranks, sum), "Wilcoxon signed ranks, normal approximation"};
  const auto all = static_cast<double>(ranks.size()) * (static_cast<double>(ranks.size()) + 1.0) / 2.0;
  const auto smaller = static_cast<std::size_t>(std::lround(2.0 * std::min(sum, all - sum)));
  return {std::min(1.0, 2.0 * SubsetSumTail(doubled, smaller)), "Wilcoxon signed ranks, exact"};
}

Interval MeanShareDifferenceInterval(std::span<const double> differences, double confidence) {
  GAUNTLET_CHECK(!differences.empty(), "a mean needs values");
  CheckConfidence(confidence);
  double sum = 0.0;
  double squares = 2.0;
  for (const double one : differences) {
    sum += one;
    squares += one * one;
  }
  const double n = static_cast<double>(differences.size()) + 2.0;
  const double mean = sum / n;
  const double half = NormalQuantile(0.5 + confidence / 2.0) * std::sqrt((squares / n - mean * mean) / n);
  return {std::max(-1.0, mean - half), std::min(1.0, mean + half)};
}

SignFlips::SignFlips(std::span<const double> differences) {
  const std::size_t n = differences.size();
  GAUNTLET_CHECK(n > 0, "a test needs differences");
  const auto add = [&](const auto& holds) {
    double sum = 0.0;
    std::size_t count = 0;
    for (std::size_t i = 0; i < n; ++i) {
      if (!holds(i)) continue;
      sum += differences[i];
      ++count;
    }
    if (count > 0) means_.push_back(sum / static_cast<double>(count));
  };
  const bool all = n <= 16;
  method_ = all ? "exchanged signs, exact" : "exchanged signs, 65,535 drawn";
  if (all) {
    for (std::uint32_t set = 1; set < 1U << n; ++set)
      add([set](std::size_t i) { return (set >> i & 1U) == 1U; });
  } else {
    sim::RandomStream random(kSubsetSeed, sim::StreamPurpose::kStatistics);
    while (means_.size() < kMostSubsets) add([&](std::size_t) { return random.Below(2) == 1; });
  }
  std::ranges::sort(means_);
}

PairedTest SignFlips::Test() const {
  const auto at_most = std::ranges::upper_bound(means_, 0.0) - means_.begin();
  const auto at_least = means_.end() - std::ranges::lower_bound(means_, 0.0);
  const auto rarer = static_cast<double>(1 + std::min(at_most, at_least));
  return {std::min(1.0, 2.0 * rarer / static_cast<double>(means_.size() + 1)), method_};
}

Interval SignFlips::IntervalOf(double confidence) const {
  CheckConfidence(confidence);
  const double tail = (1.0 - confidence) / 2.0 * static_cast<double>(means_.size() + 1);
  const auto rank = static_cast<std::size_t>(tail + 1e-9);
  if (rank == 0) return {-std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity()};
  return {means_[rank - 1], means_[means_.size() - rank]};
}

std::size_t UnitsNeeded(std::span<const double> differences) {
  const Description described = Describe(differences);
  GAUNTLET_CHECK(described.sd.has_value(), "a spread needs two values");
  if (described.mean == 0.0) return 0;
  std::size_t units = 2;
  while (units < 10'000 &&
         std::abs(described.mean) <
             StudentUpperQuantile(0.025, static_cast<double>(units - 1)) * *described.sd / std::sqrt(units))
    ++units;
  return std::max(units, SignFlips::kFewest);
}

}  // namespace gauntlet::analysis
