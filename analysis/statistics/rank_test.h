// The Mann-Whitney U test and Vargha and Delaney's A: is one set of runs worse than another, and by how much?
#pragma once

#include <span>
#include <vector>

namespace gauntlet::analysis {

// Ranks of the values, 1 = smallest; tied values share the mean of their ranks (mid-ranks).
std::vector<double> MidRanks(std::span<const double> values);

struct RankTest {
  double rank_sum1 = 0.0;
  double rank_sum2 = 0.0;
  double u1 =
      0.0;  // pairs in which the first value is larger, ties counting half: rank_sum1 - n1 (n1 + 1) / 2
  double u2 = 0.0;
  double a = 0.5;  // u1 / (n1 n2): chance that a value of the first set exceeds one of the second (Vargha and
                   // Delaney 2000)
  double p_less = 1.0;  // one-tailed: the first set tends to smaller values
  double p_greater = 1.0;
  double p_two_sided = 1.0;
};

// Mann and Whitney 1947 with the normal approximation, corrected for ties and for continuity (as R's
// wilcox.test(exact = FALSE)). When all values are equal there is nothing to test: p = 1, a = 0.5. Both sets
// must hold at least one value, none NaN.
RankTest MannWhitney(std::span<const double> first, std::span<const double> second);

// Upper tail of the standard normal distribution.
double NormalUpperTail(double z);

}  // namespace gauntlet::analysis
