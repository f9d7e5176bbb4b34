// Turning aside, the potential field, and what they read from the proximity ring.
// Covers: controllers/common/potential_field.cc, controllers/common/turn_aside.cc
#include <array>
#include <cmath>

#include "controllers/common/potential_field.h"
#include "controllers/common/turn_aside.h"
#include "gtest/gtest.h"
#include "sim/geometry/trigonometry.h"

namespace gauntlet::controllers {
namespace {

using sim::kDegree;

ProximityReadings Hits(std::initializer_list<std::pair<double, double>> bearing_and_distance) {
  ProximityReadings readings{};
  for (const auto& [bearing_deg, distance] : bearing_and_distance) {
    const auto sensor = (std::lround((bearing_deg - 7.5) / 15.0) + 24) % 24;
    readings[static_cast<std::size_t>(sensor)] = ProximityReadingAt(distance);
  }
  return readings;
}

TEST(Proximity, DistanceIsTheInverseOfTheReading) {
  for (const double distance : {0.01, 0.03, 0.06, 0.1}) {
    EXPECT_NEAR(ProximityDistanceOf(ProximityReadingAt(distance)), distance, 1e-12);
  }
}

TEST(Proximity, FrontIsWhatLiesWithinTheAngle) {
  const ProximityReadings readings = Hits({{52.5, 0.05}, {-67.5, 0.02}, {172.5, 0.01}});
  EXPECT_EQ(FrontReading(readings, 60.0 * kDegree), ProximityReadingAt(0.05));
  EXPECT_EQ(FrontReading(readings, 40.0 * kDegree), 0.0);
  EXPECT_EQ(FrontReading(readings, 90.0 * kDegree), ProximityReadingAt(0.02));
}

TEST(Proximity, TheSumPointsAtWhatIsNear) {
  const ProximitySum sum = SumProximity(Hits({{82.5, 0.05}, {97.5, 0.05}}));
  EXPECT_NEAR(sim::AngleOf(sum.sum), 90.0 * kDegree, 1e-12);
  EXPECT_EQ(sum.largest, ProximityReadingAt(0.05));
}

TEST(Proximity, ABodyCanBeLeftOut) {
  const ProximityReadings readings = Hits({{7.5, 0.05}, {-7.5, 0.05}, {97.5, 0.05}});
  const ProximitySum sum = SumProximity(WithoutBodies(readings, std::array{SeenBody{0.22, 0.0}}));
  EXPECT_NEAR(sim::AngleOf(sum.sum), 97.5 * kDegree, 1e-12);
  EXPECT_GT(SumProximity(WithoutBodies(readings, std::array{SeenBody{0.31, 0.0}})).sum.x(), 0.1)
      << "too far to be what was hit";
  EXPECT_GT(SumProximity(WithoutBodies(readings, std::array{SeenBody{0.22, sim::kPi}})).sum.x(), 0.1)
      << "behind";
}

TEST(TurnAside, DoesNothingInTheOpen) {
  TurnAside aside({.near_distance = 0.06, .clear_distance = 0.08, .front_angle = 1.0, .escape_ticks = 3});
  sim::RandomStream random(1, sim::StreamPurpose::kTest);
  EXPECT_FALSE(aside.Next(Hits({{7.5, 0.061}}), random));
  EXPECT_FALSE(aside.Next(Hits({{97.5, 0.01}}), random));
}

TEST(TurnAside, KeepsItsSideWhenTheWayOnIsBlockedToo) {
  TurnAside aside({.near_distance = 0.06,
                   .clear_distance = 0.08,
                   .front_angle = 1.0,
                   .speed = 0.05,
                   .turn_rate = 0.7,
                   .escape_ticks = 3,
                   .random_side = true});
  sim::RandomStream random(1, sim::StreamPurpose::kTest);
  const double side = aside.Next(Hits({{7.5, 0.05}}), random)->turn;
  for (int i = 0; i < 20; ++i) {
    EXPECT_EQ(aside.Next(Hits({}), random)->forward, 0.05);
    EXPECT_EQ(aside.Next(Hits({{7.5, 0.05}}), random)->turn, side);
  }
  for (int i = 0; i < 3; ++i) EXPECT_TRUE(aside.Next(Hits({}), random));
  EXPECT_FALSE(aside.Next(Hits({}), random));
}

constexpr SteeringThresholds kSteering = {10.0 * kDegree, 90.0 * kDegree, 0.7};

TEST(PotentialField, NothingNearRepelsNobody) {
  EXPECT_EQ(Repulsion(SumProximity(Hits({})), {}), sim::Vec2(0.0, 0.0));
  EXPECT_EQ(Repulsion({.sum = {0.05, 0.0}, .largest = 0.05}, {.least_push = 0.1}), sim::Vec2(0.0, 0.0));
}

TEST(PotentialField, RepulsionIsAUnitVectorAwayFromTheObstacle) {
  const sim::Vec2 push = Repulsion(SumProximity(Hits({{7.5, 0.05}, {-7.5, 0.05}})), {});
  EXPECT_NEAR(push.x(), -1.0, 1e-12);
  EXPECT_NEAR(push.y(), 0.0, 1e-12);
}

// Khatib 1986: eta (1/d - 1/d0) / d^2.
TEST(PotentialField, KhatibsLawIsOneAtTheBalanceAndZeroAtItsReach) {
  const PotentialFieldSettings law = {.analytic = true, .reach = 0.10, .balance = 0.05};
  const auto strength = [&](double distance) {
    return Repulsion({.sum = {1.0, 0.0}, .largest = ProximityReadingAt(distance)}, law).norm();
  };
  EXPECT_NEAR(strength(0.05), 1.0, 1e-9);
  EXPECT_NEAR(strength(0.099999), 0.0, 1e-4);
  EXPECT_NEAR(strength(0.025), (40.0 - 10.0) * 1600.0 / ((20.0 - 10.0) * 400.0), 1e-6);
}

TEST(PotentialField, DrivesStraightToTheGoalInTheOpenAndTurnsLeftWhereTheForcesCancel) {
  const DriveCommand open = FollowField(0.1, {0.0, 0.0}, 0.05, kSteering);
  EXPECT_EQ(open.forward, 0.05);
  EXPECT_EQ(open.turn, 0.0);
  const DriveCommand stuck = FollowField(0.0, {-1.0, 0.0}, 0.05, kSteering);
  EXPECT_EQ(stuck.forward, 0.0);
  EXPECT_EQ(stuck.turn, 0.7);
  const DriveCommand beside = FollowField(0.0, sim::UnitVector(90.0 * kDegree), 0.05, kSteering);
  EXPECT_GT(beside.turn, 0.0);
  EXPECT_GT(beside.forward, 0.0);
}

}  // namespace
}  // namespace gauntlet::controllers
