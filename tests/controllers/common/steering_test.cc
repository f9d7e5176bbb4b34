#include "controllers/common/steering.h"

#include <cmath>

#include "gtest/gtest.h"
#include "sim/geometry/trigonometry.h"
#include "sim/robot/foot_bot.h"

namespace gauntlet::controllers {
namespace {

using sim::kDegree;
using sim::kPi;

constexpr SteeringThresholds kThresholds = {10.0 * kDegree, 70.0 * kDegree};
constexpr Reactions kReactions = {0.08, 0.785, 10.0 * kDegree, 0.5};

TEST(Steer, DrivesStraightOnWithinTheFirstThreshold) {
  const DriveCommand command = Steer(-9.9 * kDegree, 0.1, kThresholds);
  EXPECT_EQ(command.forward, 0.1);
  EXPECT_EQ(command.turn, 0.0);
}

TEST(Steer, SlowsDownAndTurnsInProportionBetweenTheThresholds) {
  const DriveCommand command = Steer(35.0 * kDegree, 0.1, kThresholds);
  EXPECT_NEAR(command.forward, 0.05, 1e-12);
  EXPECT_NEAR(command.turn, 2.0 * 0.1 * 0.5 / 0.14, 1e-12);
}

TEST(Steer, TurnsOnTheSpotBeyondTheSecondThreshold) {
  const DriveCommand command = Steer(-71.0 * kDegree, 0.1, kThresholds);
  EXPECT_EQ(command.forward, 0.0);
  EXPECT_NEAR(command.turn, -0.2 / 0.14, 1e-12);
}

TEST(Steer, DoesNotTurnPastTheBearingWithinATick) {
  const double bearing = 11.0 * kDegree;
  const DriveCommand command = Steer(bearing, 3.0, kThresholds);
  EXPECT_NEAR(command.turn * sim::kTickSeconds, bearing, 1e-12);
}

TEST(React, KnowsThreeReactions) {
  EXPECT_EQ(React(0.0, kReactions).turn, 0.0);
  EXPECT_EQ(React(0.0, kReactions).forward, 0.08);
  EXPECT_EQ(React(11.0 * kDegree, kReactions).turn, 0.785);
  EXPECT_EQ(React(-11.0 * kDegree, kReactions).turn, -0.785);
}

TEST(React, TowardsADirectionIsTowardsItsBearing) {
  for (const double within_deg : {0.0, 10.0, 100.0}) {
    Reactions reactions = kReactions;
    reactions.straight_within = within_deg * kDegree;
    for (int tenths = -1799; tenths <= 1800; tenths += 7) {
      const double bearing = 0.1 * tenths * kDegree;
      const DriveCommand expected = React(bearing, reactions);
      const DriveCommand command =
          React(0.3 * sim::UnitVector(bearing), sim::UnitVector(reactions.straight_within), reactions);
      EXPECT_EQ(command.forward, expected.forward) << bearing;
      EXPECT_EQ(command.turn, expected.turn) << bearing;
    }
  }
  EXPECT_EQ(React(sim::Vec2::Zero(), {1.0, 0.0}, kReactions).forward, kReactions.speed);
}

TEST(React, HalvesTheSpeedWhileTurningAndStopsForWhatLiesBehind) {
  EXPECT_EQ(React(89.0 * kDegree, kReactions).forward, 0.04);
  EXPECT_EQ(React(91.0 * kDegree, kReactions).forward, 0.0);
  EXPECT_EQ(React(kPi, kReactions).forward, 0.0);
}

TEST(TurnThenDrive, TurnsOnTheSpotUntilTheBearingIsSmall) {
  EXPECT_EQ(TurnThenDrive(0.6, 0.05, 1.5, 0.5).forward, 0.0);
  EXPECT_EQ(TurnThenDrive(0.6, 0.05, 1.5, 0.5).turn, 1.5);
  EXPECT_EQ(TurnThenDrive(-0.4, 0.05, 1.5, 0.5).forward, 0.05);
  EXPECT_EQ(TurnThenDrive(-0.4, 0.05, 1.5, 0.5).turn, -1.5);
}

TEST(TurnThenDrive, EndsOnTheBearing) {
  EXPECT_NEAR(TurnThenDrive(0.03, 0.05, 1.5, 0.5).turn * sim::kTickSeconds, 0.03, 1e-15);
}

}  // namespace
}  // namespace gauntlet::controllers
