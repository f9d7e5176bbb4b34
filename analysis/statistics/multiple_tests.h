// Several tests at once: each finds something by chance now and then.
#pragma once

#include <span>
#include <vector>

namespace gauntlet::analysis {

// Holm 1979: p-values, in the order given, adjusted so that rejecting those below alpha errs anywhere with at
// most chance alpha. Each in [0, 1].
std::vector<double> HolmAdjusted(std::span<const double> p);

}  // namespace gauntlet::analysis
