#include "sim/sensors/sensor_suite.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace gauntlet::sim {
namespace {

using testing::Each;
using testing::IsEmpty;

TEST(SensorSuite, FillsOnlyRequestedDevices) {
  const Arena arena{TestCase{}};
  const std::vector<SensorSuite::RobotSensors> robots = {
      {Device::kProximity, 1.6}, {Device::kOmnidirectionalCamera, 1.6}, {Device::kWheels, 1.6}};
  SensorSuite suite(arena, robots);
  const std::vector<Pose> poses = {{{0.0, 0.0}, 0.0}, {{0.2, 0.0}, 0.0}, {{0.4, 0.0}, 0.0}};
  const std::vector<Color> beacons(3, Color::kRed);
  suite.Sense(poses, beacons);

  EXPECT_TRUE(suite.ReadingsOf(0).proximity_active);
  EXPECT_THAT(suite.ReadingsOf(0).blobs, IsEmpty());
  EXPECT_FALSE(suite.ReadingsOf(1).proximity_active);
  EXPECT_THAT(suite.ReadingsOf(1).proximity, Each(0.0));
  EXPECT_EQ(suite.ReadingsOf(1).blobs.size(), 2u);
  EXPECT_FALSE(suite.ReadingsOf(2).proximity_active);
  EXPECT_THAT(suite.ReadingsOf(2).blobs, IsEmpty());
}

TEST(SensorSuite, ForgetsReadingsOfTheLastTick) {
  const Arena arena{TestCase{}};
  const std::vector<SensorSuite::RobotSensors> robots = {
      {Device::kProximity | Device::kOmnidirectionalCamera, 0.8}, {Device::kWheels, 0.0}};
  SensorSuite suite(arena, robots);
  const std::vector<Color> beacons(2, Color::kRed);
  suite.Sense(std::vector<Pose>{{{0.0, 0.0}, 0.0}, {{0.2, 0.0}, 0.0}}, beacons);
  EXPECT_TRUE(suite.ReadingsOf(0).proximity_active);
  EXPECT_EQ(suite.ReadingsOf(0).blobs.size(), 1u);
  suite.Sense(std::vector<Pose>{{{0.0, 0.0}, 0.0}, {{1.0, 0.0}, 0.0}}, beacons);
  EXPECT_FALSE(suite.ReadingsOf(0).proximity_active);
  EXPECT_THAT(suite.ReadingsOf(0).proximity, Each(0.0));
  EXPECT_THAT(suite.ReadingsOf(0).blobs, IsEmpty());
}

// The list of nearby boxes is renewed only now and then; the readings must not show it.
TEST(SensorSuite, SeesEveryWallOnTheWayThroughTheArena) {
  const Arena arena{TestCase{}};
  const std::vector<SensorSuite::RobotSensors> robots = {{Device::kProximity, 0.0}};
  const std::vector<Color> beacons = {Color::kBlack};
  SensorSuite walking(arena, robots);
  for (double x = -2.86; x <= 2.86; x += 0.01) {
    const std::vector<Pose> pose = {{{x, 0.5 * x}, 0.3}};
    walking.Sense(pose, beacons);
    SensorSuite fresh(arena, robots);
    fresh.Sense(pose, beacons);
    ASSERT_EQ(walking.ReadingsOf(0).proximity, fresh.ReadingsOf(0).proximity) << "x = " << x;
    ASSERT_EQ(walking.ReadingsOf(0).proximity_active, std::abs(x) > 2.95 - 0.185) << "x = " << x;
  }
}

}  // namespace
}  // namespace gauntlet::sim
