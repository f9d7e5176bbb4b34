#include "master/dispatch/leases/run_limits.h"

#include <gtest/gtest.h>

#include <string>

namespace gauntlet {
namespace {

double LimitOf(const std::string& scenario, const sim::Parameters& parameters) {
  sim::RunSettings settings;
  settings.scenario = scenario;
  settings.scenario_parameters = parameters;
  return CpuLimitSeconds(settings);
}

TEST(RunLimitsTest, CpuTimeGrowsWithTheTimeThatARunMaySimulate) {
  EXPECT_EQ(LimitOf("flocking", {{"time_limit", 1.0}}), 60.0);
  EXPECT_EQ(LimitOf("flocking", {{"time_limit", 600.0}}), 60.0);
  EXPECT_EQ(LimitOf("flocking", {}), 90.0);  // 900 s by default
  EXPECT_EQ(LimitOf("task-partitioning", {{"time_limit", 36000.0}}), 3600.0);
  EXPECT_EQ(LimitOf("no such scenario", {{"time_limit", 36000.0}}), 60.0);
}

}  // namespace
}  // namespace gauntlet
