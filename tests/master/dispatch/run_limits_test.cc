#include "master/dispatch/leases/run_limits.h"

#include <gtest/gtest.h>

namespace gauntlet {
namespace {

TEST(RunLimitsTest, CpuTimeGrowsWithTheTimeThatARunMaySimulate) {
  EXPECT_EQ(CpuLimitSeconds("flocking", {{"time_limit", 1.0}}), 60.0);
  EXPECT_EQ(CpuLimitSeconds("flocking", {{"time_limit", 600.0}}), 60.0);
  EXPECT_EQ(CpuLimitSeconds("flocking", {}), 90.0);  // 900 s by default
  EXPECT_EQ(CpuLimitSeconds("task-partitioning", {{"time_limit", 36000.0}}), 3600.0);
  EXPECT_EQ(CpuLimitSeconds("no such scenario", {{"time_limit", 36000.0}}), 60.0);
}

}  // namespace
}  // namespace gauntlet
