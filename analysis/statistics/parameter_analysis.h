// Spartan's analyses of a simulation's parameters (Alden, Read, Timmis, Andrews, Veiga-Fernandes and Coles
// 2013, PLoS Computational Biology 9(2)): how many repeats are enough, and which parameters matter. Both rest
// on Vargha and Delaney's A, and both call a difference one when A is large by EffectOf: 0.21 or more away
// from 0.5. Sets are never empty, values finite.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "analysis/statistics/comparison.h"

namespace gauntlet::analysis {

// A, or 1 - A when that is larger: how far apart two sets are, whichever is the larger one.
double NormalisedA(double a);

// Whether A is large, in either direction.
bool Exceeds(double a);

// Of several sets of one size, all measured with the same parameters.
struct Consistency {
  std::size_t size = 0;   // values in each set
  double median_a = 0.5;  // normalised, of the first set against each of the others
  double max_a = 0.5;
};

// Consistency ("aleatory") analysis of one size: what A do sets have between which nothing differs? At least
// two sets of equal sizes. A of the first set against the others stands in `scores` when it is given.
Consistency AnalyseConsistency(std::span<const std::vector<double>> sets,
                               std::vector<double>* scores = nullptr);

// Spartan measures every set anew. Here `number` sets of `size` values are drawn with replacement from values
// that were measured once; A depends on the order of values alone, so little is lost as long as most of them
// differ. Deterministic in `seed`.
std::vector<std::vector<double>> DrawSets(std::span<const double> values, std::size_t size,
                                          std::size_t number, std::uint64_t seed);

// The smallest size from which on no set differed from the first by a large A. None when the largest size
// still did.
std::optional<std::size_t> EnoughRepeats(std::span<const Consistency> ascending_sizes);

// Robustness analysis of one value of one parameter, all others as in the baseline.
struct Robustness {
  Comparison comparison;  // of the baseline (first) against the changed one, as Spartan does
  bool exceeds = false;   // Exceeds(A)
  double p_holm = 1.0;    // the two-sided p, adjusted for all values that were tried
};

// One for each of `changed`. Error: a value is not finite, or a set is empty (CheckSample).
Result<std::vector<Robustness>> AnalyseRobustness(const std::vector<double>& baseline,
                                                  std::span<const std::vector<double>> changed);

}  // namespace gauntlet::analysis
