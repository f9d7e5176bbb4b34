#include "analysis/statistics/rank_test.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "analysis/statistics/distributions.h"
#include "base/check.h"

namespace gauntlet::analysis {
namespace {

RankTest FromRankSum(double rank_sum1, std::size_t size1, std::size_t size2, double tie_term) {
  const auto n1 = static_cast<double>(size1);
  const auto n2 = static_cast<double>(size2);
  const double n = n1 + n2;
  RankTest test;
  test.rank_sum1 = rank_sum1;
  test.rank_sum2 = n * (n + 1.0) / 2.0 - rank_sum1;
  test.u1 = rank_sum1 - n1 * (n1 + 1.0) / 2.0;
  test.u2 = n1 * n2 - test.u1;
  test.a = test.u1 / (n1 * n2);
  const double variance = n1 * n2 / 12.0 * (n + 1.0 - tie_term / (n * (n - 1.0)));
  if (!(variance > 0.0)) {
    test.method = "no test: all values are equal";
    return test;
  }
  test.method = "Mann-Whitney U, normal approximation, corrected for ties and continuity";
  const double sigma = std::sqrt(variance);
  const double difference = test.u1 - n1 * n2 / 2.0;
  test.p_greater = NormalUpperTail((difference - 0.5) / sigma);
  test.p_less = NormalUpperTail((-difference - 0.5) / sigma);
  const double towards_zero = difference > 0.0 ? 0.5 : (difference < 0.0 ? -0.5 : 0.0);
  test.p_two_sided = std::min(1.0, 2.0 * NormalUpperTail(std::fabs(difference - towards_zero) / sigma));
  return test;
}

}  // namespace

std::vector<double> MidRanks(std::span<const double> values) {
  std::vector<std::size_t> order(values.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return values[a] < values[b]; });
  std::vector<double> ranks(values.size());
  for (std::size_t begin = 0; begin < order.size();) {
    std::size_t end = begin + 1;
    while (end < order.size() && values[order[end]] == values[order[begin]]) ++end;
    const double mid_rank = (static_cast<double>(begin) + 1.0 + static_cast<double>(end)) / 2.0;
    for (std::size_t i = begin; i < end; ++i) ranks[order[i]] = mid_rank;
    begin = end;
  }
  return ranks;
}

RankTest MannWhitney(std::span<const double> first, std::span<const double> second) {
  GAUNTLET_CHECK(!first.empty() && !second.empty(), "a rank test needs values in both sets");
  std::vector<double> all(first.begin(), first.end());
  all.insert(all.end(), second.begin(), second.end());
  for (const double value : all) GAUNTLET_CHECK(!std::isnan(value), "a rank test cannot order NaN");
  std::vector<double> ranks = MidRanks(all);
  const double rank_sum1 =
      std::accumulate(ranks.begin(), ranks.begin() + static_cast<std::ptrdiff_t>(first.size()), 0.0);

  double tie_term = 0.0;  // sum of t^3 - t over groups of t tied values
  std::sort(ranks.begin(), ranks.end());
  for (std::size_t begin = 0; begin < ranks.size();) {
    std::size_t end = begin;
    while (end < ranks.size() && ranks[end] == ranks[begin]) ++end;
    const auto t = static_cast<double>(end - begin);
    tie_term += t * t * t - t;
    begin = end;
  }
  return FromRankSum(rank_sum1, first.size(), second.size(), tie_term);
}

std::string_view EffectOf(double a) {
  const double size = std::max(a, 1.0 - a);
  if (size >= kVarghaDelaney2000.large) return "large";
  if (size >= kVarghaDelaney2000.medium) return "medium";
  return size >= kVarghaDelaney2000.small ? "small" : "none";
}

}  // namespace gauntlet::analysis
