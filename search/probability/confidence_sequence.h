// How certain a probability is that is looked at again and again while it is being counted.
#pragma once

#include <cstdint>

#include "analysis/statistics/interval.h"

namespace gauntlet {

// The interval after `trials` independent trials, `hits` of them hits (hits <= trials), at a confidence in
// (0, 1). The true probability lies in the intervals of all numbers of trials at once with that confidence,
// so that one may stop whenever one likes (a confidence sequence; Darling and Robbins 1967). A probability p
// is left out where a mixture of likelihood ratios against it, which is a martingale under p, has reached 1 /
// (1 - confidence) (Ville 1939). Nine tenths of the alternatives have the beta distribution with mean p whose
// parameters are 3 / (1 - p) and 3 / p: so their spread follows that of the count, and the interval is at
// most twice as wide as one for a fixed number of trials, up to 100,000 of them. The others have that of
// Jeffreys (1/2, 1/2), by which a single hit rules out what is far below it. 0 to 1 without trials.
analysis::Interval ConfidenceSequence(std::uint64_t hits, std::uint64_t trials, double confidence);

// The quantile `probability` in (.5, 1) of Student's t distribution with so many degrees of freedom, 9 at
// least (Cornish-Fisher expansion as in Abramowitz and Stegun 26.7.5; within .003 of it): the same on every
// machine.
double StudentQuantile(double probability, int degrees_of_freedom);

}  // namespace gauntlet
