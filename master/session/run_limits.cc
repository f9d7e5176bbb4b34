#include "master/session/run_limits.h"

#include <algorithm>

#include "master/dispatch/dispatch_options.h"
#include "sim/robot/foot_bot.h"

namespace gauntlet::master {

double CpuLimitSeconds(const sim::Parameters& scenario_parameters) {
  constexpr double kSecondsPerTick = 0.01;
  const double least = DispatchOptions().cpu_limit_seconds;
  const auto time_limit = scenario_parameters.find("time_limit");
  if (time_limit == scenario_parameters.end()) return least;
  return std::max(least, time_limit->second * sim::kTicksPerSecond * kSecondsPerTick);
}

}  // namespace gauntlet::master
