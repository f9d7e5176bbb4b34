// What holds of both engines that model contacts.
// Covers: sim/physics/box2d_engine.cc, sim/physics/contact_island.cc

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include "sim/geometry/trigonometry.h"
#include "sim/physics/differential_drive.h"
#include "sim/physics/physics_engine.h"
#include "tests/support/make_box.h"

namespace gauntlet::sim {
namespace {

// Free motion by the drive model alone.
Pose DriveFree(Pose pose, const WheelSpeeds& command, int ticks) {
  DriveState state;
  for (int tick = 0; tick < ticks; ++tick) {
    const DriveMotion motion = Drive(state, command, UnitVector(pose.heading));
    pose.position += motion.halves[0] + motion.halves[1];
    pose.heading = WrapAngle(pose.heading + motion.turn);
    state = motion.end;
  }
  return pose;
}

struct Engine {
  const char* name;
  std::unique_ptr<PhysicsEngine> (*make)();
};

class ContactEngine : public testing::TestWithParam<Engine> {};

INSTANTIATE_TEST_SUITE_P(All, ContactEngine,
                         testing::Values(Engine{"Box2d", MakeBox2dEngine},
                                         Engine{"Impulse", MakeImpulseEngine}),
                         [](const auto& engine) { return std::string(engine.param.name); });

TEST_P(ContactEngine, DoesNotDisturbRobotsThatPassCloselyWithoutTouching) {
  const std::unique_ptr<PhysicsEngine> engine = GetParam().make();
  // 1 mm beside a wall and 1 mm beside another robot that keeps up: in the solver all the time.
  const double wall = foot_bot::kRadius + 0.001;
  engine->AddBox(MakeBox({0.0, -0.1}, 6.0, 0.2, 0.0));
  const Pose first = {{-2.5, wall}, 0.0};
  const Pose second = {{-2.5, wall + 2 * foot_bot::kRadius + 0.001}, 0.0};
  engine->AddRobot(first);
  engine->AddRobot(second);
  const std::vector<WheelSpeeds> commands = {{0.1, 0.1}, {0.1, 0.1}};
  for (int tick = 0; tick < 400; ++tick) engine->Step(commands);
  EXPECT_LT((engine->PoseOf(0).position - DriveFree(first, commands[0], 400).position).norm(), 1e-12);
  EXPECT_LT((engine->PoseOf(1).position - DriveFree(second, commands[1], 400).position).norm(), 1e-12);
}

TEST_P(ContactEngine, WrapsHeadings) {
  const std::unique_ptr<PhysicsEngine> engine = GetParam().make();
  engine->AddRobot({{0.0, 0.0}, 3.0});
  const std::vector<WheelSpeeds> commands = {{-0.1, 0.1}};
  for (int tick = 0; tick < 1000; ++tick) {
    engine->Step(commands);
    ASSERT_GT(engine->PoseOf(0).heading, -kPi);
    ASSERT_LE(engine->PoseOf(0).heading, kPi);
  }
  const double expected = 3.0 + 1000 * 0.1 * 0.2 / 0.14 - 0.01 * 0.2 / 0.14;
  EXPECT_NEAR(WrapAngle(engine->PoseOf(0).heading - expected), 0.0, 1e-9);
}

TEST_P(ContactEngine, StartsAfreshAfterAContact) {
  const std::unique_ptr<PhysicsEngine> engine = GetParam().make();
  engine->AddBox(MakeBox({0.3, 0.0}, 0.2, 2.0, 0.0));
  engine->AddRobot({{0.0, 0.0}, 0.0});
  for (int tick = 0; tick < 50; ++tick) engine->Step(std::vector<WheelSpeeds>{{0.1, 0.1}});
  const double blocked = engine->PoseOf(0).position.x();
  EXPECT_NEAR(blocked, 0.2 - foot_bot::kRadius, 0.001);
  // Backing off begins from rest, with the force of the motor, and leaves the wall at once.
  engine->Step(std::vector<WheelSpeeds>{{-0.1, -0.1}});
  EXPECT_NEAR(blocked - engine->PoseOf(0).position.x(), 0.008892857, 5e-4);
  for (int tick = 0; tick < 10; ++tick) engine->Step(std::vector<WheelSpeeds>{{-0.1, -0.1}});
  EXPECT_NEAR(blocked - engine->PoseOf(0).position.x(), 0.108892857, 5e-4);
}

// A crowd that pushes to one point from all sides stays apart.
TEST_P(ContactEngine, RobotsInACrowdHardlyOverlap) {
  const std::unique_ptr<PhysicsEngine> engine = GetParam().make();
  constexpr int kRobots = 20;
  for (int i = 0; i < kRobots; ++i) {
    const double angle = WrapAngle(2.4 * i);
    engine->AddRobot({(0.3 + 0.08 * i) * UnitVector(angle), WrapAngle(angle + kPi)});
  }
  std::vector<WheelSpeeds> commands(kRobots);
  double deepest = 0.0;
  for (int tick = 0; tick < 2000; ++tick) {
    for (int i = 0; i < kRobots; ++i) {
      const Pose pose = engine->PoseOf(i);
      const double bearing = WrapAngle(AngleOf(-pose.position) - pose.heading);
      const double turn = bearing > 0.2 ? 0.05 : bearing < -0.2 ? -0.05 : 0.0;
      commands[static_cast<std::size_t>(i)] = {0.1 - turn, 0.1 + turn};
    }
    engine->Step(commands);
    for (int i = 0; i < kRobots; ++i) {
      for (int j = 0; j < i; ++j) {
        const double gap =
            (engine->PoseOf(i).position - engine->PoseOf(j).position).norm() - 2 * foot_bot::kRadius;
        deepest = std::max(deepest, -gap);
      }
    }
  }
  std::printf("deepest overlap in a crowd of %d: %.2f mm\n", kRobots, 1e3 * deepest);
  EXPECT_LT(deepest, 0.010);
}

}  // namespace
}  // namespace gauntlet::sim
