// Noise of devices and faults of robots: their size, their independence, and that they are refused when
// wrong.
// Covers: sim/robot/disturber.cc

#include "sim/robot/disturbances.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "sim/robot/disturber.h"
#include "sim/simulation.h"
#include "tests/support/toy_scenario.h"

namespace gauntlet::sim {
namespace {

struct Moments {
  double mean = 0.0;
  double deviation = 0.0;
};

Moments MomentsOf(const std::vector<double>& values) {
  Moments moments;
  const auto count = static_cast<double>(values.size());
  for (const double value : values) moments.mean += value / count;
  for (const double value : values) {
    moments.deviation += (value - moments.mean) * (value - moments.mean) / count;
  }
  moments.deviation = std::sqrt(moments.deviation);
  return moments;
}

ToyRobot Standing(double x, double y, Behaviour behaviour, DeviceSet devices = kAllDevices) {
  return {.pose = {{x, y}, 0.0}, .behaviour = std::move(behaviour), .devices = devices};
}

RunResult RunWith(
    std::vector<ToyRobot> robots, Tick ticks, const Disturbances& disturbances,
    const std::function<void(ToyScenario&)>& furnish = [](ToyScenario&) {}, std::uint64_t seed = 1) {
  ToyScenario scenario(TestCase{}, std::move(robots), ticks);
  furnish(scenario);
  return Simulate(scenario, seed, true, {.disturbances = disturbances});
}

// Grey of a floor of 0.5 as motor ground sensors read it, 4 readings in each of 2500 ticks.
std::vector<double> GreyReadings(const DeviceNoise& noise, std::uint64_t seed = 1) {
  std::vector<double> readings;
  const Behaviour read = [&](const ControlStep& step) {
    for (const double grey : step.readings.motor_ground) readings.push_back(grey);
  };
  Disturbances disturbances;
  if (noise.Any()) disturbances.noise[Device::kMotorGround] = noise;
  RunWith(
      {Standing(0, 0, read)}, 2500, disturbances,
      [](ToyScenario& scenario) { scenario.floor = [](const Vec2&) { return 0.5; }; }, seed);
  return readings;
}

TEST(Noise, HasTheAskedForMeanAndDeviation) {
  EXPECT_EQ(GreyReadings({}), std::vector<double>(10000, 0.5));
  const Moments gaussian = MomentsOf(GreyReadings({.gaussian = 0.02}));
  EXPECT_NEAR(gaussian.mean, 0.5, 4 * 0.02 / 100);  // four standard errors of 10,000 readings
  EXPECT_NEAR(gaussian.deviation, 0.02, 4 * 0.02 / 141);
  const std::vector<double> flat = GreyReadings({.uniform = 0.1});
  const Moments uniform = MomentsOf(flat);
  EXPECT_NEAR(uniform.mean, 0.5, 4 * 0.0577 / 100);
  EXPECT_NEAR(uniform.deviation, 0.1 / std::sqrt(3.0), 4 * 0.0577 / 141);
  for (const double grey : flat) ASSERT_LE(std::abs(grey - 0.5), 0.1);
  const Moments both = MomentsOf(GreyReadings({.uniform = 0.1, .gaussian = 0.02}));
  EXPECT_NEAR(both.deviation, std::sqrt(0.01 / 3 + 0.0004), 0.002);
}

TEST(Noise, IsTheSameForTheSameSeedOnly) {
  EXPECT_EQ(GreyReadings({.gaussian = 0.02}), GreyReadings({.gaussian = 0.02}));
  EXPECT_NE(GreyReadings({.gaussian = 0.02}), GreyReadings({.gaussian = 0.02}, 2));
}

TEST(Noise, KeepsShareReadingsBetweenZeroAndOneAndMarksHits) {
  int hits = 0;
  const Behaviour read = [&](const ControlStep& step) {
    for (std::size_t i = 0; i < step.readings.proximity.size(); ++i) {
      const double reading = step.readings.proximity[i];
      ASSERT_GE(reading, 0.0);
      ASSERT_LE(reading, 1.0);
      ASSERT_EQ((step.readings.proximity_hits >> i & 1u) != 0, reading != 0.0);
      hits += reading != 0.0 ? 1 : 0;
    }
  };
  Disturbances disturbances;
  disturbances.noise[Device::kProximity] = {.gaussian = 0.1};
  RunWith({Standing(0, 0, read)}, 500, disturbances);
  EXPECT_NEAR(hits / (500.0 * 24), 0.5, 0.02);  // errors below zero are cut off
}

TEST(Noise, DropsTheAskedForShareOfMessagesAndBlobs) {
  int messages = 0;
  int blobs = 0;
  const Behaviour listen = [&](const ControlStep& step) {
    messages += static_cast<int>(step.readings.range_and_bearing.size());
    blobs += static_cast<int>(step.readings.blobs.size());
  };
  const Behaviour nothing = [](const ControlStep&) {};
  Disturbances disturbances;
  disturbances.noise[Device::kRangeAndBearing] = {.drop = 0.1};
  disturbances.noise[Device::kOmnidirectionalCamera] = {.drop = 0.3};
  RunWith({Standing(0, 0, listen), Standing(0.6, 0, nothing), Standing(0, 0.6, nothing)}, 5000, disturbances);
  EXPECT_NEAR(messages / 10000.0, 0.9, 4 * 0.003);
  EXPECT_NEAR(blobs / 10000.0, 0.7, 4 * 0.0046);
}

TEST(Noise, ShiftsBlobsByAShareOfTheirDistanceAndSendersByMetres) {
  std::vector<double> blob_x;
  std::vector<double> sender_y;
  const Behaviour look = [&](const ControlStep& step) {
    ASSERT_EQ(step.readings.blobs.size(), 1u);
    ASSERT_EQ(step.readings.range_and_bearing.size(), 1u);
    const Blob& blob = step.readings.blobs[0];
    ASSERT_NEAR(blob.range, blob.position.norm(), 1e-12);
    blob_x.push_back(blob.position.x());
    sender_y.push_back(step.readings.range_and_bearing[0].position.y());
  };
  Disturbances disturbances;
  disturbances.noise[Device::kRangeAndBearing] = {.gaussian = 0.05};
  disturbances.noise[Device::kOmnidirectionalCamera] = {.gaussian = 0.1};
  RunWith({Standing(0, 0, look), Standing(0.8, 0, [](const ControlStep&) {})}, 5000, disturbances);
  // A random direction takes 1/sqrt(2) of the length along each axis.
  const Moments blob = MomentsOf(blob_x);
  EXPECT_NEAR(blob.mean, 0.8, 0.004);
  EXPECT_NEAR(blob.deviation, 0.8 * 0.1 / std::sqrt(2.0), 0.004);
  const Moments sender = MomentsOf(sender_y);
  EXPECT_NEAR(sender.mean, 0.0, 0.003);
  EXPECT_NEAR(sender.deviation, 0.05 / std::sqrt(2.0), 0.003);
}

TEST(Noise, OfWheelsIsAShareOfTheirSpeed) {
  Disturbances disturbances;
  disturbances.noise[Device::kWheels] = {.gaussian = 0.1};
  const auto drive = [](double speed) {
    return [speed](const ControlStep& step) { step.actuators.Drive(speed, 0.0); };
  };
  const RunResult result =
      RunWith({Standing(-2, 1, drive(0.02)), Standing(-2, -1, drive(0.0))}, 1000, disturbances);
  EXPECT_NEAR(result.robots[0].path_length, 0.02 * 100, 0.02);
  EXPECT_NE(result.robots[0].end.heading, 0.0);
  EXPECT_EQ(result.robots[1].path_length, 0.0);
}

TEST(Noise, OfBaseGroundIsAddedBeforeTheCut) {
  int white = 0;
  const Behaviour read = [&](const ControlStep& step) {
    for (const bool bright : step.readings.base_ground) white += bright ? 1 : 0;
  };
  Disturbances disturbances;
  disturbances.noise[Device::kBaseGround] = {.uniform = 0.2};
  RunWith({Standing(0, 0, read)}, 1000, disturbances,
          [](ToyScenario& scenario) { scenario.floor = [](const Vec2&) { return 0.4; }; });
  EXPECT_NEAR(white / 8000.0, 0.25, 0.02);  // of 0.2 to 0.6, a quarter is 0.5 or more
}

TEST(Noise, OfTheScannerIsOnMeasuredDistancesOnly) {
  std::vector<double> distances;
  const Behaviour scan = [&](const ControlStep& step) {
    step.actuators.scanner = {.mode = ScannerCommand::Mode::kAngle, .value = 0.0};
    for (const ScannerReading& ray : step.readings.scanner_short) {
      if (ray.distance >= 0.0) distances.push_back(ray.distance);
      ASSERT_TRUE(ray.distance >= 0.0 || ray.distance == ScannerReading::kNothing);
    }
  };
  Disturbances disturbances;
  disturbances.noise[Device::kDistanceScanner] = {.gaussian = 0.01};
  RunWith({Standing(2.75, 0, scan)}, 2000, disturbances);
  ASSERT_EQ(distances.size(), 1999u);
  const Moments moments = MomentsOf(distances);
  EXPECT_NEAR(moments.mean, 2.95 - 2.75 - foot_bot::kRadius, 0.001);
  EXPECT_NEAR(moments.deviation, 0.01, 0.001);
}

TEST(Disturbances, OfNothingChangeNoBit) {
  const auto robots = [] {
    RandomStream random(4, StreamPurpose::kTest);
    return RandomRobots(6, TestCase{}, Vec2::Zero(), 2.0, RandomWalk(0.1), random);
  };
  Disturbances disturbances;
  const std::uint64_t hash = RunWith(robots(), 300, {}).hash;
  disturbances.faults = {{.robot = 2, .device = Device::kWheels, .tick = 301}};
  EXPECT_EQ(RunWith(robots(), 300, disturbances).hash, hash);
  disturbances.faults[0].tick = 150;
  EXPECT_NE(RunWith(robots(), 300, disturbances).hash, hash);
}

// Robots far apart: a fault of one, and noise of another device, leave every number of the others as it was.
TEST(Disturbances, OfOneRobotNeverChangeTheDrawsOfAnother) {
  const auto record = [](const Disturbances& disturbances) {
    std::vector<double> readings;
    const Behaviour read = [&](const ControlStep& step) {
      for (const double value : step.readings.proximity) readings.push_back(value);
      readings.push_back(step.random.Uniform());
    };
    RunWith({Standing(-2.5, -2.5, [](const ControlStep&) {}), Standing(2, 2, read)}, 100, disturbances);
    return readings;
  };
  Disturbances disturbances;
  disturbances.noise[Device::kProximity] = {.gaussian = 0.05};
  const std::vector<double> alone = record(disturbances);
  disturbances.noise[Device::kOmnidirectionalCamera] = {.gaussian = 0.05, .drop = 0.5};
  disturbances.noise[Device::kLight] = {.uniform = 0.5};
  disturbances.faults = {{.robot = 0, .tick = 10}, {.robot = 0, .device = Device::kProximity, .tick = 3}};
  EXPECT_EQ(record(disturbances), alone);
}

TEST(Faults, DeadWheelsStandFromTheirTickOn) {
  Disturbances disturbances;
  disturbances.faults = {{.robot = 1, .device = Device::kWheels, .tick = 20}};
  const Behaviour drive = [](const ControlStep& step) { step.actuators.Drive(0.1, 0.0); };
  const RunResult result = RunWith({Standing(0, 1, drive), Standing(0, -1, drive)}, 60, disturbances);
  EXPECT_EQ(result.trajectory[19][1].x, result.trajectory[19][0].x);
  EXPECT_LT(result.trajectory[20][1].x - result.trajectory[19][1].x, 0.002);  // braked with 15 N
  EXPECT_EQ(result.trajectory[60][1].x, result.trajectory[21][1].x);
  EXPECT_GT(result.trajectory[60][0].x, 0.5);
}

TEST(Faults, ADeadSensorReadsNothingAndTheOthersGoOn) {
  std::vector<Tick> seen;
  std::vector<Tick> felt;
  const Behaviour watch = [&](const ControlStep& step) {
    if (!step.readings.blobs.empty()) seen.push_back(step.tick);
    if (step.readings.proximity_hits != 0) felt.push_back(step.tick);
  };
  Disturbances disturbances;
  disturbances.faults = {{.robot = 0, .device = Device::kOmnidirectionalCamera, .tick = 3},
                         {.robot = 0, .device = Device::kProximity, .tick = 5}};
  RunWith({Standing(0, 0, watch), Standing(0.22, 0, [](const ControlStep&) {})}, 8, disturbances);
  EXPECT_EQ(seen, (std::vector<Tick>{1, 2}));
  EXPECT_EQ(felt, (std::vector<Tick>{1, 2, 3, 4}));
}

TEST(Faults, AStoppedRobotStandsDarkAndSilentAndDecidesNothing) {
  std::size_t decisions = 0;
  std::vector<Tick> seen;
  std::vector<Tick> heard;
  const Behaviour watch = [&](const ControlStep& step) {
    if (!step.readings.blobs.empty()) seen.push_back(step.tick);
    if (!step.readings.range_and_bearing.empty()) heard.push_back(step.tick);
  };
  const Behaviour drive = [&](const ControlStep& step) {
    ++decisions;
    step.actuators.Drive(0.1, 0.0);
  };
  Disturbances disturbances;
  disturbances.faults = {{.robot = 1, .device = {}, .tick = 4}};
  const RunResult result = RunWith({Standing(0, 0, watch), Standing(0.5, 0, drive)}, 30, disturbances);
  EXPECT_EQ(seen, (std::vector<Tick>{1, 2, 3}));
  EXPECT_EQ(heard, (std::vector<Tick>{1, 2, 3}));
  EXPECT_EQ(decisions, 3u);
  EXPECT_EQ(result.trajectory[30][1].x, result.trajectory[5][1].x);
}

TEST(Faults, OfTickZeroActFromTheBeginning) {
  Disturbances disturbances;
  disturbances.faults = {{.robot = 0, .device = {}, .tick = 0}};
  const Behaviour drive = [](const ControlStep& step) { step.actuators.Drive(0.1, 0.0); };
  EXPECT_EQ(RunWith({Standing(0, 0, drive)}, 30, disturbances).robots[0].path_length, 0.0);
}

TEST(Faults, AreReadAsTheyAreWritten) {
  const std::string text = "3:wheels@500 0:stopped@0 12:range_and_bearing@20";
  const auto faults = ParseFaults("  3:wheels@500  0:stopped@0 12:range_and_bearing@20 ");
  ASSERT_TRUE(faults.ok());
  ASSERT_EQ(faults->size(), 3u);
  EXPECT_EQ((*faults)[0], (RobotFault{.robot = 3, .device = Device::kWheels, .tick = 500}));
  EXPECT_EQ((*faults)[1].device, std::nullopt);
  EXPECT_EQ(FaultsText(*faults), text);
  EXPECT_TRUE(ParseFaults("")->empty());
}

std::vector<RobotIndex> Drawn(const RandomFaults& random, const std::vector<bool>& under_test,
                              std::uint64_t seed) {
  std::vector<RobotIndex> robots;
  for (const RobotFault& fault : DrawFaults(random, under_test, seed)) robots.push_back(fault.robot);
  return robots;
}

TEST(DrawFaults, GivesDifferentRobotsOfTheRoleTheFaultAndTheSameForTheSameSeed) {
  const std::vector<bool> under_test = {true, false, true, true, true, false};
  const RandomFaults random = {.count = 3, .device = Device::kWheels, .tick = 40};
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    const std::vector<RobotFault> faults = DrawFaults(random, under_test, seed);
    ASSERT_EQ(faults.size(), 3U);
    EXPECT_EQ(faults, DrawFaults(random, under_test, seed));
    for (std::size_t i = 0; i < faults.size(); ++i) {
      EXPECT_TRUE(under_test[static_cast<std::size_t>(faults[i].robot)]) << seed;
      EXPECT_EQ(faults[i].device, Device::kWheels);
      EXPECT_EQ(faults[i].tick, 40);
      if (i > 0) EXPECT_LT(faults[i - 1].robot, faults[i].robot) << seed;
    }
  }
  EXPECT_THAT(Drawn({.count = 4}, under_test, 7), testing::ElementsAre(0, 2, 3, 4));
  EXPECT_THAT(Drawn({.count = 6, .role = FaultyRole::kAll}, under_test, 7),
              testing::ElementsAre(0, 1, 2, 3, 4, 5));
  EXPECT_THAT(Drawn({}, under_test, 7), testing::IsEmpty());
}

TEST(DrawFaults, DrawsEachPairOfRobotsAsOften) {
  constexpr int kSeeds = 20000;
  std::map<std::vector<RobotIndex>, int> pairs;
  for (std::uint64_t seed = 0; seed < kSeeds; ++seed)
    ++pairs[Drawn({.count = 2}, {true, true, false, true, true, true}, seed)];
  EXPECT_EQ(pairs.size(), 10U);
  // 2000 each, with a standard deviation of 42.
  for (const auto& [pair, times] : pairs) EXPECT_NEAR(times, kSeeds / 10, 170) << pair[0] << " " << pair[1];
}

TEST(RandomFaults, MakeTheRunOfTheSameFaultsWrittenOut) {
  const Behaviour drive = [](const ControlStep& step) {
    step.actuators.left_wheel = step.actuators.right_wheel = 0.1;
  };
  std::vector<ToyRobot> robots;
  for (int i = 0; i < 5; ++i) robots.push_back(Standing(-1, i - 2, drive));
  robots[1].under_test = false;
  std::set<std::uint64_t> hashes;
  for (std::uint64_t seed = 1; seed <= 12; ++seed) {
    const Disturbances drawn = {.faults = {{.robot = 1, .tick = 30}},
                                .random_faults = {.count = 2, .device = Device::kWheels, .tick = 20}};
    Disturbances written = {.faults = drawn.faults};
    for (const RobotFault& fault : DrawFaults(drawn.random_faults, {true, false, true, true, true}, seed))
      written.faults.push_back(fault);
    const std::uint64_t hash = RunWith(
                                   robots, 60, drawn, [](ToyScenario&) {}, seed)
                                   .hash;
    EXPECT_EQ(hash, RunWith(
                        robots, 60, written, [](ToyScenario&) {}, seed)
                        .hash)
        << seed;
    hashes.insert(hash);
  }
  EXPECT_GT(hashes.size(), 2U);
}

TEST(RandomFaults, AreToldOnlyWhereARobotIsDrawn) {
  using Texts = std::vector<std::pair<std::string, std::string>>;
  Disturbances disturbances = {.random_faults = {.device = Device::kGripper, .tick = 9}};
  EXPECT_TRUE(disturbances.None());
  EXPECT_EQ(DisturbanceTexts(disturbances), Texts());
  disturbances.random_faults.count = 3;
  EXPECT_FALSE(disturbances.None());
  EXPECT_EQ(DisturbanceTexts(disturbances), (Texts{{"random_faults.count", "3"},
                                                   {"random_faults.what", "gripper"},
                                                   {"random_faults.tick", "9"},
                                                   {"random_faults.role", "tested"}}));
}

TEST(Faults, ThatAreMalformedAreRefusedWithTheirText) {
  const auto error = [](std::string_view text) {
    const auto faults = ParseFaults(text);
    return faults.ok() ? std::string("parsed") : faults.error().message;
  };
  EXPECT_EQ(error("3:wheels"), "'3:wheels': a fault is written ROBOT:WHAT@TICK, such as 3:wheels@500");
  EXPECT_EQ(error("1:leds@1 3@5:leds"),
            "'3@5:leds': a fault is written ROBOT:WHAT@TICK, such as 3:wheels@500");
  EXPECT_EQ(error("3:wheel@500"), "'3:wheel@500': no device is called 'wheel'; did you mean 'wheels'?");
  EXPECT_EQ(error("3:engine@500"),
            "'3:engine@500': no device is called 'engine'; known: stopped, wheels, leds, proximity, "
            "omnidirectional_camera, range_and_bearing, light, motor_ground, base_ground, distance_scanner, "
            "gripper, positioning, wheel_encoders");
  EXPECT_EQ(error("3:wheels@-1"), "'3:wheels@-1': the tick is a whole number, 0 to 1000000000");
  EXPECT_EQ(error("3:wheels@1e3"), "'3:wheels@1e3': the tick is a whole number, 0 to 1000000000");
  EXPECT_EQ(error("-3:wheels@1"), "'-3:wheels@1': the robot is a whole number, 0 to 999");
  EXPECT_EQ(error("1000:wheels@1"), "'1000:wheels@1': the robot is a whole number, 0 to 999");
  EXPECT_EQ(error("99999999999999999999:wheels@1"),
            "'99999999999999999999:wheels@1': the robot is a whole number, 0 to 999");
}

TEST(Disturbances, ThatCannotBeAreRefusedWithTheirValue) {
  const auto refusal = [](const Disturbances& disturbances) {
    const RunResult result = RunWith({Standing(0, 0, [](const ControlStep&) {})}, 5, disturbances);
    EXPECT_EQ(result.verdict, Verdict::kRefused);
    return result.message;
  };
  Disturbances wrong;
  wrong.noise[Device::kProximity] = {.gaussian = -0.1};
  EXPECT_EQ(refusal(wrong), "bad-noise: noise.proximity.gaussian = -0.1; 0 to 1 is possible");
  wrong.noise[Device::kProximity] = {.uniform = std::numeric_limits<double>::quiet_NaN()};
  EXPECT_EQ(refusal(wrong), "bad-noise: noise.proximity.uniform = nan; 0 to 1 is possible");
  wrong.noise[Device::kProximity] = {.drop = 0.1};
  EXPECT_EQ(refusal(wrong), "bad-noise: noise.proximity.drop = 0.1; 0 to 0 is possible");
  wrong.noise = {{Device::kRangeAndBearing, {.drop = 1.5}}};
  EXPECT_EQ(refusal(wrong), "bad-noise: noise.range_and_bearing.drop = 1.5; 0 to 1 is possible");
  wrong.noise = {{Device::kLeds, {.gaussian = 0.1}}};
  EXPECT_EQ(refusal(wrong), "bad-noise: noise.leds: no noise is defined for this device");
  wrong.noise.clear();
  wrong.faults = {{.robot = 1, .device = Device::kWheels, .tick = 500}};
  EXPECT_EQ(refusal(wrong),
            "bad-fault: 1:wheels@500: robot 1, tick 500; this swarm has robots 0 to 0, ticks count from 0");
  wrong.faults = {{.robot = -1, .device = {}, .tick = 0}};
  EXPECT_EQ(refusal(wrong),
            "bad-fault: -1:stopped@0: robot -1, tick 0; this swarm has robots 0 to 0, ticks count from 0");
  wrong.faults = {{.robot = 0, .device = {}, .tick = -3}};
  EXPECT_EQ(refusal(wrong),
            "bad-fault: 0:stopped@-3: robot 0, tick -3; this swarm has robots 0 to 0, ticks count from 0");
  wrong.faults.clear();
  wrong.random_faults = {.count = 2};
  EXPECT_EQ(
      refusal(wrong),
      "bad-fault: random_faults.count = 2; this swarm has 1 robots under test, so 0 to 1 of them may be "
      "faulty");
  wrong.random_faults = {.count = -1, .role = FaultyRole::kAll};
  EXPECT_EQ(refusal(wrong),
            "bad-fault: random_faults.count = -1; this swarm has 1 robots, so 0 to 1 of them may be faulty");
  wrong.random_faults = {.count = 1, .tick = -3};
  EXPECT_EQ(refusal(wrong), "bad-fault: random_faults.tick = -3; ticks count from 0");
}

}  // namespace
}  // namespace gauntlet::sim
