#include "controllers/partitioning/nest_light.h"

#include <cmath>

#include "gtest/gtest.h"
#include "sim/sensors/light_sensor.h"

namespace gauntlet::controllers {
namespace {

using sim::kPi;

TEST(NestLight, TellsBearingAndDistanceOfTheLampEverywhere) {
  const sim::Arena arena(sim::TestCase{});
  const sim::Occluders occluders(arena);
  sim::Light lamp;
  lamp.position = {0.0, -2.0};
  lamp.height = 1.0;
  lamp.intensity = 3.0;
  lamp.occludable = false;
  sim::RandomStream random(1, sim::StreamPurpose::kTest);
  for (int i = 0; i < 500; ++i) {
    const double x = random.Uniform(-2.8, 2.8);
    const double y = random.Uniform(-2.8, 2.8);
    const double heading = random.Uniform(-kPi, kPi);
    const sim::BodyFrame frame({{x, y}, heading});
    const auto nest = ReadLamp(sim::SenseLight({&frame, 1}, 0, {&lamp, 1}, occluders), {1.0, 3.0});
    ASSERT_TRUE(nest.has_value());
    const sim::Vec2 offset = lamp.position - sim::Vec2(x, y);
    EXPECT_NEAR(nest->distance, offset.norm(), 1e-6);
    EXPECT_NEAR(sim::WrapAngle(nest->bearing - (sim::AngleOf(offset) - heading)), 0.0, 1e-9);
  }
}

TEST(NestLight, DarknessTellsNothing) {
  EXPECT_FALSE(ReadLamp({}, {1.0, 3.0}).has_value());
}

}  // namespace
}  // namespace gauntlet::controllers
