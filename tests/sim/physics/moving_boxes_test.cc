// Boxes that move, on a way of their own.
// Covers: sim/physics/way_back.cc

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

}  // namespace
}  // namespace gauntlet::sim
