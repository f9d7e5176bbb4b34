#include "sim/sensors/light_sensor.h"
#include "tests/support/make_box.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace gauntlet::sim {
namespace {

using testing::Each;

const Vec2 kOrigin = Vec2::Zero();

LightReadings Read(const std::vector<Light>& lights, const Occluders& occluders = {}, double heading = 0.0) {
  const std::vector<BodyFrame> robots = {BodyFrame(Pose{kOrigin, heading})};
  return SenseLight(robots, 0, lights, occluders);
}

// Measured in ARGoS (tests/golden/argos/sensors): intensity 3, height 0.5, bearing 0.
TEST(LightSensor, FallsWithDistanceAsInArgos) {
  const std::vector<std::pair<double, double>> measured = {
      {0.5, 0.5721}, {1.0, 0.4350}, {2.0, 0.2319}, {5.0, 0.0322}};
  for (const auto& [distance, reading] : measured) {
    const LightReadings readings = Read({{.position = {distance, 0.0}, .intensity = 3.0}});
    EXPECT_NEAR(readings[0], reading, 5e-5) << distance << " m";
    EXPECT_NEAR(readings[0], readings[23], 1e-12);
    EXPECT_EQ(readings[12], 0.0);
  }
  EXPECT_GT(Read({{.position = {7.4, 0.0}, .intensity = 3.0}})[0], 0.0);
  EXPECT_THAT(Read({{.position = {7.5, 0.0}, .intensity = 3.0}}), Each(0.0));
}

TEST(LightSensor, AddsLampsUpToOne) {
  const Light lamp = {.position = {0.0, 0.5}, .intensity = 3.0};
  EXPECT_NEAR(Read({lamp, lamp})[5], 2.0 * Read({lamp})[5] > 1.0 ? 1.0 : 2.0 * Read({lamp})[5], 1e-12);
  EXPECT_EQ(Read({lamp, lamp, lamp})[5], 1.0);
  EXPECT_THAT(Read({{.position = {0.0, 0.5}, .color = Color::kRed}}), Each(0.0)) << "no intensity";
}

TEST(LightSensor, TurnsWithTheRobot) {
  const Light lamp = {.position = {-1.0, 0.0}, .intensity = 3.0};
  const LightReadings ahead = Read({{.position = {1.0, 0.0}, .intensity = 3.0}});
  const LightReadings turned = Read({lamp}, {}, kPi);
  for (std::size_t i = 0; i < ahead.size(); ++i) EXPECT_NEAR(turned[i], ahead[i], 1e-12);
}

TEST(LightSensor, OnlyAnOccludableLampIsHidden) {
  Occluders wall;
  wall.AddBox(MakeBox({0.5, 0.0}, 0.1, 1.0, 0.0));
  Light lamp = {.position = {1.0, 0.0}, .intensity = 3.0};
  EXPECT_THAT(Read({lamp}, wall), Each(0.0));
  lamp.occludable = false;
  EXPECT_EQ(Read({lamp}, wall), Read({lamp}));
}

}  // namespace
}  // namespace gauntlet::sim
