// Covers: sim/sensors/own_motion.cc
#include "controllers/common/odometer.h"

#include <cmath>
#include <vector>

#include "gtest/gtest.h"
#include "sim/geometry/trigonometry.h"
#include "sim/random/random_stream.h"

namespace gauntlet::controllers {
namespace {

class OdometerTest : public ::testing::Test {
 protected:
  void Move(double x, double y, double heading) {
    const sim::RobotState state{.x = x, .y = y, .heading = heading};
    observer_.Record({&state, 1});
  }

  sim::Observer observer_ = sim::Observer(1, 10000);
  sim::Headquarters headquarters_ = sim::Headquarters(observer_);
};

TEST_F(OdometerTest, FollowsAPointThroughAnyMotion) {
  const Odometer odometer = OdometerOf(headquarters_, 0, {{0.5, -0.5}, 0.3});
  sim::Vec2 point(0.0, 0.0);  // where it started
  sim::RandomStream random(3, sim::StreamPurpose::kTest);
  double x = 0.5, y = -0.5, heading = 0.3;
  for (int i = 0; i < 1000; ++i) {
    x += random.Uniform(-0.01, 0.01);
    y += random.Uniform(-0.01, 0.01);
    heading = sim::WrapAngle(heading + random.Uniform(-0.2, 0.2));
    Move(x, y, heading);
    point = AfterMotion(point, odometer());
    const sim::Vec2 world = sim::Vec2(x, y) + point.norm() * sim::UnitVector(heading + sim::AngleOf(point));
    ASSERT_NEAR((world - sim::Vec2(0.5, -0.5)).norm(), 0.0, 1e-9);
  }
}

}  // namespace
}  // namespace gauntlet::controllers
