#include "sim/sensors/range_and_bearing.h"
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

// What each robot hears; robot i says i in its first byte.
std::vector<std::vector<Message>> Listen(const std::vector<BodyFrame>& robots,
                                         const std::vector<Radios::Radio>& radios,
                                         const std::vector<RadioBeacon>& beacons = {},
                                         Occluders occluders = {}) {
  std::vector<RobotPairs::Reach> reaches;
  std::vector<Signals> signals(robots.size());
  for (std::size_t i = 0; i < robots.size(); ++i) {
    reaches.push_back({.radio = radios[i].range});
    signals[i].message[0] = static_cast<std::uint8_t>(i);
  }
  occluders.Frame(robots);
  RobotPairs pairs(reaches);
  pairs.Update(robots, occluders, false);
  Radios all(radios);
  all.Listen(
      {.robots = robots, .occluders = occluders, .pairs = pairs, .signals = signals, .beacons = beacons});
  std::vector<std::vector<Message>> heard;
  for (std::size_t i = 0; i < robots.size(); ++i) {
    const auto messages = all.MessagesOf(static_cast<RobotIndex>(i));
    heard.emplace_back(messages.begin(), messages.end());
  }
  return heard;
}

TEST(Radios, TellRangeBearingAndPayload) {
  const auto heard = Listen({At(0, 0, kPi / 2), At(1, 0)}, {{.range = 3.0}, {.range = 3.0}});
  ASSERT_THAT(heard[0], SizeIs(1));
  EXPECT_DOUBLE_EQ(heard[0][0].range, 1.0);
  EXPECT_NEAR(heard[0][0].Bearing(), -kPi / 2, 1e-12);
  EXPECT_EQ(heard[0][0].payload[0], 1);
  ASSERT_THAT(heard[1], SizeIs(1));
  EXPECT_NEAR(heard[1][0].Bearing(), kPi, 1e-12);
  EXPECT_EQ(heard[1][0].payload[0], 0);
}

TEST(Radios, TheSendersRangeDecides) {
  const auto heard = Listen({At(0, 0), At(2, 0)}, {{.range = 1.0}, {.range = 2.5}});
  EXPECT_THAT(heard[0], SizeIs(1));
  EXPECT_THAT(heard[1], IsEmpty());
  EXPECT_THAT(Listen({At(0, 0), At(3, 0)}, {{.range = 3.0}, {.range = 3.0}})[0], IsEmpty());
}

TEST(Radios, HearInRobotOrderThenBeacons) {
  const auto heard =
      Listen({At(1, 1), At(-1, 0), At(0, 0), At(1, 0)}, {{.range = 3.0}, {.range = 3.0}, {}, {.range = 3.0}},
             {{.position = {0, -1}, .payload = {77}}});
  ASSERT_THAT(heard[3], SizeIs(2)) << "robot 2 stands between 1 and 3";
  EXPECT_EQ(heard[3][0].payload[0], 0);
  EXPECT_EQ(heard[3][1].payload[0], 77);
  EXPECT_THAT(heard[2], IsEmpty()) << "no radio";
}

TEST(Radios, BodiesBlockOnlyThoseWhoseRadiosSaySo) {
  const std::vector<BodyFrame> robots = {At(0, 0), At(1, 0), At(0.5, 0.05)};
  const Radios::Radio through = {.range = 3.0, .bodies_block = false};
  const auto heard = Listen(robots, {through, {.range = 3.0}, {}}, {{.position = {1, 0}}});
  EXPECT_THAT(heard[0], SizeIs(2));
  EXPECT_THAT(heard[1], SizeIs(1)) << "the beacon is where robot 1 is";
}

TEST(Radios, BoxesBlock) {
  Occluders wall;
  wall.AddBox(MakeBox({0.5, 0.0}, 0.1, 1.0, 0.0));
  const auto heard =
      Listen({At(0, 0), At(1, 0)}, {{.range = 3.0}, {.range = 3.0}}, {{.position = {2, 0}}}, wall);
  EXPECT_THAT(heard[0], IsEmpty());
  EXPECT_THAT(heard[1], SizeIs(1)) << "only the beacon";
}

}  // namespace
}  // namespace gauntlet::sim
