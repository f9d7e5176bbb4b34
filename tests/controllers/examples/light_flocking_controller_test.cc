#include "controllers/examples/light_flocking_controller.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <vector>

#include "controllers/examples/light_flocking_registry.h"
#include "controllers/registry.h"
#include "sim/geometry/trigonometry.h"

namespace gauntlet::controllers::light_flocking {
namespace {

using sim::Blob;
using sim::Color;
using sim::kDegree;

LightFlockingSettings Defaults() {
  return LightFlockingParameters().Read(*ResolveParameters(LightFlockingParameters().infos(), {}));
}

double ForceAhead(double range) {
  return FlockingVelocity(std::vector<Blob>{Blob::At(range, 0.0, Color::kRed)}, Defaults()).x();
}

TEST(FlockingVelocity, VanishesAtTheTargetRepelsNearerAndAttractsFarther) {
  EXPECT_NEAR(ForceAhead(0.75), 0.0, 1e-15);
  // gain / d * (r^2 - r^4) with r = target / d: 1000 / 100 * (0.5625 - 0.31640625) = 2.4609375 cm/s.
  EXPECT_NEAR(ForceAhead(1.0), 0.024609375, 1e-12);
  EXPECT_NEAR(ForceAhead(0.2), -0.1, 1e-12) << "clamped to the maximum speed";
}

TEST(FlockingVelocity, OnlyRedBlobsWithinTheCutoffCount) {
  EXPECT_EQ(ForceAhead(1.35), 0.0);
  EXPECT_GT(ForceAhead(1.349), 0.0);
  EXPECT_TRUE(
      FlockingVelocity(std::vector<Blob>{Blob::At(0.3, 0.0, Color::kYellow)}, Defaults()).isZero(0.0));
  EXPECT_TRUE(FlockingVelocity({}, Defaults()).isZero(0.0));
}

TEST(FlockingVelocity, IsTheMeanOfTheForcesBeforeItIsClamped) {
  const std::vector<Blob> blobs = {Blob::At(1.0, 0.0, Color::kRed), Blob::At(1.0, sim::kPi / 2, Color::kRed),
                                   Blob::At(2.0, 1.0, Color::kRed)};
  const sim::Vec2 velocity = FlockingVelocity(blobs, Defaults());
  EXPECT_NEAR(velocity.x(), 0.024609375 / 2.0, 1e-12);
  EXPECT_NEAR(velocity.y(), 0.024609375 / 2.0, 1e-12);
}

TEST(LightVelocity, HasAQuarterOfTheMaximumSpeedWhateverTheBrightness) {
  std::array<double, 24> readings{};
  EXPECT_TRUE(LightVelocity(readings, Defaults()).isZero(0.0));
  readings[5] = 0.01;  // 82.5 degrees
  const sim::Vec2 velocity = LightVelocity(readings, Defaults());
  EXPECT_NEAR(velocity.norm(), 0.025, 1e-12);
  EXPECT_NEAR(sim::AngleOf(velocity), 82.5 * kDegree, 1e-12);
}

// One robot, one blob: steps with the blob at `bearing_deg`, 1 m away, so that it is driven towards it at
// 2.4609375 cm/s.
class Robot {
 public:
  void See(double bearing_deg) {
    blobs_ = {Blob::At(1.0, bearing_deg * kDegree, Color::kRed)};
    sim::SensorReadings readings;
    readings.blobs = blobs_;
    sim::RandomStream random(1, sim::StreamPurpose::kController, 0, 0);
    controller_.Step({.tick = 0, .readings = readings, .actuators = actuators_, .random = random});
  }
  double left() const { return actuators_.left_wheel; }
  double right() const { return actuators_.right_wheel; }
  const LightFlockingController& controller() const { return controller_; }
  const sim::Actuators& actuators() const { return actuators_; }

 private:
  LightFlockingController controller_{Defaults()};
  std::vector<Blob> blobs_;
  sim::Actuators actuators_;
};

constexpr double kSpeed = 0.024609375;

TEST(LightFlockingController, GoesStraightUpToTenDegreesAndLightsItsBeaconRed) {
  Robot robot;
  robot.See(9.9);
  EXPECT_NEAR(robot.left(), kSpeed, 1e-12);
  EXPECT_NEAR(robot.right(), kSpeed, 1e-12);
  EXPECT_EQ(robot.actuators().beacon, Color::kRed);
}

TEST(LightFlockingController, TurnsOnTheSpotBeyondNinetyDegrees) {
  Robot robot;
  robot.See(91.0);
  EXPECT_EQ(robot.left(), -0.1);
  EXPECT_EQ(robot.right(), 0.1);
  robot.See(-91.0);
  EXPECT_EQ(robot.left(), 0.1);
  EXPECT_EQ(robot.right(), -0.1);
}

TEST(LightFlockingController, TurnsOnAnArcBetweenTenAndNinetyDegrees) {
  Robot robot;
  robot.See(72.0);
  EXPECT_EQ(robot.controller().turning(), Turning::kSoft);
  EXPECT_NEAR(robot.left(), kSpeed * (1.0 - 0.8), 1e-12);
  EXPECT_NEAR(robot.right(), kSpeed * (1.0 + 0.8), 1e-12);
  robot.See(-45.0);
  EXPECT_NEAR(robot.left(), kSpeed * 1.5, 1e-12);
  EXPECT_NEAR(robot.right(), kSpeed * 0.5, 1e-12);
  robot.See(10.0);
  EXPECT_EQ(robot.controller().turning(), Turning::kNone);
}

TEST(LightFlockingController, ATurnOnTheSpotGoesOnDownToSeventyDegrees) {
  Robot robot;
  robot.See(91.0);
  robot.See(71.0);
  EXPECT_EQ(robot.controller().turning(), Turning::kHard);
  robot.See(70.0);
  EXPECT_EQ(robot.controller().turning(), Turning::kSoft);
  robot.See(71.0);
  EXPECT_EQ(robot.controller().turning(), Turning::kSoft) << "an arc stays an arc up to ninety";
}

}  // namespace
}  // namespace gauntlet::controllers::light_flocking
