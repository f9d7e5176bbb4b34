#include "controllers/coverage/coverage_controller.h"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <vector>

#include "controllers/coverage/coverage_registry.h"
#include "controllers/coverage/coverage_scenario.h"
#include "controllers/registry.h"
#include "sim/geometry/trigonometry.h"

namespace gauntlet::controllers::coverage {
namespace {

constexpr CoverageSettings kSettings = {.neighbour_range = 1.5, .obstacle_push = 3.0};

sim::Vec2 ForceOf(const std::vector<sim::Message>& messages) {
  sim::SensorReadings readings;
  readings.range_and_bearing = messages;
  return FieldForce(readings, kSettings);
}

TEST(FieldForce, PushesAwayFromANeighbourAlongTheLineBetweenBoth) {
  const sim::Vec2 force = ForceOf({sim::Message::At(0.5, 1.0, {})});
  EXPECT_NEAR(force.norm(), 1.0 / 0.25 - 1.0 / 2.25, 1e-12);
  EXPECT_NEAR(sim::AngleOf(-force), 1.0, 1e-12);
}

TEST(FieldForce, EndsAtTheRangeAndIsTheSumOverNeighbours) {
  EXPECT_TRUE(ForceOf({sim::Message::At(1.5, 1.0, {})}).isZero(0.0));
  EXPECT_LT(ForceOf({sim::Message::At(1.4999, 1.0, {})}).norm(), 1e-3) << "continuous there";
  EXPECT_TRUE(
      ForceOf({sim::Message::At(0.5, 1.0, {}), sim::Message::At(0.5, 1.0 - sim::kPi, {})}).isZero(1e-12));
  EXPECT_TRUE(ForceOf({sim::Message::At(0.0, 0.0, {})}).allFinite());
}

TEST(FieldForce, PushesAwayFromAnObstacle) {
  sim::SensorReadings readings;
  readings.proximity[5] = 0.5;  // 82.5 degrees
  const sim::Vec2 force = FieldForce(readings, kSettings);
  EXPECT_NEAR(force.norm(), 1.5, 1e-12);
  EXPECT_NEAR(sim::AngleOf(-force), 82.5 * sim::kDegree, 1e-12);
}

std::unique_ptr<sim::Controller> Robot(std::size_t row) {
  const ControllerInfo& info = CoverageControllers()[row];
  return info.make(*ResolveParameters(info.parameters, {})).create({});
}

sim::Actuators Step(sim::Controller& robot, const std::vector<sim::Message>& messages,
                    std::uint32_t tick = 0) {
  sim::SensorReadings readings;
  readings.range_and_bearing = messages;
  sim::Actuators actuators;
  sim::RandomStream random(1, sim::StreamPurpose::kController, 0, tick);
  robot.Step({.tick = 0, .readings = readings, .actuators = actuators, .random = random});
  return actuators;
}

TEST(CoverageController, StandsAndSaysSoWhenNobodyIsNear) {
  const sim::Actuators actuators = Step(*Robot(0), {sim::Message::At(1.6, 0.0, {})});
  EXPECT_EQ(actuators.left_wheel, 0.0);
  EXPECT_EQ(actuators.right_wheel, 0.0);
  EXPECT_EQ(actuators.message, kStandingMessage);
}

TEST(CoverageController, WalksWhenNobodyIsNearIfItIsTheImprovedOne) {
  const auto robot = Robot(1);
  bool turned = false;
  for (std::uint32_t tick = 0; tick < 1000; ++tick) {
    const sim::Actuators actuators = Step(*robot, {}, tick);
    ASSERT_GT(std::abs(actuators.left_wheel) + std::abs(actuators.right_wheel), 0.05);
    ASSERT_NE(actuators.message, kStandingMessage);
    turned = turned || actuators.left_wheel != actuators.right_wheel;
  }
  EXPECT_TRUE(turned);
}

TEST(CoverageController, DrivesAwayAtASpeedThatGrowsWithTheForceUpToTheLargest) {
  const sim::Actuators slow = Step(*Robot(0), {sim::Message::At(1.0, sim::kPi, {})});
  EXPECT_NEAR(slow.left_wheel, 0.05 * (1.0 - 1.0 / 2.25), 1e-12);
  EXPECT_EQ(slow.left_wheel, slow.right_wheel);
  EXPECT_NE(slow.message, kStandingMessage);
  EXPECT_DOUBLE_EQ(Step(*Robot(0), {sim::Message::At(0.2, sim::kPi, {})}).left_wheel, 0.1);
  const sim::Actuators turn = Step(*Robot(0), {sim::Message::At(0.2, -0.1, {})});
  EXPECT_DOUBLE_EQ(turn.left_wheel, -0.1) << "to the left on the spot";
  EXPECT_DOUBLE_EQ(turn.right_wheel, 0.1);
}

}  // namespace
}  // namespace gauntlet::controllers::coverage
