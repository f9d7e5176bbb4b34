#include "master/campaign/run_limits.h"

#include <algorithm>

#include "sim/robot/foot_bot.h"

namespace gauntlet::master {
namespace {

constexpr double kLeastSeconds = 60.0;
constexpr double kSecondsPerTick = 0.01;

}  // namespace

double CpuLimitSeconds(const sim::Parameters& scenario_parameters) {
  const auto time_limit = scenario_parameters.find("time_limit");
  if (time_limit == scenario_parameters.end()) return kLeastSeconds;
  return std::max(kLeastSeconds, time_limit->second * sim::kTicksPerSecond * kSecondsPerTick);
}

}  // namespace gauntlet::master
