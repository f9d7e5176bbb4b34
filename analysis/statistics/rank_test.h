// The Mann-Whitney U test and Vargha and Delaney's A: is one set of runs worse than another, and by how much?
// Values are finite, at least one in either set (CheckSample says so of values from outside).
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

namespace gauntlet::analysis {

// Ranks of the values, 1 = smallest; tied values share the mean of their ranks (mid-ranks).
std::vector<double> MidRanks(std::span<const double> values);

struct RankTest {
  double rank_sum1 = 0.0;
  double rank_sum2 = 0.0;
  // Pairs in which the first value is larger, ties counting half: rank_sum1 - n1 (n1 + 1) / 2, R's W. The
  // thesis prints the complement: its U of a set is our U of the other one.
  double u1 = 0.0;
  double u2 = 0.0;
  double a = 0.5;       // u1 / (n1 n2): chance that a value of the first set exceeds one of the second, ties
                        // counting half (Vargha and Delaney 2000)
  double p_less = 1.0;  // one-tailed: the first set tends to smaller values
  double p_greater = 1.0;
  double p_two_sided = 1.0;
  std::string_view method;  // how p was computed, in words
};

// Mann and Whitney 1947 with the normal approximation, corrected for ties and for continuity (R's
// wilcox.test(exact = FALSE)). When all values are equal there is nothing to test: p = 1, a = 0.5, and the
// method says so.
RankTest MannWhitney(std::span<const double> first, std::span<const double> second);

struct ExactRankTest {
  double p_less = 1.0;
  double p_greater = 1.0;
  double p_two_sided = 1.0;  // twice the smaller tail, at most 1 (R's convention)
  std::string_view method;
};

// Up to this product of the sizes (100 against 100) the exact distribution takes a moment, not minutes.
inline constexpr std::size_t kMostExactPairs = 10'000;

// From the distribution of U over all ways to deal the observed mid-ranks to two sets of these sizes: exact
// with ties too, and without them R's wilcox.test(exact = TRUE). Nothing beyond kMostExactPairs.
std::optional<ExactRankTest> ExactMannWhitney(std::span<const double> first, std::span<const double> second);

// From where on A, or 1 - A when that is larger, is called small, medium and large.
struct EffectThresholds {
  double small = 0.0;
  double medium = 0.0;
  double large = 0.0;
};
inline constexpr EffectThresholds kVarghaDelaney2000{0.56, 0.64, 0.71};  // thesis 3.2.4

// "none", "small", "medium" or "large", by kVarghaDelaney2000. `a` in [0, 1].
std::string_view EffectOf(double a);

}  // namespace gauntlet::analysis
