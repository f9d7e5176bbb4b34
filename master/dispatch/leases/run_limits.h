// What a run may use before it counts as one that never ends.
#pragma once

#include <string_view>

#include "sim/run_spec.h"

namespace gauntlet {

// CPU time of a run of that scenario with these parameters, s: 10 ms for each tick that it may simulate, but
// at least 60. Far above what any run takes (with 100 robots, the most there can be, 0.3 to 1.5 ms for a
// tick), so that a run which would end is not called hung on a slow machine.
double CpuLimitSeconds(std::string_view scenario, const sim::Parameters& scenario_parameters,
                       std::string_view plugin = "");

}  // namespace gauntlet
