// Covers: controllers/aggregation/aggregation_registry.cc
#include "controllers/aggregation/aggregation_scenario.h"

#include <gtest/gtest.h>

#include "controllers/aggregation/aggregation_registry.h"
#include "controllers/registry.h"
#include "tests/controllers/run_support.h"
#include "worker/run_executor.h"

namespace gauntlet::controllers::aggregation {
namespace {

using testing_support::Metric;
using testing_support::SpecOf;

// A wall from side to side but for a gap at each end, so that a path is left.
const sim::Genome kWall = {{0.0, 0.0, 4.6, 0.2, 45.0}};

TEST(AggregationScenario, EverybodyGathersInAnEmptyArena) {
  for (const std::uint64_t seed : {1, 2, 3, 4, 5}) {
    const sim::RunResult result = worker::Run(SpecOf("aggregation", "aggregation-minimal", seed));
    ASSERT_EQ(result.verdict, sim::Verdict::kCompleted) << result.message;
    EXPECT_EQ(result.ticks, 6000);
    EXPECT_GE(result.fitness, 0.9) << seed;
    EXPECT_FALSE(result.failure.total);
    EXPECT_GT(Metric(result, "time_to_90"), 0.0);
    EXPECT_EQ(Metric(result, "stuck_robots"), 0.0);
  }
}

TEST(AggregationScenario, BehindAWallASecondClusterStays) {
  sim::RunSpec spec = SpecOf("aggregation", "aggregation-minimal", 1);
  spec.test_case.obstacles = {kWall};
  const sim::RunResult result = worker::Run(spec);
  ASSERT_EQ(result.verdict, sim::Verdict::kCompleted) << result.message;
  EXPECT_LT(result.fitness, 0.8);
  EXPECT_GE(Metric(result, "second_cluster"), 0.2);
  EXPECT_EQ(Metric(result, "clusters_in_sight"), 0.0);
  std::size_t lost = 0;
  for (const sim::RobotSummary& robot : result.robots) lost += robot.lost ? 1 : 0;
  EXPECT_DOUBLE_EQ(1.0 - static_cast<double>(lost) / 20.0, Metric(result, "largest_cluster"));
  EXPECT_EQ(worker::Run(spec).hash, result.hash) << "the same spec gives the same bits";
}

TEST(AggregationScenario, RefusesACaseThatClosesMostOfTheArenaOff) {
  sim::RunSpec spec = SpecOf("aggregation", "aggregation-minimal", 1);
  // A corner of 2.4 x 2.4 m behind two walls: 17 % of the arena and the walls themselves.
  spec.test_case.obstacles = {{-1.8, 0.9, 2.4, 0.2, 0.0}, {-0.6, 1.95, 0.2, 2.2, 0.0}};
  EXPECT_EQ(worker::Run(spec).verdict, sim::Verdict::kCompleted);
  spec.test_case.obstacles = {{-1.3, 0.3, 3.4, 0.2, 0.0}, {0.3, 1.65, 0.2, 2.8, 0.0}};
  const sim::RunResult result = worker::Run(spec);
  EXPECT_EQ(result.verdict, sim::Verdict::kRefused);
  EXPECT_TRUE(result.message.starts_with("open-area: obstacle 2 ")) << result.message;
}

TEST(AggregationFailureTypes, AreNumberedAndNamed) {
  EXPECT_EQ(FailureTypeOf(0, 0.1, false), 0);
  EXPECT_EQ(FailureTypeOf(8, 0.25, true), kFailureTypes - 1);
  EXPECT_EQ(FailureLabel(FailureTypeOf(4, 0.3, false)),
            "another large cluster out of sight, the largest middle");
  const FailureTypes& types = AggregationScenarioInfo().failure_types;
  ASSERT_EQ(types.types.size(), static_cast<std::size_t>(kFailureTypes));
  EXPECT_EQ(types.Find(17)->name, FailureLabel(17));
}

}  // namespace
}  // namespace gauntlet::controllers::aggregation
