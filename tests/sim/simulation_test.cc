#include "sim/simulation.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

#include "base/number_text.h"
#include "tests/support/toy_scenario.h"

namespace gauntlet::sim {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::StartsWith;

Behaviour DriveStraight(double speed) {
  return [speed](const ControlStep& step) { step.actuators.Drive(speed, 0.0); };
}

ToyRobot RobotAt(double x, double y, Behaviour behaviour) {
  return {.pose = {{x, y}, 0.0}, .behaviour = std::move(behaviour)};
}

ToyScenario CrowdedWalk(std::uint64_t scene, Tick ticks, const Behaviour& behaviour = Huddle(0.1)) {
  RandomStream random(scene, StreamPurpose::kTest);
  TestCase test_case;
  test_case.obstacles = RandomObstacles(8, random);
  return ToyScenario(test_case, RandomRobots(11, test_case, Vec2::Zero(), 2.9, behaviour, random), ticks);
}

TEST(Simulation, CommandsOfATickMoveTheRobotInTheNext) {
  ToyScenario scenario(TestCase{}, {RobotAt(0, 0, DriveStraight(0.1))}, 3);
  const RunResult result = Simulate(scenario, 1, true);
  ASSERT_EQ(result.trajectory.size(), 4u);
  EXPECT_EQ(result.trajectory[0][0].x, 0.0);
  EXPECT_EQ(result.trajectory[1][0].x, 0.0);
  EXPECT_NEAR(result.trajectory[2][0].x, 0.008892857, 1e-9);
  EXPECT_NEAR(result.trajectory[2][0].speed, 0.08892857, 1e-8);
  EXPECT_NEAR(result.trajectory[3][0].x, 0.018892857, 1e-9);
}

TEST(Simulation, BeaconsSetInATickAreSeenInTheNext) {
  std::vector<std::size_t> seen;
  const Behaviour watch = [&seen](const ControlStep& step) { seen.push_back(step.readings.blobs.size()); };
  const Behaviour light_up_in_tick_2 = [](const ControlStep& step) {
    if (step.tick == 2) step.actuators.beacon = Color::kRed;
  };
  std::vector<ToyRobot> robots = {RobotAt(0, 0, light_up_in_tick_2), RobotAt(0.5, 0, watch)};
  robots[0].beacon = Color::kBlack;
  ToyScenario scenario(TestCase{}, robots, 4);
  Simulate(scenario, 1, false);
  EXPECT_EQ(seen, (std::vector<std::size_t>{0, 0, 1, 1}));
}

TEST(Simulation, RobotsHaveOnlyTheDevicesTheyAskFor) {
  std::vector<ToyRobot> robots = {RobotAt(0, 0, [](const ControlStep& step) {
    step.actuators.Drive(0.1, 0.0);
    step.actuators.beacon = Color::kBlack;
  })};
  robots[0].devices = Device::kProximity;
  std::size_t blobs = 0;
  robots.push_back(
      RobotAt(0.5, 0, [&blobs](const ControlStep& step) { blobs = step.readings.blobs.size(); }));
  ToyScenario scenario(TestCase{}, robots, 5);
  const RunResult result = Simulate(scenario, 1, false);
  EXPECT_EQ(result.robots[0].path_length, 0.0);
  EXPECT_EQ(blobs, 1u);
}

TEST(Simulation, RobotsWithPositioningAndEncodersKnowTheirPoseAndTheirWheels) {
  std::vector<Pose> poses;
  std::vector<double> left_wheel;
  ToyRobot blocked = RobotAt(2.86, 0.5, [&](const ControlStep& step) {
    poses.push_back(step.readings.pose);
    left_wheel.push_back(step.readings.wheels.left);
    step.actuators.left_wheel = 0.1 * step.tick;
    step.actuators.right_wheel = 0.1;
  });
  blocked.devices = Device::kWheels | Device::kPositioning | Device::kWheelEncoders;
  ToyScenario scenario(TestCase{}, {blocked}, 3);
  const RunResult result = Simulate(scenario, 1, true);
  ASSERT_EQ(poses.size(), 3u);
  for (std::size_t i = 0; i < poses.size(); ++i) {
    const RobotState& state = result.trajectory[i + 1][0];
    EXPECT_EQ(poses[i].position, state.position());
    EXPECT_EQ(poses[i].heading, state.heading);
  }
  EXPECT_NE(poses[2].heading, 0.0);
  EXPECT_EQ(left_wheel, (std::vector<double>{0.0, 0.1, 0.2}));  // as commanded in the tick before
}

TEST(Simulation, RobotsWithoutPositioningDoNotKnowTheirPose) {
  Pose pose;
  ToyScenario scenario(TestCase{},
                       {RobotAt(1, 1, [&](const ControlStep& step) { pose = step.readings.pose; })}, 1);
  Simulate(scenario, 1, false);
  EXPECT_EQ(pose.position, Vec2::Zero());
}

TEST(Simulation, EndsWhenTheScenarioSaysSo) {
  ToyScenario scenario(TestCase{}, {RobotAt(0, 0, DriveStraight(0.1))}, 1000);
  scenario.finished = [](const Observer& observer) { return observer.Latest()[0].x > 0.1; };
  const RunResult result = Simulate(scenario, 1, false);
  EXPECT_EQ(result.verdict, Verdict::kCompleted);
  EXPECT_EQ(result.ticks, 12);
  EXPECT_GT(result.robots[0].end.position.x(), 0.1);
  EXPECT_LT(result.robots[0].end.position.x(), 0.111);
}

TEST(Simulation, SummarizesEveryRobot) {
  ToyScenario scenario(TestCase{}, {RobotAt(0.5, 0.25, DriveStraight(0.1))}, 120);
  const RunResult result = Simulate(scenario, 1, false);
  EXPECT_EQ(result.ticks, 120);
  ASSERT_EQ(result.robots.size(), 1u);
  const RobotSummary& robot = result.robots[0];
  EXPECT_EQ(robot.start.position, Vec2(0.5, 0.25));
  EXPECT_NEAR(robot.path_length, 119 * 0.01 - 0.001107143, 1e-9);
  EXPECT_NEAR(robot.end.position.x() - 0.5, robot.path_length, 1e-12);
  ASSERT_EQ(robot.waypoints.size(), 3u);
  EXPECT_EQ(robot.waypoints[0], Vec2(0.5, 0.25));
  EXPECT_NEAR(robot.waypoints[2].x(), 0.5 + 0.99 - 0.001107143, 1e-9);
  EXPECT_EQ(result.fitness, robot.end.position.norm());
  EXPECT_TRUE(result.trajectory.empty());
  EXPECT_EQ(result.hash, HashOf(result));
}

TEST(Simulation, SameSeedSameBits) {
  ToyScenario first = CrowdedWalk(3, 500, RandomWalk(0.1));
  ToyScenario again = CrowdedWalk(3, 500, RandomWalk(0.1));
  ToyScenario recorded = CrowdedWalk(3, 500, RandomWalk(0.1));
  ToyScenario other_seed = CrowdedWalk(3, 500, RandomWalk(0.1));
  const RunResult result = Simulate(first, 9, false);
  EXPECT_EQ(Simulate(again, 9, false).hash, result.hash);
  EXPECT_EQ(Simulate(recorded, 9, true).hash, result.hash);
  EXPECT_NE(Simulate(other_seed, 10, false).trajectory_hash, result.trajectory_hash);
}

TEST(Simulation, KeepsRobotsOutOfWallsObstaclesAndEachOther) {
  double deepest_box = 0.0;
  double deepest_pair = 0.0;
  for (const std::uint64_t scene : {1u, 2u, 3u, 4u}) {
    ToyScenario scenario = CrowdedWalk(scene, 2000);
    const RunResult result = Simulate(scenario, scene, true);
    for (const std::vector<RobotState>& states : result.trajectory) {
      for (std::size_t i = 0; i < states.size(); ++i) {
        for (const OrientedBox& box : scenario.arena().boxes()) {
          deepest_box = std::max(deepest_box, foot_bot::kRadius - Distance(box, states[i].position()));
        }
        for (std::size_t j = 0; j < i; ++j) {
          const double distance = (states[i].position() - states[j].position()).norm();
          deepest_pair = std::max(deepest_pair, 2 * foot_bot::kRadius - distance);
        }
      }
    }
  }
  std::printf("deepest overlap: box %.2f mm, robots %.2f mm\n", 1e3 * deepest_box, 1e3 * deepest_pair);
  EXPECT_LT(deepest_box, 0.010);
  EXPECT_LT(deepest_pair, 0.010);
}

TEST(Simulation, RefusesCommandsThatCannotBeCarriedOut) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double infinity = std::numeric_limits<double>::infinity();
  for (const double bad : {nan, infinity, -infinity, 1e300, -1.5}) {
    const Behaviour misbehave = [bad](const ControlStep& step) {
      step.actuators.Drive(0.1, 0.0);
      if (step.tick == 17) step.actuators.right_wheel = bad;
    };
    ToyScenario scenario(TestCase{}, {RobotAt(0, 0, DriveStraight(0.1)), RobotAt(0, 1, misbehave)}, 100);
    const RunResult result = Simulate(scenario, 1, false);
    EXPECT_EQ(result.verdict, Verdict::kInvalidCommand);
    EXPECT_EQ(result.ticks, 17);
    EXPECT_THAT(result.message, AllOf(StartsWith("invalid-command: robot 1, tick 17: right wheel speed "),
                                      HasSubstr(NumberText(bad)), HasSubstr("at most 1 m/s")));
    EXPECT_EQ(result.hash, HashOf(result));
    EXPECT_TRUE(std::isfinite(result.robots[1].end.position.x()));
  }
}

RunResult SimulateOne(const ToyRobot& robot, const TestCase& test_case = {}) {
  ToyScenario scenario(test_case, {RobotAt(0, 0, DriveStraight(0.0)), robot}, 10);
  return Simulate(scenario, 1, false);
}

TEST(Simulation, RefusesSwarmsThatCannotBeSimulated) {
  ToyRobot robot = RobotAt(7.0, 0, DriveStraight(0.1));
  RunResult result = SimulateOne(robot);
  EXPECT_EQ(result.verdict, Verdict::kRefused);
  EXPECT_THAT(result.message,
              StartsWith("bad-start: robot 1, tick 0: at (7, 0) m, outside the walls, whose inner"));

  TestCase blocked;
  blocked.obstacles = {{.x = 1.0, .y = 0.0, .length = 0.5, .width = 0.5, .orientation_deg = 0.0}};
  robot = RobotAt(1.0, 0.1, DriveStraight(0.1));
  EXPECT_THAT(SimulateOne(robot, blocked).message,
              StartsWith("bad-start: robot 1, tick 0: at (1, 0.1) m, inside obstacle 1"));

  robot = RobotAt(std::numeric_limits<double>::quiet_NaN(), 0, DriveStraight(0.1));
  EXPECT_THAT(SimulateOne(robot).message,
              StartsWith("bad-start: robot 1, tick 0: at (nan, 0) m, heading 0; a pose is finite"));

  robot = RobotAt(1, 0, DriveStraight(0.1));
  robot.devices = Device::kWheels | Device::kGripper;
  robot.equipment = kToyDevices;
  EXPECT_THAT(SimulateOne(robot).message,
              StartsWith("unsupported-device: robot 1 asks in tick 0 for gripper, which it does not have"));

  robot = RobotAt(1, 0, DriveStraight(0.1));
  robot.camera_range = std::numeric_limits<double>::infinity();
  EXPECT_THAT(SimulateOne(robot).message,
              StartsWith("bad-range: robot 1, tick 0: camera or radio range inf m"));

  ToyScenario empty(TestCase{}, {}, 10);
  EXPECT_THAT(Simulate(empty, 1, false).message, StartsWith("swarm-size: 0 robots"));

  ToyScenario huge(TestCase{}, std::vector<ToyRobot>(10000, RobotAt(0, 0, DriveStraight(0.1))), 10);
  EXPECT_THAT(Simulate(huge, 1, false).message, StartsWith("swarm-size: 10000 robots"));
}

// Robots on top of each other are possible, if odd: they drift apart and nothing becomes NaN.
TEST(Simulation, SurvivesRobotsInOnePlace) {
  ToyScenario scenario(TestCase{}, std::vector<ToyRobot>(5, RobotAt(0, 0, RandomWalk(0.1))), 200);
  const RunResult result = Simulate(scenario, 1, false);
  EXPECT_EQ(result.verdict, Verdict::kCompleted);
  for (const RobotSummary& robot : result.robots) {
    EXPECT_TRUE(std::isfinite(robot.end.position.x()) && std::isfinite(robot.end.position.y()));
    EXPECT_LT(robot.end.position.norm(), 5.0);
  }
}

TEST(Simulation, SurvivesObstaclesOfAnySize) {
  TestCase test_case;
  test_case.obstacles = {{.x = 0.5, .y = 0.0, .length = 1e-9, .width = 1e-9, .orientation_deg = 10.0},
                         {.x = 1.0, .y = 0.0, .length = 0.0, .width = 0.0, .orientation_deg = 0.0},
                         {.x = 0.0, .y = 0.6, .length = 2.0, .width = 1e-6, .orientation_deg = 0.0},
                         {.x = 0.0, .y = -1e6, .length = 1e6, .width = 1e5, .orientation_deg = 0.0}};
  for (const PhysicsKind physics : {PhysicsKind::kImpulse, PhysicsKind::kBox2d, PhysicsKind::kRelaxation}) {
    ToyScenario scenario(test_case, {RobotAt(0, 0, DriveStraight(0.1)), RobotAt(0, 0.3, RandomWalk(0.1))},
                         300);
    const RunResult result = Simulate(scenario, 1, false, {.physics = physics});
    EXPECT_EQ(result.verdict, Verdict::kCompleted);
    EXPECT_TRUE(std::isfinite(result.fitness));
  }
}

// Twenty robots in one heap, into whose bodies (not centres) obstacles reach that overlap each other and the
// walls: nothing hangs, nothing becomes NaN, and who is pushed through a wall is named.
TEST(Simulation, SurvivesOrNamesEverythingOverlapping) {
  TestCase test_case;
  test_case.side_x = 1.0;
  test_case.side_y = 1.0;
  for (int i = 0; i < 12; ++i) {
    const Vec2 place = 0.3 * UnitVector(i * kPi / 6);
    test_case.obstacles.push_back({place.x(), place.y(), 0.4, 0.4, i * 30.0});
  }
  std::vector<ToyRobot> robots;
  for (int i = 0; i < 20; ++i) robots.push_back(RobotAt(0.004 * i - 0.04, 0.002 * i - 0.02, Huddle(0.1)));
  for (const PhysicsKind physics : {PhysicsKind::kImpulse, PhysicsKind::kBox2d, PhysicsKind::kRelaxation}) {
    ToyScenario scenario(test_case, robots, 300);
    const RunResult result = Simulate(scenario, 1, true, {.physics = physics});
    const bool named = result.verdict == Verdict::kInvalidCommand;
    EXPECT_TRUE(named || result.verdict == Verdict::kCompleted);
    if (named) {
      EXPECT_THAT(result.message,
                  testing::MatchesRegex("left-arena: robot [0-9]+, tick " + std::to_string(result.ticks) +
                                        ": at .* m, outside the walls: .*"));
    }
    for (std::size_t tick = 0; tick + 1 < result.trajectory.size(); ++tick) {
      for (const RobotState& state : result.trajectory[tick]) {
        ASSERT_TRUE(scenario.arena().InInterior(state.position())) << "tick " << tick;
        ASSERT_TRUE(std::isfinite(state.heading));
      }
    }
  }
}

TEST(Simulation, EndsAtALightThatIsNotFinite) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const Light& bad : {Light{.position = {nan, 0.0}}, Light{.height = -0.1}, Light{.intensity = -1.0},
                           Light{.intensity = std::numeric_limits<double>::infinity()}}) {
    ToyScenario scenario(TestCase{}, {RobotAt(0, 0, DriveStraight(0.1))}, 50);
    scenario.lamps = {Light{}, Light{}};
    scenario.interact = [&](const Interaction& interaction) {
      if (interaction.observer.last_tick() == 7) scenario.lamps[1] = bad;
    };
    const RunResult result = Simulate(scenario, 1, false);
    EXPECT_EQ(result.verdict, Verdict::kInvalidCommand);
    EXPECT_EQ(result.ticks, 7);
    EXPECT_THAT(result.message, StartsWith("invalid-light: light 1, tick 7: at "));
  }
}

TEST(Simulation, EndsAtARadioBeaconThatIsNotFinite) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double infinity = std::numeric_limits<double>::infinity();
  for (const RadioBeacon& bad :
       {RadioBeacon{.position = {0.0, nan}}, RadioBeacon{.position = {infinity, 0.0}},
        RadioBeacon{.range = -0.5}, RadioBeacon{.range = nan}, RadioBeacon{.range = infinity}}) {
    ToyScenario scenario(TestCase{}, {RobotAt(0, 0, DriveStraight(0.1))}, 50);
    scenario.radios = {RadioBeacon{}, RadioBeacon{}};
    scenario.interact = [&](const Interaction& interaction) {
      if (interaction.observer.last_tick() == 7) scenario.radios[1] = bad;
    };
    const RunResult result = Simulate(scenario, 1, false);
    EXPECT_EQ(result.verdict, Verdict::kInvalidCommand);
    EXPECT_EQ(result.ticks, 7);
    EXPECT_EQ(result.message, "invalid-radio-beacon: radio beacon 1, tick 7: at " +
                                  PointText(bad.position.x(), bad.position.y()) + " m, range " +
                                  NumberText(bad.range) +
                                  " m; a place is finite, a range is finite and not negative");
  }
}

TEST(Simulation, GivesNoResultThatIsNotFinite) {
  ToyScenario scenario(TestCase{}, {RobotAt(0, 0, DriveStraight(0.1))}, 5);
  scenario.extra_metrics = {{"share", std::numeric_limits<double>::quiet_NaN()}};
  const RunResult result = Simulate(scenario, 1, false);
  EXPECT_EQ(result.verdict, Verdict::kInvalidCommand);
  EXPECT_EQ(result.message,
            "invalid-outcome: tick 5: the scenario's metric share is nan; a result is finite");
  EXPECT_TRUE(result.metrics.empty());
}

TEST(Simulation, GivesNoResultOfARunThatTheScenarioCannotJudge) {
  ToyScenario scenario(TestCase{}, {RobotAt(0, 0, DriveStraight(0.1))}, 5);
  scenario.complaint = "fitness divides 1 by 0";
  const RunResult result = Simulate(scenario, 1, false);
  EXPECT_EQ(result.verdict, Verdict::kInvalidCommand);
  EXPECT_EQ(result.message, "invalid-outcome: tick 5: fitness divides 1 by 0");
  EXPECT_TRUE(result.metrics.empty());
}

TEST(Simulation, EndsAtAScannerCommandThatIsNotFinite) {
  ToyRobot robot = RobotAt(0, 0, [](const ControlStep& step) {
    if (step.tick == 2) step.actuators.scanner.value = std::numeric_limits<double>::quiet_NaN();
  });
  robot.devices = Device::kDistanceScanner;
  ToyScenario scenario(TestCase{}, {robot}, 5);
  const RunResult result = Simulate(scenario, 1, false);
  EXPECT_EQ(result.verdict, Verdict::kInvalidCommand);
  EXPECT_THAT(result.message, StartsWith("invalid-command: robot 0, tick 2: distance scanner command nan"));
}

}  // namespace
}  // namespace gauntlet::sim
