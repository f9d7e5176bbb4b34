// Tests of values that belong together in pairs: is the middle of their differences zero, and between which
// numbers does it lie? Values are finite; confidence in (0, 1).
#pragma once

#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include "analysis/statistics/interval.h"

namespace gauntlet::analysis {

struct PairedTest {
  double p_two_sided = 1.0;
  std::string_view method;
};

// Of as many pairs, one of which was hit in its first half alone, the other in its second: McNemar 1947, by
// the exact binomial distribution of the discordant pairs.
PairedTest McNemarExact(std::uint64_t only_first, std::uint64_t only_second);

// Wilcoxon 1945 of the differences; zeros are dropped, ties share their mid-ranks. Exact (the distribution
// over all signs of the observed ranks) up to this number of them, beyond it the normal approximation with
// the corrections for ties and continuity (R's wilcox.test(exact = FALSE)).
inline constexpr std::size_t kMostExactDifferences = 200;
PairedTest WilcoxonSignedRank(std::span<const double> differences);

// Of the mean of differences in [-1, 1], such as those of shares in the same cases: Bonett and Price 2012,
// who add one pair of either sort to the discordant pairs of yes/no values. Here a difference may be a
// fraction, as its square stands for it in the variance. At least one.
Interval MeanShareDifferenceInterval(std::span<const double> differences, double confidence);

// Fisher's test of the mean of differences, whose signs are exchanged (1935), and the interval that it gives
// when it is inverted. Both come from the same numbers, the means of all subsets of the differences (Hartigan
// 1969): where zero stands among them is p, and two of them bound the interval.
class SignFlips {
 public:
  static constexpr std::size_t kMostSubsets = 65'535;  // beyond, so many are drawn; always the same ones
  // Of fewer differences no assignment of signs is rare enough for the level .05.
  static constexpr std::size_t kFewest = 6;

  // At least one.
  explicit SignFlips(std::span<const double> differences);

  PairedTest Test() const;
  // The whole line where no assignment is rare enough.
  Interval IntervalOf(double confidence) const;

 private:
  std::vector<double> means_;  // ascending
  std::string_view method_;
};

// How many differences with the same mean and spread Student's t would take to find the mean at the level .05
// in about half of the attempts, at least kFewest; of at least two. 0: their mean is zero.
std::size_t UnitsNeeded(std::span<const double> differences);

}  // namespace gauntlet::analysis
