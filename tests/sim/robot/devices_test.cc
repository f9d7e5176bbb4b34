#include "sim/robot/devices.h"

#include <gtest/gtest.h>

#include <set>
#include <string>

#include "sim/geometry/trigonometry.h"
#include "sim/robot/controller.h"

namespace gauntlet::sim {
namespace {

TEST(DeviceSet, HasWhatWasPutIn) {
  const DeviceSet devices = Device::kWheels | Device::kProximity;
  EXPECT_TRUE(devices.Has(Device::kWheels));
  EXPECT_TRUE(devices.Has(Device::kProximity));
  EXPECT_FALSE(devices.Has(Device::kLeds));
}

TEST(Devices, HaveDistinctNames) {
  std::set<std::string> names;
  for (const DeviceInfo& info : kDevices) {
    names.emplace(info.key);
    EXPECT_EQ(DeviceOfKey(KeyOf(info.device)), info.device);
  }
  EXPECT_EQ(names.size(), kDevices.size());
  EXPECT_EQ(DeviceOfKey("unknown_device"), std::nullopt);
}

TEST(ProximityBearing, StartsFrontLeftAndGoesRoundCounterClockwise) {
  EXPECT_NEAR(ProximityBearing(0), 7.5 * kDegree, 1e-12);
  EXPECT_NEAR(ProximityBearing(11), 172.5 * kDegree, 1e-12);
  EXPECT_NEAR(ProximityBearing(12), -172.5 * kDegree, 1e-12);
  EXPECT_NEAR(ProximityBearing(23), -7.5 * kDegree, 1e-12);
}

TEST(Actuators, DriveSplitsIntoWheelSpeeds) {
  Actuators actuators;
  actuators.Drive(0.10, 0.5);
  EXPECT_NEAR((actuators.left_wheel + actuators.right_wheel) / 2.0, 0.10, 1e-15);
  EXPECT_NEAR((actuators.right_wheel - actuators.left_wheel) / foot_bot::kWheelDistance, 0.5, 1e-15);
}

}  // namespace
}  // namespace gauntlet::sim
