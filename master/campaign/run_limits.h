// What a run may use before it counts as one that never ends.
#pragma once

#include "sim/run_spec.h"

namespace gauntlet::master {

// CPU time of a run with these parameters of its scenario, s: 10 ms for each tick of its time_limit, but at
// least 60. Far above what any run takes (100 robots, the most there can be, take about 1 ms for a tick), so
// that no machine is so slow, nor a controller so costly, that a run which would end is called hung.
double CpuLimitSeconds(const sim::Parameters& scenario_parameters);

}  // namespace gauntlet::master
