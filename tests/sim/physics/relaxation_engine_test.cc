// The hand-written engine, alone and as an oracle for the one that results are made with.

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "sim/geometry/trigonometry.h"
#include "sim/physics/physics_engine.h"
#include "tests/sim/physics/argos_scenes.h"
#include "tests/support/make_box.h"

namespace gauntlet::sim {
namespace {

TEST(RelaxationEngine, DrivesFreelyAsInArgos) {
  for (const ArgosScene& scene : ArgosScenes()) {
    if (!scene.free) continue;
    const Trajectory argos = ArgosTrajectory(scene);
    const Deviation deviation = Compare(argos, SimulateScene(scene, *MakeRelaxationEngine()), argos.size());
    EXPECT_LT(deviation.position, 1e-4) << scene.name;
    EXPECT_LT(deviation.heading, 1e-4) << scene.name;
  }
}

// Outcomes in which friction has no part.
TEST(RelaxationEngine, StopsAndPushesAsInArgos) {
  for (const char* name : {"wall_headon", "wall_headon5", "wall_corner", "headon_0", "headon_5v10",
                           "push_robot_0", "rear_end"}) {
    const ArgosScene& scene = FindArgosScene(name);
    const Trajectory argos = ArgosTrajectory(scene);
    const Trajectory ours = SimulateScene(scene, *MakeRelaxationEngine());
    for (std::size_t i = 0; i < argos[0].size(); ++i) {
      const Vec2 expected = FinalVelocity(argos, i, 20);
      EXPECT_LT((FinalVelocity(ours, i, 20) - expected).norm(), std::max(0.03 * expected.norm(), 2e-4))
          << name << ", body " << i;
    }
  }
}

RC_GTEST_PROP(RelaxationEngine, AgreesBitForBitWithTheOthersWhereNothingTouches, ()) {
  const std::unique_ptr<PhysicsEngine> engines[] = {MakeBox2dEngine(), MakeImpulseEngine(),
                                                    MakeRelaxationEngine()};
  const auto number = [](int limit) { return *rc::gen::inRange(-limit, limit + 1) * 1e-3; };
  for (const auto& engine : engines) engine->AddBox(MakeBox({0.0, -9.0}, 0.5, 0.5, 0.3));
  for (int i = 0; i < 3; ++i) {
    const Pose pose = {{3.0 * i, 0.0}, number(3141)};
    for (const auto& engine : engines) engine->AddRobot(pose);
  }
  for (int tick = 0; tick < 30; ++tick) {
    std::vector<WheelSpeeds> commands;
    for (int i = 0; i < 3; ++i) {
      const double left = number(200);
      const double right = number(200);
      commands.push_back({left, right});
    }
    for (const auto& engine : engines) engine->Step(commands);
    for (int i = 0; i < 3; ++i) {
      for (const auto& engine : engines) {
        RC_ASSERT(engine->PoseOf(i).position == engines[0]->PoseOf(i).position);
        RC_ASSERT(engine->PoseOf(i).heading == engines[0]->PoseOf(i).heading);
      }
    }
  }
}

TEST(RelaxationEngine, AKinematicBoxPushesAStandingRobotAhead) {
  const std::unique_ptr<PhysicsEngine> engine = MakeRelaxationEngine();
  const BoxIndex box = engine->AddKinematicBox(MakeBox({0.0, 0.0}, 0.2, 1.0, 0.0));
  engine->AddRobot({{0.3, 0.0}, 1.0});
  const std::vector<WheelSpeeds> rest(1);
  for (int tick = 1; tick <= 200; ++tick) {
    engine->MoveBox(box, {{0.005 * tick, 0.0}, 0.0});
    engine->Step(rest);
  }
  EXPECT_NEAR(engine->BoxAt(box).center.x(), 1.0, 1e-12);
  EXPECT_NEAR(Distance(engine->BoxAt(box), engine->PoseOf(0).position), foot_bot::kRadius, 0.005);
}

TEST(RelaxationEngine, ARobotInABoxComesOut) {
  const std::unique_ptr<PhysicsEngine> engine = MakeRelaxationEngine();
  const OrientedBox box = MakeBox({0.0, 0.0}, 1.0, 0.4, 0.5);
  engine->AddBox(box);
  engine->AddRobot({{0.1, 0.05}, 0.0});
  engine->Step(std::vector<WheelSpeeds>(1));
  EXPECT_NEAR(Distance(box, engine->PoseOf(0).position), foot_bot::kRadius, 1e-9);
}

}  // namespace
}  // namespace gauntlet::sim
