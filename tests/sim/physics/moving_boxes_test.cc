// Boxes that move: pushed by robots, or on a way of their own.

#include <gtest/gtest.h>

#include <vector>

#include "sim/geometry/trigonometry.h"
#include "sim/physics/physics_engine.h"
#include "tests/support/make_box.h"

namespace gauntlet::sim {
namespace {

class KinematicBoxes : public testing::TestWithParam<std::unique_ptr<PhysicsEngine> (*)()> {};

INSTANTIATE_TEST_SUITE_P(Engines, KinematicBoxes, testing::Values(MakeBox2dEngine, MakeImpulseEngine));

TEST_P(KinematicBoxes, AKinematicBoxGoesExactlyWhereItIsSent) {
  const std::unique_ptr<PhysicsEngine> engine = GetParam()();
  const BoxIndex box = engine->AddKinematicBox(MakeBox({0.0, 0.0}, 0.4, 0.2, 0.0));
  engine->AddRobot({{3.0, 0.0}, 0.0});
  const std::vector<WheelSpeeds> rest(1);
  for (int tick = 1; tick <= 100; ++tick) {
    engine->MoveBox(box, {{0.01 * tick, -0.005 * tick}, WrapAngle(0.05 * tick)});
    engine->Step(rest);
    ASSERT_LT((engine->BoxAt(box).center - Vec2(0.01 * tick, -0.005 * tick)).norm(), 1e-12);
    ASSERT_LT((engine->BoxAt(box).axis - UnitVector(WrapAngle(0.05 * tick))).norm(), 1e-12);
  }
  engine->Step(rest);  // not sent on: it rests
  EXPECT_LT((engine->BoxAt(box).center - Vec2(1.0, -0.5)).norm(), 1e-12);
}

TEST_P(KinematicBoxes, AKinematicBoxPushesAStandingRobotAhead) {
  const std::unique_ptr<PhysicsEngine> engine = GetParam()();
  const BoxIndex box = engine->AddKinematicBox(MakeBox({0.0, 0.0}, 0.2, 1.0, 0.0));
  engine->AddRobot({{0.3, 0.0}, 1.0});
  const std::vector<WheelSpeeds> rest(1);
  for (int tick = 1; tick <= 200; ++tick) {
    engine->MoveBox(box, {{0.005 * tick, 0.0}, 0.0});
    engine->Step(rest);
  }
  const double overlap = foot_bot::kRadius - Distance(engine->BoxAt(box), engine->PoseOf(0).position);
  EXPECT_LT(overlap, 0.002);
  EXPECT_GT(overlap, -0.010);
  EXPECT_NEAR(engine->PoseOf(0).heading, 1.0, 1e-12);
}

TEST_P(KinematicBoxes, ARobotAgainstAKinematicBoxThatComesTowardsItIsCarriedBack) {
  const std::unique_ptr<PhysicsEngine> engine = GetParam()();
  const BoxIndex box = engine->AddKinematicBox(MakeBox({1.0, 0.0}, 0.2, 1.0, 0.0));
  engine->AddRobot({{0.0, 0.0}, 0.0});
  const std::vector<WheelSpeeds> ahead = {{0.1, 0.1}};
  for (int tick = 1; tick <= 200; ++tick) {
    engine->MoveBox(box, {{1.0 - 0.005 * tick, 0.0}, 0.0});
    engine->Step(ahead);
  }
  EXPECT_LT(foot_bot::kRadius - Distance(engine->BoxAt(box), engine->PoseOf(0).position), 0.004);
  EXPECT_LT(engine->PoseOf(0).position.x(), 0.0);
}

TEST(MovingBoxes, APushedBoxStopsAtAWallAndStopsItsRobot) {
  const std::unique_ptr<PhysicsEngine> engine = MakeBox2dEngine();
  engine->AddBox(MakeBox({1.1, 0.0}, 0.2, 2.0, 0.0));
  const BoxIndex box = engine->AddMovableBox(MakeBox({0.5, 0.0}, 0.2, 0.2, 0.0), movable_box::kMass);
  engine->AddRobot({{0.0, 0.0}, 0.0});
  const std::vector<WheelSpeeds> ahead = {{0.1, 0.1}};
  for (int tick = 0; tick < 300; ++tick) engine->Step(ahead);
  EXPECT_NEAR(engine->BoxAt(box).center.x(), 0.9, 0.002);
  EXPECT_NEAR(engine->PoseOf(0).position.x(), 0.8 - foot_bot::kRadius, 0.004);
}

TEST(MovingBoxes, ABoxStaysWhereItsRobotLeavesIt) {
  const std::unique_ptr<PhysicsEngine> engine = MakeBox2dEngine();
  const BoxIndex box = engine->AddMovableBox(MakeBox({0.3, 0.0}, 0.2, 0.2, 0.0), movable_box::kMass);
  engine->AddRobot({{0.0, 0.0}, 0.0});
  for (int tick = 0; tick < 50; ++tick) engine->Step(std::vector<WheelSpeeds>{{0.1, 0.1}});
  for (int tick = 0; tick < 5; ++tick) engine->Step(std::vector<WheelSpeeds>{{-0.1, -0.1}});
  const Vec2 left = engine->BoxAt(box).center;
  EXPECT_GT(left.x(), 0.5);
  for (int tick = 0; tick < 50; ++tick) engine->Step(std::vector<WheelSpeeds>{{-0.1, -0.1}});
  EXPECT_EQ(engine->BoxAt(box).center, left);
}

}  // namespace
}  // namespace gauntlet::sim
