// Shares: how certain is one that was counted, and do two differ?
#pragma once

#include <cstdint>
#include <span>

#include "analysis/statistics/interval.h"

namespace gauntlet::analysis {

// Interval for a probability of which `hits` of `trials` were seen (trials >= 1, hits <= trials), at a
// confidence in (0, 1): Wilson 1927, without continuity correction: holds its confidence on average.
Interval WilsonInterval(std::uint32_t hits, std::uint32_t trials, double confidence);

// The same by Agresti and Coull 1998, who keep it better where few are seen; both may be fractions, as of an
// effective number of trials. trials > 0.
Interval AgrestiCoullInterval(double hits, double trials, double confidence);

// For the mean probability of a hit over cases, of which each was tried `trials` times on average and showed
// one of the `shares`, at least one: of as many trials as would show so much spread by themselves (Dean and
// Pagano 2015).
Interval MeanShareInterval(std::span<const double> shares, double trials, double confidence);

// Of the difference between the probabilities of the first and the second (Newcombe 1998, method 10: from
// both Wilson intervals).
Interval DifferenceInterval(std::uint32_t hits1, std::uint32_t trials1, std::uint32_t hits2,
                            std::uint32_t trials2, double confidence);

struct FisherTest {
  double p_less = 1.0;  // one-tailed: the first share is the smaller one
  double p_greater = 1.0;
  double p_two_sided = 1.0;  // tables that are at most as probable as the observed one, as in R
  // Half a count is added to each cell (Haldane 1956, Anscombe 1956), which keeps it finite.
  double odds_ratio = 1.0;
};

// Fisher's exact test of hits1 of trials1 against hits2 of trials2: no approximation. At least one trial
// each, hits at most trials, fewer than 2^32 trials together.
FisherTest FisherExact(std::uint32_t hits1, std::uint32_t trials1, std::uint32_t hits2,
                       std::uint32_t trials2);

}  // namespace gauntlet::analysis
