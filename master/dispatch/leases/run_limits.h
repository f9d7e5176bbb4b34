// What a run may use before it counts as one that never ends.
#pragma once

#include "sim/run_spec.h"

namespace gauntlet {

// CPU time of a run with these settings, s: 10 ms for each tick that it may simulate, but
// at least 60. Far above what any run takes (with 100 robots, the most there can be, 0.3 to 1.5 ms for a
// tick), so that a run which would end is not called hung on a slow machine.
double CpuLimitSeconds(const sim::RunSettings& settings);

}  // namespace gauntlet
