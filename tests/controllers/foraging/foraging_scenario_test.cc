#include "controllers/foraging/foraging_scenario.h"

#include <algorithm>
#include <string>
#include <string_view>

#include "controllers/foraging/foraging_registry.h"
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

sim::RunSpec Spec(const std::string& controller, std::uint64_t seed) {
  return testing_support::SpecOf("foraging", controller, seed);
}

sim::TestCase RandomCase(std::uint32_t index) {
  const auto parameters = controllers::ResolveParameters(controllers::ForagingScenarioInfo().parameters, {});
  sim::TestCase test_case;
  const auto requirements = controllers::ForagingScenarioInfo().requirements(*parameters, test_case);
  sim::RandomStream random(77, sim::StreamPurpose::kTest, index);
  testing_support::AddRandomBoxes(test_case, requirements, random, 500, 8);
  return test_case;
}

// Whatever the arena and the variant: every item that was taken is in the nest or in a gripper, once.
TEST(ForagingScenario, NoItemAppearsOrVanishesInRandomArenas) {
  double taken = 0.0;
  std::uint32_t index = 0;
  for (const controllers::ControllerInfo& controller : controllers::ForagingControllers()) {
    for (int i = 0; i < 4; ++i, ++index) {
      sim::RunSpec spec = Spec(std::string(controller.name), 100 + index);
      spec.test_case = RandomCase(index);
      const sim::RunResult result = worker::Run(spec);
      SCOPED_TRACE(std::string(controller.name) + ", case " + std::to_string(index));
      ASSERT_EQ(result.verdict, sim::Verdict::kCompleted) << result.message;
      EXPECT_EQ(result.ticks, 8000);
      EXPECT_EQ(Metric(result, "food_taken"),
                result.fitness + Metric(result, "food_carried") + Metric(result, "food_lost"));
      EXPECT_EQ(Metric(result, "food_lost"), 0.0);
      EXPECT_EQ(SumOfMetrics(result, "food_window_"), result.fitness);
      EXPECT_NEAR(SumOfMetrics(result, "mean_robots_"), 20.0, 1e-9);
      EXPECT_EQ(Metric(result, "condition_2"), result.fitness == 0.0 ? 1.0 : 0.0);
      EXPECT_EQ(Metric(result, "first_item_time") < 0.0, result.fitness == 0.0);
      EXPECT_LE(Metric(result, "food_taken"), 14.0) << "one item per 60 s";
      taken += Metric(result, "food_taken");
    }
  }
  EXPECT_GT(taken, 16.0);
}

// A pocket of 0.9 m with an opening of 0.35 m, out of sight of nest and food, and one robot in it: a U whose
// mouth is narrower than its inside (thesis 5.5.1, Figure 5.5).
sim::RunSpec InAPocket(const std::string& controller, std::uint64_t seed) {
  sim::RunSpec spec = Spec(controller, seed);
  spec.scenario_parameters["time_limit"] = 300.0;
  spec.controller_parameters["become_beacon_probability"] = 0.0;  // alone it would stop as a beacon
  spec.test_case.obstacles = {{1.5, 0.5, 1.1, 0.1, 0.0},
                              {1.5, -0.5, 1.1, 0.1, 0.0},
                              {1.0, 0.0, 0.9, 0.1, 90.0},
                              {2.0, 0.3125, 0.275, 0.1, 90.0},
                              {2.0, -0.3125, 0.275, 0.1, 90.0}};
  spec.test_case.robots = 1;
  spec.test_case.spawn_area = sim::Rectangle{{1.25, -0.25}, {1.75, 0.25}};
  return spec;
}

// Robots of ten that are in the pocket after 300 s, and have been for 120 s.
double TrappedInPocket(const std::string& controller) {
  double trapped = 0.0;
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    const sim::RunResult result = worker::Run(InAPocket(controller, seed));
    EXPECT_EQ(result.verdict, sim::Verdict::kCompleted) << result.message;
    trapped += Metric(result, "trapped_robots");
  }
  return trapped;
}

TEST(ForagingScenario, APocketTrapsARobotThatTurnsLeftAndLetsTheImprovedOneGo) {
  EXPECT_GE(TrappedInPocket("foraging"), 8.0);
  EXPECT_LE(TrappedInPocket("foraging-improved"), 2.0);
}

TEST(ForagingScenario, ARobotThatTurnsLeftGoesRoundTheSameLoopForEver) {
  sim::RunSpec spec = InAPocket("foraging", 1);
  spec.controller_parameters["wander_turn_probability"] = 0.0;
  spec.record_trajectory = true;
  const sim::RunResult result = worker::Run(spec);
  ASSERT_EQ(Metric(result, "trapped_robots"), 1.0);
  const auto& way = result.trajectory;
  const sim::Vec2 end = way.back()[0].position();
  const double back = [&] {  // how near it was to where it ends, 15 s to 120 s before
    double nearest = 1.0;
    for (std::size_t tick = way.size() - 1200; tick < way.size() - 150; ++tick) {
      nearest = std::min(nearest, (way[tick][0].position() - end).norm());
    }
    return nearest;
  }();
  EXPECT_LT(back, 0.05);
  const auto trapped = std::find_if(result.annotations.begin(), result.annotations.end(),
                                    [](const sim::Annotation& mark) { return mark.kind == "trapped"; });
  ASSERT_NE(trapped, result.annotations.end());
  EXPECT_EQ(trapped->robots, std::vector<sim::RobotIndex>{0});
  EXPECT_EQ(trapped->tick, 3000 - 1200);
}

TEST(ForagingScenario, TheTimeLineShowsEveryDrop) {
  const sim::RunResult result = worker::Run(Spec("foraging-basic", 4));
  ASSERT_GT(result.fitness, 0.0);
  double drops = 0.0;
  for (const sim::Annotation& line : result.annotations) {
    if (line.kind != "states") continue;
    EXPECT_EQ(line.label, "wandering,following,gathering,homing,f-homing,dropping,beacon");
    drops += static_cast<double>(std::count_if(line.points.begin(), line.points.end(),
                                               [](const sim::Vec2& change) { return change.y() == 5.0; }));
  }
  EXPECT_EQ(drops, result.fitness);
}

TEST(ForagingScenario, RobotsStartAroundTheNest) {
  const sim::RunResult result = worker::Run(Spec("foraging", 3));
  ASSERT_EQ(result.robots.size(), 20u);
  for (const sim::RobotSummary& robot : result.robots) {
    EXPECT_LE((robot.start.position - sim::Vec2(0.0, -2.0)).norm(), 0.8);
  }
}

TEST(ForagingScenario, SaysWhyItIsATotalFailure) {
  sim::RunSpec spec = Spec("foraging", 1);
  spec.scenario_parameters["time_limit"] = 5.0;
  const sim::RunResult early = worker::Run(spec);
  EXPECT_EQ(early.fitness, 0.0);
  EXPECT_TRUE(early.failure.total);
  EXPECT_EQ(early.failure.type, 3);
  EXPECT_EQ(early.failure.label, "no path, no food");
  spec.controller = "foraging-basic";
  const sim::RunResult basic = worker::Run(spec);
  EXPECT_EQ(basic.failure.type, 2) << "the basic algorithm builds no paths";
  EXPECT_EQ(Metric(basic, "condition_1"), 0.0);
}

TEST(ForagingScenario, ShowsNestAndFood) {
  const sim::RunResult result = worker::Run(Spec("foraging", 1));
  ASSERT_GE(result.annotations.size(), 2u);
  EXPECT_EQ(result.annotations[0].label, "nest");
  EXPECT_EQ(result.annotations[0].points[0], sim::Vec2(0.0, -2.0));
  EXPECT_EQ(result.annotations[1].label, "food");
  EXPECT_EQ(result.annotations[1].points[0], sim::Vec2(0.0, 2.0));
}

TEST(ForagingScenario, RunsAgainBitByBit) {
  const sim::RunSpec spec = [] {
    sim::RunSpec s = Spec("foraging-improved", 9);
    s.test_case = RandomCase(5);
    return s;
  }();
  EXPECT_EQ(worker::Run(spec).hash, worker::Run(spec).hash);
}

// --- Bad input ---

std::string RefusalOf(const sim::RunSpec& spec) {
  const sim::RunResult result = worker::Run(spec);
  EXPECT_EQ(result.verdict, sim::Verdict::kRefused);
  return result.message;
}

TEST(ForagingRefusals, ABlockedNestOrFoodIsNamed) {
  sim::RunSpec spec = Spec("foraging", 1);
  spec.test_case.obstacles = {{0.1, -2.1, 0.5, 0.3, 20.0}};
  EXPECT_THAT(RefusalOf(spec), StartsWith("clearance: "));
  spec.test_case.obstacles = {{0.0, 2.0, 0.5, 0.3, 20.0}};
  EXPECT_THAT(RefusalOf(spec), StartsWith("clearance: "));
  spec.scenario_parameters["clearance"] = 0.0;
  EXPECT_THAT(RefusalOf(spec), StartsWith("goal-blocked: "));
  spec.test_case.obstacles = {{0.0, -2.0, 0.5, 0.3, 20.0}};
  EXPECT_THAT(RefusalOf(spec), StartsWith("start-blocked: "));
  spec.test_case.obstacles = {{0.0, 0.0, 7.0, 0.2, 0.0}};
  EXPECT_THAT(RefusalOf(spec), StartsWith("no-path: "));
}

TEST(ForagingRefusals, PlacesOutsideTheArenaAreNamed) {
  sim::RunSpec spec = Spec("foraging", 1);
  spec.scenario_parameters["nest_food_distance"] = 8.0;
  EXPECT_THAT(RefusalOf(spec), StartsWith("start-blocked: "));
}

TEST(ForagingRefusals, CommunicationRangeOfZeroAndNegativeDecayAreOutOfRange) {
  sim::RunSpec spec = Spec("foraging", 1);
  spec.scenario_parameters["communication_range"] = 0.0;
  EXPECT_THAT(RefusalOf(spec), StartsWith("parameter 'communication_range' = 0 m is out of range"));
  spec.scenario_parameters["communication_range"] = -3.0;
  EXPECT_THAT(RefusalOf(spec), StartsWith("parameter 'communication_range' = -3 m is out of range"));
  spec = Spec("foraging", 1);
  spec.controller_parameters["pheromone_decay_time"] = -300.0;
  EXPECT_THAT(RefusalOf(spec), StartsWith("parameter 'pheromone_decay_time' = -300 s is out of range"));
}

TEST(ForagingRefusals, FoodInsideTheNestIsNamed) {
  sim::RunSpec spec = Spec("foraging", 1);
  spec.scenario_parameters = {{"nest_food_distance", 1.5}, {"nest_radius", 2.0}};
  EXPECT_THAT(RefusalOf(spec), StartsWith("nest-and-food: the food is 1.5 m from the nest's centre"));
}

TEST(ForagingRefusals, AFieldThatIsNoRepulsionIsNamed) {
  sim::RunSpec spec = Spec("foraging-improved", 1);
  spec.controller_parameters = {{"field_analytic", 1.0}, {"field_reach", 0.04}};
  EXPECT_EQ(RefusalOf(spec), "field-law: field_balance = 0.05 m must be below field_reach = 0.04 m");
  spec.controller_parameters["field_analytic"] = 0.0;
  EXPECT_EQ(worker::Run(spec).verdict, sim::Verdict::kCompleted);
}

TEST(ForagingRefusals, ASwarmThatDoesNotFitIsNamed) {
  sim::RunSpec spec = Spec("foraging", 1);
  spec.scenario_parameters = {{"robots", 100.0}, {"spawn_radius", 0.4}};
  EXPECT_THAT(RefusalOf(spec), StartsWith("no-room-to-spawn: "));
  spec.scenario_parameters["robots"] = 10.0;  // fit once the area has been enlarged a little
  EXPECT_EQ(worker::Run(spec).verdict, sim::Verdict::kCompleted);
  spec.test_case.robots = 101;
  EXPECT_THAT(RefusalOf(spec), StartsWith("swarm-size: 101 robots"));
}

TEST(ForagingRefusals, AnUnknownVariantIsNamedWithTheNearestKnownOne) {
  EXPECT_EQ(RefusalOf(Spec("foraging-improve", 1)),
            "unknown controller 'foraging-improve'; did you mean 'foraging-improved'?");
  EXPECT_THAT(RefusalOf(Spec("flocking", 1)),
              StartsWith("controller 'flocking' is written for the scenario"));
}

}  // namespace
}  // namespace gauntlet
