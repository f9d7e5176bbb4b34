#include "master/session/run_limits.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "controllers/registry.h"

namespace gauntlet::master {
namespace {

TEST(RunLimitsTest, CpuTimeGrowsWithTheTimeThatARunMaySimulate) {
  EXPECT_EQ(CpuLimitSeconds({{"time_limit", 1.0}}), 60.0);
  EXPECT_EQ(CpuLimitSeconds({{"time_limit", 600.0}}), 60.0);
  EXPECT_EQ(CpuLimitSeconds({{"time_limit", 36000.0}}), 3600.0);
  EXPECT_EQ(CpuLimitSeconds({}), 60.0);
}

// Another name would leave every run of that scenario the least.
TEST(RunLimitsTest, EveryScenarioSaysHowLongItsRunsMayBe) {
  for (const auto& scenario : controllers::Scenarios()) {
    const auto& parameters = scenario.parameters;
    EXPECT_TRUE(std::ranges::any_of(parameters, [](const auto& one) { return one.name == "time_limit"; }))
        << scenario.name;
  }
}

}  // namespace
}  // namespace gauntlet::master
