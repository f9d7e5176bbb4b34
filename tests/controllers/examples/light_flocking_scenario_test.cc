// Covers: controllers/examples/light_flocking_metrics.cc
#include "controllers/examples/light_flocking_scenario.h"

#include <gtest/gtest.h>

#include "controllers/examples/light_flocking_metrics.h"
#include "tests/controllers/run_support.h"
#include "worker/run_executor.h"

namespace gauntlet::controllers::light_flocking {
namespace {

using sim::Vec2;
using testing_support::Metric;

TEST(LightFlockingMetrics, LinksEndAtTheRangeAndAtObstacles) {
  sim::TestCase test_case;
  const std::vector<Vec2> robots = {{-1.0, 0.0}, {0.0, 0.0}, {1.0, 0.0}};
  EXPECT_EQ(CountClusters(robots, sim::Arena(test_case), 1.01), 1);
  EXPECT_EQ(CountClusters(robots, sim::Arena(test_case), 1.0), 3) << "nearer than the range, not at it";
  test_case.obstacles = {{0.5, 0.0, 0.1, 0.4, 0.0}};
  EXPECT_EQ(CountClusters(robots, sim::Arena(test_case), 1.01), 2);
  EXPECT_EQ(CountClusters(robots, sim::Arena(test_case), 2.01), 2) << "hidden from both others";
}

TEST(LightFlockingMetrics, StoppedIsWhoNeverLeftItsFirstPlace) {
  // The second robot comes back, the third creeps.
  const std::vector<std::vector<Vec2>> samples = {
      {{0, 0}, {1, 0}, {2, 0}}, {{0, 0.019}, {1.02, 0}, {2.015, 0}}, {{0, 0}, {1, 0}, {2.03, 0}}};
  EXPECT_DOUBLE_EQ(ShareStopped(samples, 0.02), 1.0 / 3.0);
  EXPECT_EQ(MeanDistance(samples[0], {0, 0}), 1.0);
}

TEST(LightFlockingScenario, TheSwarmComesToTheLightInAnEmptyArena) {
  sim::RunSpec spec;
  spec.scenario = "light-flocking";
  spec.controller = "light-flocking";
  spec.scenario_parameters = {{"time_limit", 300.0}};
  const sim::RunResult result = worker::Run(spec);
  ASSERT_EQ(result.verdict, sim::Verdict::kCompleted) << result.message;
  EXPECT_EQ(result.robots.size(), 10U);
  EXPECT_EQ(result.ticks, 3000);
  EXPECT_GT(result.fitness, 0.7);
  EXPECT_FALSE(result.failure.total);
  EXPECT_EQ(Metric(result, "clusters"), 1.0);
}

TEST(LightFlockingScenario, AWallBeforeTheLightKeepsItInTheDark) {
  sim::RunSpec spec;
  spec.scenario = "light-flocking";
  spec.controller = "light-flocking";
  spec.test_case.obstacles = {{0.0, 0.0, 6.0, 0.2, 135.0}};
  const sim::RunResult result = worker::Run(spec);
  ASSERT_EQ(result.verdict, sim::Verdict::kCompleted) << result.message;
  EXPECT_LT(result.fitness, 0.3);
  EXPECT_TRUE(result.failure.total);
}

}  // namespace
}  // namespace gauntlet::controllers::light_flocking
