#include "tests/sim/sensors/sensing.h"
#include "tests/support/make_box.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace gauntlet::sim {
namespace {

using testing::IsEmpty;
using testing::SizeIs;

BodyFrame At(double x, double y, double heading = 0.0) {
  return BodyFrame(Pose{{x, y}, heading});
}

// A robot with a radio of this range.
RobotSensors Radio(double range) {
  return {.devices = Device::kRangeAndBearing, .radio_range = range};
}

// What each robot hears; robot i says i in its first byte.
std::vector<std::vector<Message>> Listen(const std::vector<BodyFrame>& robots,
                                         const std::vector<RobotSensors>& radios,
                                         const std::vector<RadioBeacon>& beacons = {},
                                         const Occluders& occluders = {}) {
  SensingPlace place;
  place.robots = robots;
  place.sensors = radios;
  place.occluders = occluders;
  place.beacons = beacons;
  place.signals.resize(robots.size());
  for (std::size_t i = 0; i < robots.size(); ++i) {
    place.signals[i].message[0] = static_cast<std::uint8_t>(i);
  }
  std::vector<std::vector<Message>> heard;
  place.Read(MakeRadios, [&](const SensorReadings& readings) {
    heard.emplace_back(readings.range_and_bearing.begin(), readings.range_and_bearing.end());
  });
  return heard;
}

TEST(Radios, TellRangeBearingAndPayload) {
  const auto heard = Listen({At(0, 0, kPi / 2), At(1, 0)}, {Radio(3.0), Radio(3.0)});
  ASSERT_THAT(heard[0], SizeIs(1));
  EXPECT_DOUBLE_EQ(heard[0][0].range, 1.0);
  EXPECT_NEAR(heard[0][0].Bearing(), -kPi / 2, 1e-12);
  EXPECT_EQ(heard[0][0].payload[0], 1);
  ASSERT_THAT(heard[1], SizeIs(1));
  EXPECT_NEAR(heard[1][0].Bearing(), kPi, 1e-12);
  EXPECT_EQ(heard[1][0].payload[0], 0);
}

TEST(Radios, TheSendersRangeDecides) {
  const auto heard = Listen({At(0, 0), At(2, 0)}, {Radio(1.0), Radio(2.5)});
  EXPECT_THAT(heard[0], SizeIs(1));
  EXPECT_THAT(heard[1], IsEmpty());
  EXPECT_THAT(Listen({At(0, 0), At(3, 0)}, {Radio(3.0), Radio(3.0)})[0], IsEmpty());
}

TEST(Radios, HearInRobotOrderThenBeacons) {
  const auto heard =
      Listen({At(1, 1), At(-1, 0), At(0, 0), At(1, 0)}, {Radio(3.0), Radio(3.0), {}, Radio(3.0)},
             {{.position = {0, -1}, .payload = {77}}});
  ASSERT_THAT(heard[3], SizeIs(2)) << "robot 2 stands between 1 and 3";
  EXPECT_EQ(heard[3][0].payload[0], 0);
  EXPECT_EQ(heard[3][1].payload[0], 77);
  EXPECT_THAT(heard[2], IsEmpty()) << "no radio";
}

TEST(Radios, BodiesBlockOnlyThoseWhoseRadiosSaySo) {
  const std::vector<BodyFrame> robots = {At(0, 0), At(1, 0), At(0.5, 0.05)};
  RobotSensors through = Radio(3.0);
  through.bodies_block_radio = false;
  const auto heard = Listen(robots, {through, Radio(3.0), {}}, {{.position = {1, 0}}});
  EXPECT_THAT(heard[0], SizeIs(2));
  EXPECT_THAT(heard[1], SizeIs(1)) << "the beacon is where robot 1 is";
}

TEST(Radios, BoxesBlock) {
  Occluders wall;
  wall.AddBox(MakeBox({0.5, 0.0}, 0.1, 1.0, 0.0));
  const auto heard = Listen({At(0, 0), At(1, 0)}, {Radio(3.0), Radio(3.0)}, {{.position = {2, 0}}}, wall);
  EXPECT_THAT(heard[0], IsEmpty());
  EXPECT_THAT(heard[1], SizeIs(1)) << "only the beacon";
}

}  // namespace
}  // namespace gauntlet::sim
