// Covers: controllers/generic/items.cc
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "controllers/generic/generic_registry.h"
#include "controllers/registry.h"
#include "sim/geometry/trigonometry.h"
#include "tests/controllers/run_support.h"
#include "worker/run_executor.h"

namespace gauntlet::controllers::generic {
namespace {

using testing::StartsWith;
using testing_support::Metric;

// Four robots that flock towards a lamp, for half a minute.
sim::RunSpec Gathering() {
  sim::RunSpec spec = testing_support::SpecOf("generic", "light-flocking", 1);
  spec.scenario_parameters = {{"robots", 4}, {"time_limit", 30}, {"goal_x", -2}, {"goal_radius", 1}};
  spec.definition =
      "fitness = largest_cluster / robots\nfailure = robots_in_goal < 0.5 * robots\nlight.1.x = -2\n";
  return spec;
}

TEST(GenericScenario, JudgesByItsFormulasAndReportsEveryMeasure) {
  const sim::RunResult result = worker::Run(Gathering());
  ASSERT_EQ(result.verdict, sim::Verdict::kCompleted) << result.message;
  EXPECT_EQ(result.fitness, Metric(result, "largest_cluster") / 4.0);
  EXPECT_EQ(result.failure.total, Metric(result, "robots_in_goal") < 2.0);
  EXPECT_EQ(result.robots.size(), 4U);
  EXPECT_EQ(result.ticks, 300);
  ASSERT_EQ(result.metrics.size(), Metrics().size());
  for (std::size_t i = 0; i < result.metrics.size(); ++i)
    EXPECT_EQ(result.metrics[i].first, Metrics()[i].name);
}

TEST(GenericScenario, DrawsRobotsToItsLight) {
  sim::RunSpec spec = Gathering();
  spec.scenario_parameters["time_limit"] = 120;
  const double with_light = Metric(worker::Run(spec), "goal_distance");
  spec.definition = "fitness = 1\nfailure = 0\n";
  EXPECT_LT(with_light, Metric(worker::Run(spec), "goal_distance") - 0.5);
}

TEST(GenericScenario, StartsWhereAndHowItIsTold) {
  sim::RunSpec spec = Gathering();
  spec.scenario_parameters.insert(
      {{"spawn_x", 1.5}, {"spawn_y", -1}, {"spawn_length", 1}, {"spawn_width", 2}});
  spec.scenario_parameters["heading"] = 3.0;
  spec.scenario_parameters["heading_spread"] = 0.25;
  for (const sim::RobotSummary& robot : worker::Run(spec).robots) {
    EXPECT_NEAR(robot.start.position.x(), 1.5, 0.5);
    EXPECT_NEAR(robot.start.position.y(), -1.0, 1.0);
    EXPECT_LE(std::abs(sim::WrapAngle(robot.start.heading - 3.0)), 0.25);
  }
}

TEST(GenericScenario, SaysWhenSomethingWasReachedAndMayEndThere) {
  sim::RunSpec spec = Gathering();
  spec.definition += "reached = time >= 12\n";
  const sim::RunResult whole = worker::Run(spec);
  EXPECT_EQ(Metric(whole, "reached_time"), 12.0);
  EXPECT_EQ(whole.ticks, 300);
  spec.scenario_parameters["end_when_reached"] = 1;
  EXPECT_EQ(worker::Run(spec).ticks, 120);
}

TEST(GenericScenario, GivesNoResultThatAFormulaCannotSay) {
  sim::RunSpec spec = Gathering();
  spec.definition = "fitness = 1 / items_brought\nfailure = 0\n";
  const sim::RunResult result = worker::Run(spec);
  EXPECT_EQ(result.verdict, sim::Verdict::kInvalidCommand);
  EXPECT_EQ(result.message,
            "invalid-outcome: tick 300: fitness = \"1 / items_brought\": it divides 1 by 0, with "
            "items_brought = 0");
  spec.definition = "fitness = 1\nfailure = 0\nreached = 1 / items_brought\n";
  EXPECT_EQ(
      worker::Run(spec).message,
      "invalid-outcome: tick 10: reached = \"1 / items_brought\": it divides 1 by 0, with items_brought = 0");
}

// Robots of foraging go to a green lamp, close their grippers near it and open them on black floor.
TEST(GenericScenario, CountsItemsOfRobotsWithGrippers) {
  sim::RunSpec spec = testing_support::SpecOf("generic", "foraging", 3);
  spec.scenario_parameters = {{"time_limit", 600}, {"spawn_y", -1}};
  spec.definition =
      "fitness = items_brought\nfailure = items_brought == 0\n"
      "light.1.y = 1\nlight.1.height = 0.17\nlight.1.intensity = 0\nlight.1.color = green\n"
      "source.1.y = 1\nsource.1.radius = 0.4\nsource.1.grey = 1\n"
      "nest.1.y = -1\nnest.1.radius = 0.5\nnest.1.grey = 0\n";
  const sim::RunResult result = worker::Run(spec);
  ASSERT_EQ(result.verdict, sim::Verdict::kCompleted) << result.message;
  EXPECT_GE(Metric(result, "items_brought"), 1.0);
  EXPECT_LE(Metric(result, "items_brought"), Metric(result, "items_taken"));
  EXPECT_EQ(result.fitness, Metric(result, "items_brought"));
  EXPECT_FALSE(result.failure.total);
}

// They have none: being there is enough.
TEST(GenericScenario, CountsItemsOfRobotsWithoutGrippers) {
  sim::RunSpec spec = Gathering();
  spec.definition += "source.1.radius = 2\nnest.1.x = 0\nnest.1.length = 5\nnest.1.width = 5\n";
  const sim::RunResult result = worker::Run(spec);
  EXPECT_GE(Metric(result, "items_taken"), 4.0);
  EXPECT_GE(Metric(result, "items_brought"), 4.0);
  EXPECT_EQ(Metric(result, "first_item_time"), 0.2);
}

TEST(GenericScenario, RunsEveryControllerThereIs) {
  for (const ControllerInfo& controller : Controllers()) {
    sim::RunSpec spec = Gathering();
    spec.controller = controller.name;
    spec.scenario_parameters["time_limit"] = 5;
    const sim::RunResult result = worker::Run(spec);
    EXPECT_EQ(result.verdict, sim::Verdict::kCompleted) << controller.name << ": " << result.message;
  }
}

TEST(GenericScenario, RefusesWhatDoesNotFitIntoTheArena) {
  sim::RunSpec spec = Gathering();
  spec.definition += "light.2.y = 3\n";
  EXPECT_EQ(
      worker::Run(spec).message,
      "outside-arena: light.2 at (0, 3) m is outside the walls, whose inner faces are at (-2.95, -2.95) "
      "and (2.95, 2.95) m");
  spec = Gathering();
  spec.scenario_parameters.insert({{"spawn_length", 0.2}, {"spawn_width", 0.2}});
  spec.scenario_parameters["robots"] = 100;
  EXPECT_THAT(worker::Run(spec).message, StartsWith("no-room-to-spawn: only "));
  spec = Gathering();
  spec.test_case.robots = 101;
  EXPECT_THAT(worker::Run(spec).message, StartsWith("swarm-size: 101 robots"));
  spec = Gathering();
  spec.definition = "fitness = 1\n";
  EXPECT_EQ(worker::Run(spec).message,
            "[generic] failure is missing: a formula such as \"largest_cluster < 0.5 * robots\"");
}

}  // namespace
}  // namespace gauntlet::controllers::generic
