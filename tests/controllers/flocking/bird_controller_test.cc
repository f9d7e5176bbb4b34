#include "controllers/flocking/bird_controller.h"

#include <cmath>
#include <memory>
#include <vector>

#include "controllers/common/proximity.h"
#include "controllers/flocking/flocking_registry.h"
#include "gtest/gtest.h"
#include "sim/geometry/trigonometry.h"
#include "sim/simulation.h"
#include "tests/support/toy_scenario.h"

namespace gauntlet::controllers {
namespace {

using sim::Blob;
using sim::Color;
using sim::kDegree;
using sim::kPi;

constexpr double kSpeed = 0.08;
constexpr double kTurnRate = 45.0 * kDegree;

BirdSettings Original() {
  BirdSettings settings;
  settings.speed = kSpeed;
  settings.turn_rate = kTurnRate;
  settings.straight_within = 10.0 * kDegree;
  settings.turning_speed_factor = 0.5;
  settings.obstacle_distance = 0.10;
  settings.obstacle_speed_factor = 0.5;
  settings.separation_distance = 0.25;
  settings.wander = {0.05, 115.0 * kDegree};
  return settings;
}

BirdSettings Improved() {
  BirdSettings settings = Original();
  settings.catch_up_distance = 0.3;
  settings.catch_up_gain = 2.0;
  return settings;
}

Blob Bird(double range, double bearing_deg) {
  return Blob::At(range, bearing_deg * kDegree, Color::kRed);
}
Blob Prey(double range, double bearing_deg) {
  return Blob::At(range, bearing_deg * kDegree, Color::kBlue);
}
// The sensor that looks at `bearing_deg`, one of +-7.5, +-22.5, ...
int SensorAt(double bearing_deg) {
  return (static_cast<int>(std::lround((bearing_deg - 7.5) / 15.0)) + 24) % 24;
}
// A proximity ray's hit at `distance` m from the body.
struct Hit {
  double bearing_deg;
  double distance;
};

struct Decision {
  double forward;
  double turn;
  Color beacon;
};

Decision Decide(const BirdSettings& settings, const std::vector<Blob>& blobs,
                const std::vector<Hit>& hits = {}) {
  BirdController bird(settings);
  sim::SensorReadings readings;
  readings.blobs = blobs;
  for (const Hit& hit : hits) {
    const int sensor = SensorAt(hit.bearing_deg);
    readings.proximity[static_cast<std::size_t>(sensor)] = ProximityReadingAt(hit.distance);
    readings.proximity_hits |= 1u << sensor;
  }
  sim::Actuators actuators;
  sim::RandomStream random(1, sim::StreamPurpose::kTest);
  bird.Step({1, readings, actuators, random});
  return {(actuators.left_wheel + actuators.right_wheel) / 2.0,
          (actuators.right_wheel - actuators.left_wheel) / sim::foot_bot::kWheelDistance, actuators.beacon};
}

void ExpectDrive(const Decision& decision, double forward, double turn) {
  EXPECT_NEAR(decision.forward, forward, 1e-12);
  EXPECT_NEAR(decision.turn, turn, 1e-12);
}

TEST(BirdController, ChasesThePreyWhateverTheFlockDoes) {
  const Decision decision = Decide(Original(), {Bird(0.5, -80), Bird(0.6, -70), Prey(1.2, 50)});
  ExpectDrive(decision, 0.5 * kSpeed, kTurnRate);
}

TEST(BirdController, DrivesStraightOnWithinTenDegreesOfThePrey) {
  ExpectDrive(Decide(Original(), {Prey(1.2, -9.5)}), kSpeed, 0.0);
  ExpectDrive(Decide(Original(), {Prey(1.2, -10.5)}), 0.5 * kSpeed, -kTurnRate);
}

TEST(BirdController, TurnsOnTheSpotForAPreyBehind) {
  ExpectDrive(Decide(Original(), {Prey(1.2, 100)}), 0.0, kTurnRate);
}

TEST(BirdController, FlocksToTheMeanPositionNotTheMeanBearing) {
  // Mean position of (1, 0) and (0, 0.3) lies at 16.7 degrees, the mean bearing would be 45.
  const Decision towards_mean = Decide(Original(), {Bird(1.0, 0), Bird(0.3, 90)});
  ExpectDrive(towards_mean, 0.5 * kSpeed, kTurnRate);
  // (1, 0) and 0.3 m at 30 degrees: 6.8 degrees, the mean bearing would be 15.
  ExpectDrive(Decide(Original(), {Bird(1.0, 0), Bird(0.30, 30)}), kSpeed, 0.0);
}

TEST(BirdController, WandersWhenNobodyIsVisible) {
  const Decision decision = Decide(Original(), {});
  ExpectDrive(decision, kSpeed, 0.0);
  EXPECT_EQ(decision.beacon, Color::kRed);
}

TEST(BirdController, WanderingTurnsAsFarAsItDrew) {
  BirdSettings settings = Original();
  settings.wander.turn_probability = 1.0;
  BirdController bird(settings);
  sim::SensorReadings readings;
  sim::Actuators actuators;
  sim::RandomStream random(1, sim::StreamPurpose::kTest);
  bird.Step({1, readings, actuators, random});
  sim::RandomStream same(1, sim::StreamPurpose::kTest);
  ASSERT_TRUE(same.Chance(1.0));
  const double drawn = same.Uniform(-115.0 * kDegree, 115.0 * kDegree);
  const double turn = (actuators.right_wheel - actuators.left_wheel) / sim::foot_bot::kWheelDistance;
  EXPECT_NEAR(turn, std::copysign(kTurnRate, drawn), 1e-12);
}

TEST(BirdController, GoesOnWithATurnUntilItsAngleWhateverItSees) {
  BirdSettings settings = Original();
  settings.turn_angle = 30.0 * kDegree;  // at 45 degrees/s: 6.7 ticks, so 7
  BirdController bird(settings);
  sim::RandomStream random(1, sim::StreamPurpose::kTest);
  const auto turn_with = [&](const std::vector<Blob>& blobs) {
    sim::SensorReadings readings;
    readings.blobs = blobs;
    sim::Actuators actuators;
    bird.Step({1, readings, actuators, random});
    EXPECT_EQ(actuators.beacon, Color::kRed);
    return actuators.right_wheel > actuators.left_wheel;
  };
  EXPECT_FALSE(turn_with({Prey(1.0, 0)}));
  EXPECT_TRUE(turn_with({Prey(1.0, 12)}));
  for (int tick = 2; tick <= 7; ++tick) EXPECT_TRUE(turn_with({Prey(1.0, 0)})) << tick;
  EXPECT_FALSE(turn_with({Prey(1.0, 0)}));
}

TEST(BirdController, IgnoresLightsThatAreNoRobots) {
  const Blob lamp = Blob::At(0.2, 0.0, Color::kYellow);
  ExpectDrive(Decide(Original(), {lamp}), kSpeed, 0.0);
}

// Rule 2.
TEST(BirdController, TurnsAwayFromARobotThatIsTooNear) {
  const Decision ahead = Decide(Original(), {Prey(1.0, 0), Bird(0.24, 20)});
  ExpectDrive(ahead, 0.0, -kTurnRate);
  ExpectDrive(Decide(Original(), {Prey(1.0, 0), Bird(0.26, 20)}), kSpeed, 0.0);
}

TEST(BirdController, KeepsMovingWhenTheNearRobotIsBesideIt) {
  const Decision beside = Decide(Original(), {Prey(1.0, 0), Bird(0.24, -60)});
  ExpectDrive(beside, 0.5 * kSpeed, kTurnRate);
}

TEST(BirdController, TurnsAwayFromThePreyItselfWhenItIsTooNear) {
  const Decision decision = Decide(Original(), {Prey(0.2, -30)});
  ExpectDrive(decision, 0.0, kTurnRate);
}

TEST(BirdController, LeavesARobotBehindAlone) {
  ExpectDrive(Decide(Original(), {Prey(1.0, 0), Bird(0.2, 100)}), kSpeed, 0.0);
}

TEST(BirdController, LeavesANearRobotAloneWhenTheGoalLiesTheOtherWay) {
  // 100 degrees between the near robot and the prey: going to the prey is separation enough.
  ExpectDrive(Decide(Original(), {Prey(1.0, -60), Bird(0.2, 40)}), 0.5 * kSpeed, -kTurnRate);
  ExpectDrive(Decide(Original(), {Prey(1.0, -49), Bird(0.2, 40)}), 0.0, -kTurnRate);
}

TEST(BirdController, ANearerRobotBehindDoesNotHideTheOneInFront) {
  ExpectDrive(Decide(Original(), {Prey(1.0, 0), Bird(0.18, 170), Bird(0.22, 10)}), 0.0, -kTurnRate);
}

// Rule 1.
TEST(BirdController, AvoidsAnObstacleBeforeAnythingElse) {
  const Decision decision = Decide(Original(), {Prey(0.8, 0), Bird(0.24, -20)}, {{37.5, 0.03}});
  // goal (1, 0) + away (-cos 37.5, -sin 37.5) points to -71 degrees; half speed beside obstacles.
  ExpectDrive(decision, 0.25 * kSpeed, -kTurnRate);
}

TEST(BirdController, DrivesAtHalfSpeedBetweenObstaclesThatBalance) {
  const std::vector<Hit> corridor = {{82.5, 0.05}, {97.5, 0.05}, {-82.5, 0.05}, {-97.5, 0.05}};
  const Decision decision = Decide(Original(), {Prey(0.8, 0)}, corridor);
  ExpectDrive(decision, 0.5 * kSpeed, 0.0);
}

TEST(BirdController, TurnsLeftOfAwayWhenTheObstacleStandsInTheWayOfTheGoal) {
  // away = (-1, 0), goal = (1, 0): the sum vanishes; left of away is (0, -1).
  const Decision decision = Decide(Original(), {Prey(0.8, 0)}, {{7.5, 0.05}, {-7.5, 0.05}});
  EXPECT_NEAR(decision.turn, -kTurnRate, 1e-12);
}

TEST(BirdController, TakesStraightAheadAsTheGoalWhenNobodyIsVisible) {
  const Decision decision = Decide(Original(), {}, {{-52.5, 0.05}});
  ExpectDrive(decision, 0.25 * kSpeed, kTurnRate);
}

TEST(BirdController, LetsObstaclesBehindBe) {
  ExpectDrive(Decide(Original(), {Prey(0.8, 0)}, {{112.5, 0.02}, {172.5, 0.02}}), kSpeed, 0.0);
}

TEST(BirdController, TakesAHitOnARobotsBodyForARobot) {
  // A robot at 0.2 m and bearing 30: rays within asin(0.10 / 0.2) = 30 degrees are its body.
  ExpectDrive(Decide(Original(), {Prey(1.0, -70), Bird(0.2, 30)}, {{22.5, 0.03}}), 0.5 * kSpeed, -kTurnRate);
  ExpectDrive(Decide(Original(), {Prey(1.0, -70), Bird(0.2, 30)}, {{52.5, 0.05}}), 0.5 * kSpeed, -kTurnRate);
  ExpectDrive(Decide(Original(), {Prey(1.0, -70), Bird(0.2, 30)}, {{67.5, 0.05}}), 0.0, -kTurnRate);
  ExpectDrive(Decide(Original(), {Prey(1.0, -70), Bird(0.31, 30)}, {{22.5, 0.05}}), 0.0, -kTurnRate);
}

TEST(BirdController, TakesTouchingNeighboursForRobotsOverTheirWholeWidth) {
  // Bodies that touch subtend 60 degrees, more than a fixed window of +-20 degrees.
  ExpectDrive(Decide(Original(), {Prey(1.0, -80), Bird(0.17, 60)}, {{37.5, 0.01}, {82.5, 0.01}}),
              0.5 * kSpeed, -kTurnRate);
}

TEST(BirdController, HeedsObstaclesOnlyWithinTheObstacleDistance) {
  BirdSettings settings = Original();
  settings.obstacle_distance = 0.05;
  ExpectDrive(Decide(settings, {Prey(1.0, 0)}, {{22.5, 0.06}}), kSpeed, 0.0);
  ExpectDrive(Decide(settings, {Prey(1.0, 0)}, {{22.5, 0.04}}), 0.25 * kSpeed, -kTurnRate);
}

// The improved bird (thesis 4.7.2).
TEST(BirdController, ImprovedBirdHurriesWhenTheNearestRobotInFrontIsFar) {
  ExpectDrive(Decide(Improved(), {Prey(1.0, 0)}), 2.0 * kSpeed, 0.0);
  ExpectDrive(Decide(Improved(), {Prey(1.0, 40)}), kSpeed, 2.0 * kTurnRate);
  ExpectDrive(Decide(Improved(), {Prey(1.0, 0), Bird(0.29, 55)}), kSpeed, 0.0);
  ExpectDrive(Decide(Improved(), {Prey(1.0, 0), Bird(0.29, 65)}), 2.0 * kSpeed, 0.0);
}

TEST(BirdController, ImprovedBirdDoesNotHurryWithNobodyInFront) {
  ExpectDrive(Decide(Improved(), {Prey(1.0, 100)}), 0.0, kTurnRate);
  const Decision wandering = Decide(Improved(), {});
  EXPECT_LE(wandering.forward, kSpeed + 1e-12);
}

TEST(BirdController, ImprovedBirdHurriesPastObstaclesToo) {
  ExpectDrive(Decide(Improved(), {Prey(0.8, 0)}, {{37.5, 0.03}}), 0.5 * kSpeed, -2.0 * kTurnRate);
}

TEST(BirdController, ImprovedBirdIsTheOriginalOneWhenNobodyInFrontIsFar) {
  for (double bearing = -175.0; bearing < 180.0; bearing += 10.0) {
    const std::vector<Blob> blobs = {Bird(0.28, 5), Prey(0.9, bearing)};
    const Decision original = Decide(Original(), blobs);
    const Decision improved = Decide(Improved(), blobs);
    ExpectDrive(improved, original.forward, original.turn);
  }
}

// Thesis 7.4: robots take an obstacle with a light of their colour for a flockmate and anchor at it.
TEST(BirdControllerTest, ALightOnAnObstacleIsCountedAsANeighbour) {
  // It stands to the left.
  const auto turns = [](Color light) {
    sim::TestCase test_case;
    test_case.obstacles = {{0.7, 0.7, 0.2, 0.4, 0.0}};
    test_case.obstacles[0].light = light;
    BirdController bird(Original());
    bool turns_left = false;
    sim::ToyRobot robot = {.pose = {{0.0, 0.0}, 0.0}, .behaviour = [&](const sim::ControlStep& step) {
                             bird.Step(step);
                             turns_left = step.actuators.left_wheel < step.actuators.right_wheel;
                           }};
    sim::ToyScenario scenario(test_case, {robot}, 3);
    sim::Simulate(scenario, 1, false);
    return turns_left;
  };
  EXPECT_TRUE(turns(kBirdColor));
  EXPECT_TRUE(turns(kPreyColor));
  EXPECT_FALSE(turns(Color::kGreen));
  EXPECT_FALSE(turns(Color::kBlack));
}

}  // namespace
}  // namespace gauntlet::controllers
