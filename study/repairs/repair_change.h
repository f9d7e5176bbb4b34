// What a repair changes in a set of cases.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "analysis/statistics/interval.h"
#include "search/repair/repair_course.h"

namespace gauntlet {

// Failure probabilities of the original and of the repaired settings in the same cases, over all runs there.
struct RepairChange {
  std::size_t cases = 0;
  double before = 0.0;
  double after = 0.0;
  analysis::Interval before_interval;
  analysis::Interval after_interval;
  double a = 0.5;     // chance that a run has a higher fitness after than before, ties counting half
  double less = 0.0;  // before - after
  analysis::Interval less_interval;
};

// In `count` cases from `first` on; nothing without them, or before they were simulated. `units`: how many of
// the cases belong together each, one after the other; intervals are over these, or over the cases where the
// units are too few (below 10) or none.
std::optional<RepairChange> ChangeOf(const RepairCourse& course, std::size_t first, std::size_t count,
                                     std::vector<std::size_t> units = {});

// Vargha and Delaney's A of the second against the first; .5 where either is empty.
double FitnessA(const std::vector<double>& before, const std::vector<double>& after);

}  // namespace gauntlet
