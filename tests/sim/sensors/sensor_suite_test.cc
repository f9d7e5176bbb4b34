#include "sim/sensors/sensor_suite.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

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
