// Covers: controllers/partitioning/partitioning_record.cc
#include "controllers/partitioning/partitioning_scenario.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <string_view>

#include "controllers/partitioning/partitioning_registry.h"
#include "controllers/registry.h"
#include "gmock/gmock.h"
#include "gtest/gtest.h"
#include "sim/simulation.h"
#include "tests/controllers/run_support.h"
#include "worker/run_executor.h"

namespace gauntlet {
namespace {

using ::testing::StartsWith;
using testing_support::Metric;
using testing_support::SumOfMetrics;

sim::RunSpec PartitionSpec(const std::string& controller, std::uint64_t seed) {
  return testing_support::SpecOf("task-partitioning", controller, seed);
}

TEST(PartitioningScenario, RelaysItemsInTheEmptyArena) {
  for (const char* controller : {"task-partitioning", "task-partitioning-improved"}) {
    const sim::RunResult result = worker::Run(PartitionSpec(controller, 1));
    ASSERT_EQ(result.verdict, sim::Verdict::kCompleted) << result.message;
    EXPECT_EQ(result.ticks, 8000);
    EXPECT_GE(result.fitness, 6.0);
    EXPECT_GE(Metric(result, "transfers"), 6.0);
    EXPECT_EQ(Metric(result, "food_taken"), result.fitness + Metric(result, "food_carried"));
    EXPECT_EQ(SumOfMetrics(result, "food_window_"), result.fitness);
    EXPECT_NEAR(SumOfMetrics(result, "mean_robots_"), 6.0, 1e-9);
    EXPECT_EQ(Metric(result, "partition_length"), 2.0);
    EXPECT_GE(Metric(result, "mean_waiting_time"), 0.0);
    EXPECT_FALSE(result.failure.total);
  }
}

TEST(PartitioningScenario, StartsInTheSteadyStateOrInTheNest) {
  sim::RunSpec spec = PartitionSpec("task-partitioning", 3);
  const sim::RunResult steady = worker::Run(spec);
  for (std::size_t i = 0; i < 6; ++i) {
    const sim::Vec2 place(0.0, i < 3 ? 0.0 : 2.0);
    EXPECT_LE((steady.robots[i].start.position - place).norm(), 0.5) << i;
  }
  spec.scenario_parameters["start_mode"] = 1.0;
  for (const sim::RobotSummary& robot : worker::Run(spec).robots) {
    EXPECT_LE((robot.start.position - sim::Vec2(0.0, -2.0)).norm(), 0.5);
  }
  spec.test_case.spawn_area = sim::Rectangle{{1.0, -1.0}, {2.0, 0.0}};
  for (const sim::RobotSummary& robot : worker::Run(spec).robots) {
    EXPECT_GE(robot.start.position.x(), 1.0);
  }
}

TEST(PartitioningScenario, OneRobotAloneWorksWithoutTransfers) {
  sim::RunSpec spec = PartitionSpec("task-partitioning", 1);
  spec.test_case.robots = 1;
  const sim::RunResult result = worker::Run(spec);
  EXPECT_GE(result.fitness, 1.0);
  EXPECT_EQ(Metric(result, "transfers"), 0.0);
  EXPECT_GE(Metric(result, "wait_timeouts"), 1.0);
  EXPECT_GT(Metric(result, "mean_waiting_time"), 100.0);  // the last wait may be cut short
  EXPECT_LE(Metric(result, "mean_waiting_time"), 180.2);
  spec.controller_parameters["wait_time"] = 0.0;
  const sim::RunResult hasty = worker::Run(spec);
  EXPECT_GT(hasty.fitness, result.fitness) << "zero waiting time: it carries on at once";
}

TEST(PartitioningScenario, ItemsPerWindowKeepThePhysicalBound) {
  // A robot carries one item per round trip of 2 * 4 m less the widths of nest and source.
  sim::RunSpec spec = PartitionSpec("task-partitioning", 2);
  const sim::RunResult result = worker::Run(spec);
  const double round_trip = 2.0 * (4.0 - 0.5 - 0.36) / 0.05;
  EXPECT_LE(result.fitness, 6.0 * (800.0 / round_trip + 1.0));
}

TEST(PartitioningScenario, MarksTransfersAndTellsStates) {
  const sim::RunResult result = worker::Run(PartitionSpec("task-partitioning", 1));
  double transfers = 0.0;
  double lines = 0.0;
  for (const sim::Annotation& mark : result.annotations) {
    if (mark.kind == "states") {
      ++lines;
      EXPECT_EQ(mark.label, "explore,go-to-nest,wait-for-transfer,go-to-source,neighbourhood");
      EXPECT_EQ(mark.points.front(), sim::Vec2(0.0, 4.0)) << "steady state begins in Neighbourhood";
    }
    if (mark.kind != "transfer") continue;
    ++transfers;
    EXPECT_EQ(mark.robots.size(), 2u);
    EXPECT_GT(mark.tick, 150);
    EXPECT_EQ(mark.points.size(), 1u);
  }
  EXPECT_EQ(transfers, Metric(result, "transfers"));
  EXPECT_EQ(lines, 6.0);
}

TEST(PartitioningScenario, MarksALightThatIsNotAboveTheNest) {
  sim::RunSpec spec = PartitionSpec("task-partitioning", 1);
  spec.scenario_parameters["time_limit"] = 10.0;
  const auto light = [](const sim::RunResult& result) {
    return std::find_if(result.annotations.begin(), result.annotations.end(),
                        [](const sim::Annotation& one) { return one.label == "light"; });
  };
  const sim::RunResult above = worker::Run(spec);
  EXPECT_EQ(light(above), above.annotations.end());
  spec.scenario_parameters["light_offset_x"] = 0.7;
  const sim::RunResult beside = worker::Run(spec);
  ASSERT_NE(light(beside), beside.annotations.end());
  EXPECT_EQ(light(beside)->points.front(), sim::Vec2(0.7, -2.0));
}

TEST(PartitioningScenario, RunsAgainBitByBit) {
  for (const controllers::ControllerInfo& controller : controllers::PartitioningControllers()) {
    sim::RunSpec spec = PartitionSpec(std::string(controller.name), 9);
    spec.test_case.obstacles = {{0.5, 0.4, 1.2, 0.2, 20.0}};
    EXPECT_EQ(worker::Run(spec).hash, worker::Run(spec).hash);
  }
}

TEST(PartitioningScenario, TellsHowPartitionLengthsAreLearnt) {
  sim::RunSpec spec = PartitionSpec("task-partitioning-dynamic", 1);
  spec.scenario_parameters = {{"time_limit", 1200.0}};
  const sim::RunResult result = worker::Run(spec);
  EXPECT_NEAR(Metric(result, "partition_length_window_1"), 0.5, 0.2);
  EXPECT_EQ(Metric(result, "partition_length_window_10"), Metric(result, "partition_length"));
  EXPECT_GT(Metric(result, "partition_length"), 0.7) << "it grows while items are found";
  EXPECT_GT(Metric(result, "transfers"), result.fitness) << "more than one per item";
  EXPECT_EQ(SumOfMetrics(worker::Run(PartitionSpec("task-partitioning", 1)), "partition_length_window_"),
            0.0);
}

// --- Traps ---

// A U that is open towards the source, `depth` m deep and `width` m wide inside, across the way to the nest.
sim::RunSpec BehindAU(const std::string& controller, double depth, double width, std::uint64_t seed) {
  sim::RunSpec spec = PartitionSpec(controller, seed);
  spec.scenario_parameters = {{"start_mode", 1.0}, {"time_limit", 900.0}};
  spec.controller_parameters["partition_length"] = 5.0;  // carries all the way
  constexpr double kBottom = 0.0;                        // y of its inner bottom
  spec.test_case.obstacles = {
      {0.0, kBottom - 0.1, width + 0.4, 0.2, 0.0},
      {-width / 2.0 - 0.1, kBottom + depth / 2.0, depth, 0.2, 90.0},
      {width / 2.0 + 0.1, kBottom + depth / 2.0, depth, 0.2, 90.0},
  };
  spec.test_case.robots = 1;
  spec.test_case.spawn_area = sim::Rectangle{{-0.3, 1.7}, {0.3, 2.3}};  // at the source
  return spec;
}

struct Escapes {
  int brought = 0;  // runs of ten with an item in the nest
  int trapped = 0;  // runs of ten that end in the trap with an item
};

Escapes TryTen(const std::string& controller, double depth, double width) {
  Escapes escapes;
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    const sim::RunResult result = worker::Run(BehindAU(controller, depth, width, seed));
    EXPECT_EQ(result.verdict, sim::Verdict::kCompleted) << result.message;
    EXPECT_GE(Metric(result, "food_taken"), 1.0) << seed;
    escapes.brought += result.fitness > 0.0 ? 1 : 0;
    escapes.trapped += Metric(result, "trapped_robots") > 0.0 && result.fitness == 0.0 ? 1 : 0;
  }
  return escapes;
}

TEST(PartitioningTraps, AConcaveTrapHoldsThePotentialFieldForEverAndLetsBugSGo) {
  const Escapes field = TryTen("task-partitioning", 0.15, 0.8);
  EXPECT_EQ(field.brought, 0);
  EXPECT_EQ(field.trapped, 10);
  const Escapes bug = TryTen("task-partitioning-improved", 0.15, 0.8);
  EXPECT_EQ(bug.brought, 10);
  EXPECT_EQ(bug.trapped, 0);
}

// BugS has no memory: when it rounds the U's arm, 0.165 m from its tip, and sees nothing within 0.345 m
// towards the light, it turns back into the U. So it gets out of what is less than 0.18 m deep.
TEST(PartitioningTraps, ADeeperUHoldsBugSToo) {
  const Escapes bug = TryTen("task-partitioning-improved", 0.4, 0.8);
  EXPECT_EQ(bug.brought, 0);
  EXPECT_EQ(bug.trapped, 10);
}

TEST(PartitioningTraps, TheTrappedRobotIsMarkedFromTheMomentItWas) {
  const sim::RunResult result = worker::Run(BehindAU("task-partitioning", 0.15, 0.8, 1));
  const auto mark = std::find_if(result.annotations.begin(), result.annotations.end(),
                                 [](const sim::Annotation& one) { return one.kind == "trapped"; });
  ASSERT_NE(mark, result.annotations.end());
  EXPECT_EQ(mark->label, "trapped with an item");
  EXPECT_GT(mark->tick, 20);
  EXPECT_LT(mark->tick, 1000) << "from when it drove into the trap, not only the last 120 s";
}

TEST(PartitioningTraps, TheMiddleOfTheSwarmIsTheTrapThatHoldsIt) {
  const sim::RunResult result = worker::Run(BehindAU("task-partitioning", 0.15, 0.8, 1));
  const sim::Vec2 end = result.robots.front().waypoints.back();
  EXPECT_NEAR(Metric(result, "median_x"), end.x(), 0.1);
  EXPECT_NEAR(Metric(result, "median_y"), end.y(), 0.1);
  EXPECT_LT(Metric(result, "spread_x"), Metric(result, "spread_y")) << "it came down the y axis";
  EXPECT_LT(Metric(result, "spread_y"), 0.5);
}

// --- Bad input ---

std::string MessageOfRefusal(const sim::RunSpec& spec) {
  const sim::RunResult result = worker::Run(spec);
  EXPECT_EQ(result.verdict, sim::Verdict::kRefused);
  return result.message;
}

TEST(PartitioningRefusals, APartitionLengthBeyondTheArenaIsNamed) {
  sim::RunSpec spec = PartitionSpec("task-partitioning", 1);
  spec.controller_parameters["partition_length"] = 7.5;
  EXPECT_EQ(MessageOfRefusal(spec), "partition-length: 7.5 m is longer than the arena, which is 5.9 m");
  spec.controller_parameters["partition_length"] = 5.9;
  EXPECT_EQ(worker::Run(spec).verdict, sim::Verdict::kCompleted);
  spec.controller_parameters["partition_length"] = 0.0;
  EXPECT_THAT(MessageOfRefusal(spec), StartsWith("parameter 'partition_length' = 0 m is out of range"));
  spec = PartitionSpec("task-partitioning-dynamic", 1);
  spec.controller_parameters["start_partition_length"] = 7.5;
  EXPECT_THAT(MessageOfRefusal(spec), StartsWith("partition-length: 7.5 m"));
}

TEST(PartitioningRefusals, LimitsOfALearntPartitionLengthThatContradictEachOtherAreNamed) {
  sim::RunSpec spec = PartitionSpec("task-partitioning-dynamic", 1);
  spec.controller_parameters = {{"most_partition_length", 1000.0}};
  EXPECT_THAT(MessageOfRefusal(spec), StartsWith("partition-length: 1000 m is longer than the arena"));
  spec.controller_parameters = {{"start_partition_length", 4.0}};
  EXPECT_THAT(MessageOfRefusal(spec), StartsWith("partition-length: it starts at 4 m"));
  spec.controller_parameters = {{"least_partition_length", 3.0}, {"most_partition_length", 1.0}};
  EXPECT_THAT(MessageOfRefusal(spec), StartsWith("partition-length: it starts at "));
}

TEST(PartitioningRefusals, AWaitingTimeBelowZeroIsOutOfRange) {
  sim::RunSpec spec = PartitionSpec("task-partitioning", 1);
  spec.controller_parameters["wait_time"] = -1.0;
  EXPECT_THAT(MessageOfRefusal(spec), StartsWith("parameter 'wait_time' = -1 s is out of range"));
  spec.controller_parameters["wait_time"] = 0.0;
  const sim::RunResult result = worker::Run(spec);
  EXPECT_EQ(result.verdict, sim::Verdict::kCompleted);
  EXPECT_EQ(Metric(result, "transfers"), 0.0) << "nobody waits: everybody carries all the way";
  EXPECT_EQ(Metric(result, "waits"), 0.0);
  EXPECT_GE(result.fitness, 1.0);
}

TEST(PartitioningRefusals, ALightOutsideTheArenaIsNamed) {
  sim::RunSpec spec = PartitionSpec("task-partitioning", 1);
  spec.scenario_parameters["light_offset_y"] = -1.5;
  EXPECT_THAT(MessageOfRefusal(spec), StartsWith("light-outside: the light is at (0, -3.5) m"));
  spec.scenario_parameters["light_offset_y"] = -0.5;
  EXPECT_EQ(worker::Run(spec).verdict, sim::Verdict::kCompleted);
}

TEST(PartitioningRefusals, AStartModeThatDoesNotFitIsNamed) {
  sim::RunSpec spec = PartitionSpec("task-partitioning", 1);
  spec.scenario_parameters["start_mode"] = 2.0;
  EXPECT_THAT(MessageOfRefusal(spec), StartsWith("parameter 'start_mode' = 2 is out of range"));
  spec.scenario_parameters["start_mode"] = 0.5;
  EXPECT_EQ(MessageOfRefusal(spec), "parameter 'start_mode' = 0.5 is not a whole number");
  spec.scenario_parameters["start_mode"] = 0.0;
  spec.test_case.spawn_area = sim::Rectangle{{1.0, -1.0}, {2.0, 0.0}};
  EXPECT_THAT(MessageOfRefusal(spec), StartsWith("start-mode: "));
  spec.test_case.spawn_area.reset();
  spec.test_case.obstacles = {{0.0, 0.0, 3.2, 2.2, 0.0}};  // covers the centre
  EXPECT_THAT(MessageOfRefusal(spec), StartsWith("no-room-to-spawn: "));
}

TEST(PartitioningRefusals, ASwarmThatDoesNotFitIsNamed) {
  sim::RunSpec spec = PartitionSpec("task-partitioning", 1);
  spec.test_case.robots = 101;
  EXPECT_THAT(MessageOfRefusal(spec), StartsWith("swarm-size: 101 robots"));
  spec.test_case.robots = 100;
  spec.scenario_parameters["spawn_radius"] = 0.2;
  EXPECT_THAT(MessageOfRefusal(spec), StartsWith("no-room-to-spawn: "));
}

TEST(PartitioningRefusals, ASourceInsideTheNestIsNamed) {
  sim::RunSpec spec = PartitionSpec("task-partitioning", 1);
  spec.scenario_parameters = {{"nest_food_distance", 1.5}, {"nest_radius", 1.6}};
  EXPECT_THAT(MessageOfRefusal(spec), StartsWith("nest-and-food: the source is 1.5 m"));
}

TEST(PartitioningRefusals, BlockedPlacesAreNamed) {
  sim::RunSpec spec = PartitionSpec("task-partitioning", 1);
  spec.test_case.obstacles = {{0.1, -2.1, 0.5, 0.3, 20.0}};
  EXPECT_THAT(MessageOfRefusal(spec), StartsWith("clearance: "));
  spec.test_case.obstacles = {{0.0, 0.0, 7.0, 0.2, 0.0}};
  EXPECT_THAT(MessageOfRefusal(spec), StartsWith("no-path: "));
}

// The light reaches every corner of an arena of any size.
TEST(PartitioningScenario, TheLightIsSeenEverywhereInALargerArena) {
  sim::RunSpec spec = PartitionSpec("task-partitioning", 1);
  spec.test_case.side_x = spec.test_case.side_y = 30.0;
  spec.scenario_parameters = {{"start_mode", 1.0}, {"time_limit", 20.0}};
  spec.test_case.spawn_area = sim::Rectangle{{13.0, 13.0}, {14.5, 14.5}};
  EXPECT_EQ(worker::Run(spec).verdict, sim::Verdict::kCompleted);
}

}  // namespace
}  // namespace gauntlet
