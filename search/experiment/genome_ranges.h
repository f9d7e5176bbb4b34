// The ranges that genes are drawn from.
#pragma once

#include <cstdint>

#include "base/result.h"
#include "search/experiment/experiment.h"

namespace gauntlet {

inline constexpr double kSpeedStep = 0.001;  // m/s, grid of the speeds of moving obstacles

// Grid points of a range, as whole numbers of 1/divisions metres.
struct GridRange {
  std::int64_t first = 0;
  std::int64_t last = -1;
  double divisions = 1.0;  // points per metre
};

// Those of `min` to `max` that are multiples of `step`, a whole fraction of 1; none when last < first.
GridRange GridOf(double min, double max, double step);

// Whether genes can be drawn: every minimum at most its maximum, `step` 0 or a whole fraction of a metre, and
// a point of the grid in every range. The error names key, value and rule.
Status CheckGenomeSpec(const GenomeSpec& spec);

}  // namespace gauntlet
