#include "master/dispatch/leases/run_limits.h"

#include <algorithm>

#include "controllers/registry.h"
#include "master/dispatch/dispatch_options.h"
#include "sim/robot/foot_bot.h"

namespace gauntlet {

double CpuLimitSeconds(const sim::RunSettings& settings) {
  constexpr double kSecondsPerTick = 0.01;
  const double least = DispatchOptions().cpu_limit_seconds;
  const controllers::ScenarioInfo* info = controllers::FindScenario(settings);
  if (info == nullptr) return least;
  return std::max(least,
                  info->TimeLimit(settings.scenario_parameters) * sim::kTicksPerSecond * kSecondsPerTick);
}

}  // namespace gauntlet
