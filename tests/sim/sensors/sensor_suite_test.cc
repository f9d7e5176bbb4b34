#include "sim/sensors/sensor_suite.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "sim/sensors/ground_sensor.h"
#include "tests/support/toy_scenario.h"

namespace gauntlet::sim {
namespace {

using testing::Each;
using testing::IsEmpty;

const Surroundings kNothingAround;

void Sense(SensorSuite& suite, const std::vector<Pose>& poses) {
  const std::vector<Signals> signals(poses.size(), {.beacon = Color::kRed});
  const Grippers grippers(std::vector<bool>(poses.size(), false));
  const std::vector<Actuators> actuators(poses.size());
  suite.Sense({.poses = poses,
               .signals = signals,
               .actuators = actuators,
               .surroundings = kNothingAround,
               .grippers = grippers});
}

TEST(SensorSuite, FillsOnlyRequestedDevices) {
  const Arena arena{TestCase{}};
  const std::vector<RobotSensors> robots = {{.devices = Device::kProximity, .camera_range = 1.6},
                                            {.devices = Device::kOmnidirectionalCamera, .camera_range = 1.6},
                                            {.devices = Device::kWheels, .camera_range = 1.6}};
  SensorSuite suite(arena, robots);
  const std::vector<Pose> poses = {{{0.0, 0.0}, 0.0}, {{0.2, 0.0}, 0.0}, {{0.4, 0.0}, 0.0}};
  Sense(suite, poses);

  EXPECT_NE(suite.ReadingsOf(0).proximity_hits, 0u);
  EXPECT_THAT(suite.ReadingsOf(0).blobs, IsEmpty());
  EXPECT_EQ(suite.ReadingsOf(1).proximity_hits, 0u);
  EXPECT_THAT(suite.ReadingsOf(1).proximity, Each(0.0));
  EXPECT_EQ(suite.ReadingsOf(1).blobs.size(), 2u);
  EXPECT_EQ(suite.ReadingsOf(2).proximity_hits, 0u);
  EXPECT_THAT(suite.ReadingsOf(2).blobs, IsEmpty());
}

TEST(SensorSuite, ForgetsReadingsOfTheLastTick) {
  const Arena arena{TestCase{}};
  const std::vector<RobotSensors> robots = {
      {.devices = Device::kProximity | Device::kOmnidirectionalCamera, .camera_range = 0.8},
      {.devices = Device::kWheels}};
  SensorSuite suite(arena, robots);
  Sense(suite, {{{0.0, 0.0}, 0.0}, {{0.2, 0.0}, 0.0}});
  EXPECT_NE(suite.ReadingsOf(0).proximity_hits, 0u);
  EXPECT_EQ(suite.ReadingsOf(0).blobs.size(), 1u);
  Sense(suite, {{{0.0, 0.0}, 0.0}, {{1.0, 0.0}, 0.0}});
  EXPECT_EQ(suite.ReadingsOf(0).proximity_hits, 0u);
  EXPECT_THAT(suite.ReadingsOf(0).proximity, Each(0.0));
  EXPECT_THAT(suite.ReadingsOf(0).blobs, IsEmpty());
}

struct Lit final : Surroundings {
  std::vector<Light> lamps = {{.position = {1.0, 1.0}, .intensity = 3.0, .color = Color::kYellow}};
  std::vector<RadioBeacon> beacons = {{.position = {-1.0, 0.0}, .range = 2.0, .payload = {}}};
  std::span<const Light> lights() const override { return lamps; }
  std::span<const RadioBeacon> radio_beacons() const override { return beacons; }
  // A black disc with a radius of 1 m.
  double FloorGrey(const Vec2& point) const override { return point.norm() <= 1.0 ? 0.0 : 1.0; }
  double FloorHolds(const Vec2& point) const override { return std::abs(point.norm() - 1.0); }
};

void ExpectSame(const SensorReadings& one, const SensorReadings& other) {
  EXPECT_EQ(one.proximity, other.proximity);
  EXPECT_EQ(one.light, other.light);
  EXPECT_EQ(one.motor_ground, other.motor_ground);
  EXPECT_EQ(one.base_ground, other.base_ground);
  ASSERT_EQ(one.blobs.size(), other.blobs.size());
  for (std::size_t i = 0; i < one.blobs.size(); ++i) {
    EXPECT_EQ(one.blobs[i].position, other.blobs[i].position);
    EXPECT_EQ(one.blobs[i].range, other.blobs[i].range);
  }
  ASSERT_EQ(one.range_and_bearing.size(), other.range_and_bearing.size());
  for (std::size_t i = 0; i < one.range_and_bearing.size(); ++i) {
    EXPECT_EQ(one.range_and_bearing[i].position, other.range_and_bearing[i].position);
    EXPECT_EQ(one.range_and_bearing[i].payload, other.range_and_bearing[i].payload);
  }
}

// What is remembered of lines of sight from tick to tick must not show.
TEST(SensorSuite, ReadsWhatOneWithoutAPastReads) {
  RandomStream random(1, StreamPurpose::kTest);
  TestCase test_case;
  test_case.obstacles = RandomObstacles(8, random);
  const Arena arena(test_case);
  const Lit surroundings;
  std::vector<RobotSensors> robots;
  std::vector<Pose> poses;
  for (const ToyRobot& robot : RandomRobots(20, test_case, Vec2::Zero(), 2.0, {}, random)) {
    robots.push_back({.devices = kAllDevices, .camera_range = 1.6, .radio_range = 2.0});
    robots.back().bodies_block_radio = robots.size() % 4 != 0;
    poses.push_back(robot.pose);
  }
  std::vector<Signals> signals(robots.size());
  const std::vector<Actuators> actuators(robots.size());
  const Grippers grippers(std::vector<bool>(robots.size(), true));
  SensorSuite old(arena, robots);
  for (Tick tick = 0; tick < 300; ++tick) {
    for (std::size_t i = 0; i < poses.size(); ++i) {
      poses[i].position += 0.02 * random.Uniform() * UnitVector(poses[i].heading);
      if (random.Chance(0.1)) poses[i].heading = random.Uniform(-kPi, kPi);
      signals[i].message[0] = static_cast<std::uint8_t>(i);
      signals[i].beacon = random.Chance(0.5) ? Color::kRed : Color::kBlack;
      signals[i].ring[0] = tick % 50 < 10 ? Color::kGreen : Color::kBlack;
    }
    const World world = {.poses = poses,
                         .signals = signals,
                         .actuators = actuators,
                         .surroundings = surroundings,
                         .grippers = grippers};
    old.Sense(world);
    SensorSuite fresh(arena, robots);
    fresh.Sense(world);
    for (std::size_t i = 0; i < robots.size(); ++i) {
      SCOPED_TRACE(testing::Message() << "tick " << tick << ", robot " << i);
      const auto robot = static_cast<RobotIndex>(i);
      ExpectSame(old.ReadingsOf(robot), fresh.ReadingsOf(robot));
      EXPECT_EQ(old.ReadingsOf(robot).motor_ground,
                SenseGround(BodyFrame(poses[i]), kMotorGroundPlaces, surroundings));
    }
    if (testing::Test::HasFailure()) return;
  }
}

TEST(SensorSuite, LeavesOutWhatNobodyAttendsTo) {
  const Arena arena{TestCase{}};
  const std::vector<RobotSensors> robots = {
      {.devices = Device::kProximity | Device::kOmnidirectionalCamera, .camera_range = 1.6},
      {.devices = Device::kWheels}};
  const std::vector<Pose> poses = {{{0.0, 0.0}, 0.0}, {{0.2, 0.0}, 0.0}};
  const std::vector<Signals> signals(2, {.beacon = Color::kRed});
  const std::vector<Actuators> actuators(2);
  const Grippers grippers({false, false});
  SensorSuite suite(arena, robots);
  Sense(suite, poses);
  EXPECT_NE(suite.ReadingsOf(0).proximity_hits, 0u);
  const std::vector<DeviceSet> attention = {Device::kOmnidirectionalCamera, Device::kWheels};
  suite.Sense({.poses = poses,
               .signals = signals,
               .actuators = actuators,
               .surroundings = kNothingAround,
               .grippers = grippers,
               .attention = attention});
  EXPECT_EQ(suite.ReadingsOf(0).proximity_hits, 0u);
  EXPECT_THAT(suite.ReadingsOf(0).proximity, Each(0.0));
  EXPECT_EQ(suite.ReadingsOf(0).blobs.size(), 1u);
}

// The list of nearby boxes is renewed only now and then; the readings must not show it.
TEST(SensorSuite, SeesEveryWallOnTheWayThroughTheArena) {
  const Arena arena{TestCase{}};
  const std::vector<RobotSensors> robots = {{.devices = Device::kProximity}};
  SensorSuite walking(arena, robots);
  for (double x = -2.86; x <= 2.86; x += 0.01) {
    const std::vector<Pose> pose = {{{x, 0.5 * x}, 0.3}};
    Sense(walking, pose);
    SensorSuite fresh(arena, robots);
    Sense(fresh, pose);
    ASSERT_EQ(walking.ReadingsOf(0).proximity, fresh.ReadingsOf(0).proximity) << "x = " << x;
    ASSERT_EQ(walking.ReadingsOf(0).proximity_hits != 0, std::abs(x) > 2.95 - 0.185) << "x = " << x;
  }
}

}  // namespace
}  // namespace gauntlet::sim
