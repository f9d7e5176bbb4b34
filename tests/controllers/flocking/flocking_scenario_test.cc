#include "controllers/flocking/flocking_scenario.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <string_view>
#include <vector>

#include "controllers/flocking/failure_classifier.h"
#include "gmock/gmock.h"
#include "gtest/gtest.h"
#include "sim/geometry/trigonometry.h"
#include "tests/controllers/run_support.h"
#include "worker/run_executor.h"

namespace gauntlet {
namespace {

using ::testing::Each;
using ::testing::StartsWith;
using testing_support::Metric;

sim::RunSpec Spec(const std::string& controller, std::uint64_t seed) {
  return testing_support::SpecOf("flocking", controller, seed);
}

const sim::Annotation* FindAnnotation(const sim::RunResult& result, std::string_view kind) {
  for (const sim::Annotation& annotation : result.annotations) {
    if (annotation.kind == kind) return &annotation;
  }
  return nullptr;
}

// A box that the birds cannot pass while the prey, told by Headquarters, walks around it.
sim::TestCase Trap() {
  sim::TestCase test_case;
  test_case.obstacles = {
      {0.4, 0.4, 2.0, 0.2, 135.0}, {1.2, -0.6, 1.4, 0.2, 45.0}, {-0.6, 1.2, 1.4, 0.2, 45.0}};
  return test_case;
}

class EmptyArena : public ::testing::TestWithParam<const char*> {};

// Thesis 4.3.1: in an empty environment the swarm reaches the goal without losing anyone. The full hundred
// seeds are the calibration's (controllers/flocking/README.md).
TEST_P(EmptyArena, LosesNoBird) {
  for (std::uint64_t seed = 1; seed <= 25; ++seed) {
    const sim::RunResult result = worker::Run(Spec(GetParam(), seed));
    ASSERT_EQ(result.verdict, sim::Verdict::kCompleted) << result.message;
    EXPECT_EQ(Metric(result, "birds_left"), 10.0) << "seed " << seed;
    EXPECT_EQ(Metric(result, "timeout"), 0.0);
    EXPECT_FALSE(result.failure.total);
    EXPECT_GT(result.fitness, 0.75);
    for (const sim::RobotSummary& robot : result.robots) EXPECT_FALSE(robot.lost);
  }
}

INSTANTIATE_TEST_SUITE_P(Birds, EmptyArena, ::testing::Values("flocking", "flocking-improved"),
                         [](const auto& tested) {
                           return std::string(tested.param) == "flocking" ? "Original" : "Improved";
                         });

TEST(FlockingScenario, StartsTenBirdsInTheCornerAndThePreyLast) {
  sim::RunSpec spec = Spec("flocking", 3);
  spec.scenario_parameters["time_limit"] = 1.0;
  spec.record_trajectory = true;
  const sim::RunResult result = worker::Run(spec);
  ASSERT_EQ(result.robots.size(), 11u);
  for (std::size_t bird = 0; bird < 10; ++bird) {
    const sim::Vec2& p = result.robots[bird].start.position;
    EXPECT_GE(std::min(p.x(), p.y()), 2.0);
    EXPECT_LE(std::max(p.x(), p.y()), 2.95 - sim::foot_bot::kRadius);
  }
  EXPECT_EQ(result.robots[10].start.position, sim::Vec2(2.5, 2.5));
  EXPECT_NEAR(result.robots[10].start.heading, -0.75 * sim::kPi, 1e-12);
  EXPECT_EQ(result.ticks, 10);
}

TEST(FlockingScenario, EndsWhenThePreyReachesTheGoal) {
  const sim::RunResult result = worker::Run(Spec("flocking", 1));
  EXPECT_LE((result.robots[10].end.position - sim::Vec2(-2.5, -2.5)).norm(), 0.15);
  EXPECT_NEAR(Metric(result, "arrival_time"), result.ticks * 0.1, 1e-9);
  EXPECT_NEAR(Metric(result, "prey_path_length"), std::sqrt(50.0), 1e-9);
  // 6.9 m at 0.05 m/s.
  EXPECT_NEAR(Metric(result, "arrival_time"), 139.0, 8.0);
}

TEST(FlockingScenario, JudgesTheSwarmWhenTheTimeIsUp) {
  sim::RunSpec spec = Spec("flocking", 1);
  spec.scenario_parameters["time_limit"] = 30.0;
  const sim::RunResult result = worker::Run(spec);
  EXPECT_EQ(result.ticks, 300);
  EXPECT_EQ(Metric(result, "timeout"), 1.0);
  EXPECT_EQ(Metric(result, "birds_left"), 10.0);
  EXPECT_GT(result.fitness, 0.5);
}

TEST(FlockingScenario, FitnessFollowsFromItsMetrics) {
  for (std::uint64_t seed = 1; seed <= 6; ++seed) {
    sim::RunSpec spec = Spec("flocking", seed);
    spec.test_case = Trap();
    const sim::RunResult result = worker::Run(spec);
    ASSERT_EQ(result.verdict, sim::Verdict::kCompleted) << result.message;
    const double left = Metric(result, "birds_left");
    EXPECT_EQ(result.failure.total, left < 5);
    EXPECT_DOUBLE_EQ(result.fitness, left < 5 ? 0.0 : (1.0 + Metric(result, "angular_order")) * left / 20.0);
    EXPECT_DOUBLE_EQ(Metric(result, "proportion_left"), left / 10.0);
    const auto lost = std::count_if(result.robots.begin(), result.robots.end(),
                                    [](const sim::RobotSummary& robot) { return robot.lost; });
    EXPECT_EQ(static_cast<double>(lost), 10.0 - left);
  }
}

TEST(FlockingScenario, ExplainsATotalFailureByItsLastSplit) {
  int total_failures = 0;
  for (std::uint64_t seed = 1; seed <= 6; ++seed) {
    sim::RunSpec spec = Spec("flocking", seed);
    spec.test_case = Trap();
    const sim::RunResult result = worker::Run(spec);
    if (!result.failure.total) continue;
    ++total_failures;
    EXPECT_EQ(result.fitness, 0.0);
    ASSERT_GE(result.failure.type, 0);
    EXPECT_EQ(result.failure.label, controllers::FailureLabel(result.failure.type));
    const sim::Annotation* split = FindAnnotation(result, "split");
    ASSERT_NE(split, nullptr);
    EXPECT_EQ(split->label, result.failure.label);
    EXPECT_GE(split->tick, 0);
    EXPECT_LE(split->tick, result.ticks);
    EXPECT_FALSE(split->robots.empty());
    EXPECT_NEAR(Metric(result, "split_time"), split->tick * 0.1, 1e-9);
    EXPECT_EQ(Metric(result, "split_x"), split->points.front().x());
    EXPECT_EQ(Metric(result, "split_y"), split->points.front().y());
    EXPECT_GE(Metric(result, "splits"), 1.0);
  }
  EXPECT_GE(total_failures, 1) << "the trap catches nobody";
}

TEST(FlockingScenario, ShowsThePathOfThePreyAndTheGoal) {
  sim::RunSpec spec = Spec("flocking", 1);
  spec.test_case = Trap();
  spec.scenario_parameters["time_limit"] = 1.0;
  const sim::RunResult result = worker::Run(spec);
  const sim::Annotation* path = FindAnnotation(result, "path");
  ASSERT_NE(path, nullptr);
  EXPECT_GT(path->points.size(), 2u);
  EXPECT_EQ(path->points.front(), sim::Vec2(2.5, 2.5));
  EXPECT_EQ(path->points.back(), sim::Vec2(-2.5, -2.5));
  const sim::Annotation* goal = FindAnnotation(result, "disc");
  ASSERT_NE(goal, nullptr);
  EXPECT_EQ(goal->points.front(), sim::Vec2(-2.5, -2.5));
  EXPECT_EQ(goal->radius, 0.15);
}

TEST(FlockingScenario, TakesTheSwarmAndItsPlaceFromTheTestCase) {
  sim::RunSpec spec = Spec("flocking", 1);
  spec.test_case.robots = 6;
  spec.test_case.spawn_area = sim::Rectangle{{1.0, 1.0}, {1.6, 1.6}};
  spec.scenario_parameters["time_limit"] = 1.0;
  const sim::RunResult result = worker::Run(spec);
  ASSERT_EQ(result.robots.size(), 7u);
  for (std::size_t bird = 0; bird < 6; ++bird) {
    const sim::Vec2& p = result.robots[bird].start.position;
    EXPECT_GE(std::min(p.x(), p.y()), 1.0);
    EXPECT_LE(std::max(p.x(), p.y()), 1.6);
  }
  EXPECT_EQ(Metric(result, "proportion_left"), 1.0);
}

TEST(FlockingScenario, RefusesASwarmThatIsTooSmallOrTooLarge) {
  sim::RunSpec spec = Spec("flocking", 1);
  spec.test_case.robots = 4;
  sim::RunResult result = worker::Run(spec);
  EXPECT_EQ(result.verdict, sim::Verdict::kRefused);
  EXPECT_THAT(result.message, StartsWith("swarm-size: 4 birds"));
  spec.test_case.robots = 101;
  result = worker::Run(spec);
  EXPECT_EQ(result.verdict, sim::Verdict::kRefused);
  EXPECT_THAT(result.message, StartsWith("swarm-size: 101 birds"));
}

TEST(FlockingScenario, RefusesAStartThatIsFullOfObstacles) {
  sim::RunSpec spec = Spec("flocking", 1);
  spec.scenario_parameters["birds"] = 100;
  const sim::RunResult result = worker::Run(spec);
  EXPECT_EQ(result.verdict, sim::Verdict::kRefused);
  EXPECT_THAT(result.message, StartsWith("no-room-to-spawn: "));
}

TEST(FlockingScenario, ScalesStartAndGoalWithTheArena) {
  sim::RunSpec spec = Spec("flocking", 1);
  spec.test_case.side_x = 4.0;
  spec.test_case.side_y = 5.0;
  const sim::RunResult result = worker::Run(spec);
  ASSERT_EQ(result.verdict, sim::Verdict::kCompleted) << result.message;
  EXPECT_EQ(result.robots[10].start.position, sim::Vec2(1.5, 2.0));
  EXPECT_LE((result.robots[10].end.position - sim::Vec2(-1.5, -2.0)).norm(), 0.15);
}

TEST(FlockingScenario, TheMinimumSwarmDecidesWhatATotalFailureIs) {
  sim::RunSpec spec = Spec("flocking", 1);
  spec.test_case = Trap();
  spec.scenario_parameters["min_swarm"] = 1;
  const sim::RunResult lenient = worker::Run(spec);
  spec.scenario_parameters["min_swarm"] = 10;
  const sim::RunResult strict = worker::Run(spec);
  EXPECT_EQ(lenient.trajectory_hash, strict.trajectory_hash);
  EXPECT_EQ(strict.failure.total, Metric(strict, "birds_left") < 10.0);
  EXPECT_LE(strict.fitness, lenient.fitness);
}

}  // namespace
}  // namespace gauntlet
