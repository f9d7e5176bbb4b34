#include "controllers/foraging/foraging_controller.h"

#include <cmath>
#include <vector>

#include "controllers/foraging/foraging_registry.h"
#include "controllers/registry.h"
#include "gtest/gtest.h"
#include "sim/geometry/trigonometry.h"

namespace gauntlet::controllers {
namespace {

using sim::kDegree;
using sim::kPi;
using State = ForagingState;

constexpr double kSpeed = 0.05;
constexpr double kTurnRate = 0.714;

using Table = ParameterTable<ForagerSettings>;

ForagerSettings SettingsOf(const Table& table, const sim::Parameters& given = {}) {
  return table.Read(*ResolveParameters(table.infos(), given));
}

// VP without chance: it becomes and leaves a beacon at once, and never turns by itself.
ForagerSettings Certain(const Table& table = ForagerParameters()) {
  ForagerSettings settings = SettingsOf(table);
  settings.wander.turn_probability = 0.0;
  if (settings.beacons) settings.beacons->become_chance = settings.beacons->leave_chance = 1.0;
  return settings;
}

// Hand-made readings of one tick.
struct Scene {
  std::vector<sim::Blob> blobs;
  std::vector<sim::Message> messages;
  sim::SensorReadings readings;

  Scene() { readings.motor_ground.fill(1.0); }
  Scene& Food(double range, double bearing_deg = 0.0) {
    blobs.push_back(sim::Blob::At(range, bearing_deg * kDegree, kFoodColor));
    return *this;
  }
  Scene& Hear(double range, double bearing_deg, const RadioMessage& message) {
    messages.push_back(sim::Message::At(range, bearing_deg * kDegree, Encode(message)));
    return *this;
  }
  Scene& Nest(double range, double bearing_deg = 0.0) {
    return Hear(range, bearing_deg, {.sender = RadioMessage::Sender::kNest});
  }
  // Levels as staleness, -ln(phi).
  Scene& Beacon(double range, double bearing_deg = 0.0, double to_nest = kNoPheromone,
                double to_food = kNoPheromone) {
    return Hear(range, bearing_deg,
                {.sender = RadioMessage::Sender::kRobot,
                 .state = State::kBeacon,
                 .first = static_cast<float>(to_nest),
                 .second = static_cast<float>(to_food)});
  }
  Scene& Forager(double range, bool carrying, double seconds) {
    return Hear(range, 0.0,
                {.sender = RadioMessage::Sender::kRobot,
                 .state = carrying ? State::kHoming : State::kWandering,
                 .carrying = carrying,
                 .first = static_cast<float>(seconds)});
  }
  Scene& InNest() {
    readings.motor_ground.fill(0.0);
    return *this;
  }
  Scene& HalfInNest() {
    readings.motor_ground = {0.0, 1.0, 1.0, 0.0};
    return *this;
  }
  Scene& Carrying() {
    readings.holding_item = true;
    return *this;
  }
  // The sensor at `bearing_deg`, one of +-7.5, +-22.5, ..., hits something at `distance` m.
  Scene& Hit(double bearing_deg, double distance) {
    const auto sensor = (std::lround((bearing_deg - 7.5) / 15.0) + 24) % 24;
    readings.proximity[static_cast<std::size_t>(sensor)] = ProximityReadingAt(distance);
    readings.proximity_hits |= 1u << sensor;
    return *this;
  }
};

// Two beacons without pheromone, so that nobody has to become one.
Scene Covered() {
  return Scene().Beacon(2.0).Beacon(2.5);
}

class Robot {
 public:
  explicit Robot(const ForagerSettings& settings)
      : controller_(settings, {.communication_range = 3.0, .pickup_distance = 0.335}) {}

  State Step(Scene scene) {
    scene.readings.blobs = scene.blobs;
    scene.readings.range_and_bearing = scene.messages;
    sim::RandomStream random(7, sim::StreamPurpose::kTest, 0, static_cast<std::uint32_t>(tick_));
    controller_.Step({tick_++, scene.readings, actuators_, random});
    return controller_.state();
  }
  State Step(const Scene& scene, int ticks) {
    for (int i = 1; i < ticks; ++i) Step(scene);
    return Step(scene);
  }
  double forward() const { return (actuators_.left_wheel + actuators_.right_wheel) / 2.0; }
  double turn() const {
    return (actuators_.right_wheel - actuators_.left_wheel) / sim::foot_bot::kWheelDistance;
  }
  bool gripper_closed() const { return actuators_.gripper_closed; }
  RadioMessage says() const { return Decode(actuators_.message); }
  const ForagingController& controller() const { return controller_; }

  // Into a state, by the shortest way.
  Robot& Follow() {
    EXPECT_EQ(Step(Scene().Nest(2.0).Beacon(1.0, 0.0, 1.0, 1.0)), State::kFollowing);
    return *this;
  }
  Robot& Gather() {
    EXPECT_EQ(Step(Covered().Food(1.0)), State::kGathering);
    return *this;
  }
  Robot& Home() {
    Gather();
    EXPECT_EQ(Step(Scene().Food(0.3).Carrying()), State::kHoming);
    return *this;
  }
  Robot& FollowHome() {
    Home();
    EXPECT_EQ(Step(Scene().Beacon(1.0, 0.0, 1.0).Carrying()), State::kFollowingHome);
    return *this;
  }
  Robot& Drop() {
    Home();
    EXPECT_EQ(Step(Scene().InNest().Nest(0.3).Carrying()), State::kDropping);
    return *this;
  }
  Robot& BeBeacon() {
    EXPECT_EQ(Step(Scene().Nest(2.0)), State::kBeacon);
    return *this;
  }

 private:
  ForagingController controller_;
  sim::Actuators actuators_;
  sim::Tick tick_ = 0;
};

// --- Wandering ---

TEST(Wandering, GoesStraightOnWhileTwoBeaconsAreInRange) {
  Robot robot(Certain());
  EXPECT_EQ(robot.Step(Covered(), 50), State::kWandering);
  EXPECT_NEAR(robot.forward(), kSpeed, 1e-12);
  EXPECT_NEAR(robot.turn(), 0.0, 1e-12);
}

TEST(Wandering, GathersWhenFoodIsInSightWhateverElseIsInRange) {
  EXPECT_EQ(Robot(Certain()).Step(Scene().Food(1.5)), State::kGathering);
  EXPECT_EQ(Robot(Certain()).Step(Covered().Food(1.5).Beacon(1.0, 0.0, 1.0, 1.0)), State::kGathering);
}

TEST(Wandering, BecomesABeaconWithFewerThanTwoInRangeTheNestIncluded) {
  EXPECT_EQ(Robot(Certain()).Step(Scene()), State::kBeacon);
  EXPECT_EQ(Robot(Certain()).Step(Scene().Nest(1.0)), State::kBeacon);
  EXPECT_EQ(Robot(Certain()).Step(Scene().Beacon(1.0, 0.0, 1.0, 1.0)), State::kBeacon);
  EXPECT_EQ(Robot(Certain()).Step(Scene().Nest(1.0).Beacon(1.0)), State::kWandering);
  EXPECT_EQ(Robot(Certain()).Step(Covered()), State::kWandering);
}

TEST(Wandering, RobotsThatAreNoBeaconsDoNotCount) {
  EXPECT_EQ(Robot(Certain()).Step(Scene().Nest(1.0).Forager(0.5, false, 3.0)), State::kBeacon);
}

TEST(Wandering, BecomesNoBeaconInsideTheNest) {
  EXPECT_EQ(Robot(Certain()).Step(Scene().Nest(0.2).InNest()), State::kWandering);
  EXPECT_EQ(Robot(Certain()).Step(Scene().Nest(0.5).HalfInNest()), State::kBeacon);
}

TEST(Wandering, BecomesABeaconByChance) {
  ForagerSettings settings = Certain();
  settings.beacons->become_chance = 0.1;
  int beacons = 0;
  Robot fixed(settings);
  int ticks = 0;
  while (fixed.Step(Scene().Nest(1.0)) != State::kBeacon && ticks < 1000) ++ticks;
  beacons = ticks;
  EXPECT_GT(beacons, 0);
  EXPECT_LT(beacons, 100);
  settings.beacons->become_chance = 0.0;
  EXPECT_EQ(Robot(settings).Step(Scene(), 100), State::kWandering);
}

TEST(Wandering, FollowsABeaconThatKnowsTheFood) {
  EXPECT_EQ(Robot(Certain()).Step(Covered().Beacon(1.0, 0.0, 1.0, 1.0)), State::kFollowing);
  // 0.001 = exp(-6.9078)
  EXPECT_EQ(Robot(Certain()).Step(Covered().Beacon(1.0, 0.0, 1.0, 6.9)), State::kFollowing);
  EXPECT_EQ(Robot(Certain()).Step(Covered().Beacon(1.0, 0.0, 1.0, 6.91)), State::kWandering);
}

// --- Following ---

TEST(Following, DrivesToTheBeaconWithMostPheromoneTowardsTheFood) {
  Robot robot(Certain());
  const Scene scene = Scene().Beacon(1.0, 120.0, 0.1, 2.0).Beacon(2.0, -120.0, 5.0, 0.5);
  EXPECT_EQ(robot.Step(scene), State::kFollowing);
  EXPECT_EQ(robot.Step(scene), State::kFollowing);
  EXPECT_NEAR(robot.forward(), 0.0, 1e-12);
  EXPECT_NEAR(robot.turn(), -kTurnRate, 1e-12);
}

TEST(Following, GathersWhenFoodIsInSight) {
  EXPECT_EQ(Robot(Certain()).Follow().Step(Covered().Food(1.5)), State::kGathering);
}

TEST(Following, BecomesABeaconWithFewerThanTwoInRange) {
  EXPECT_EQ(Robot(Certain()).Follow().Step(Scene().Beacon(1.0, 0.0, 1.0, 1.0)), State::kBeacon);
}

TEST(Following, WandersWhenTheNetworkIsDisconnected) {
  EXPECT_EQ(Robot(Certain()).Follow().Step(Covered()), State::kWandering);
}

TEST(Following, GivesUpAtABeaconWithoutFoodInSightAndIsBarredForAWhile) {
  const Scene reached = Scene().Nest(1.0).Beacon(0.39, 0.0, 1.0, 1.0);
  Robot robot(Certain());
  robot.Follow();
  EXPECT_EQ(robot.Step(Scene().Nest(1.0).Beacon(0.41, 0.0, 1.0, 1.0)), State::kFollowing);
  EXPECT_EQ(robot.Step(reached), State::kWandering);
  EXPECT_EQ(robot.Step(reached, 199), State::kWandering);
  EXPECT_EQ(robot.Step(reached), State::kFollowing);
}

// --- Gathering ---

TEST(Gathering, DrivesToTheFoodAndClosesTheGripperThere) {
  Robot robot(Certain());
  EXPECT_EQ(robot.Step(Covered().Food(1.0, 5.0)), State::kGathering);
  EXPECT_NEAR(robot.forward(), kSpeed, 1e-12);
  EXPECT_FALSE(robot.gripper_closed());
  EXPECT_EQ(robot.Step(Covered().Food(0.336)), State::kGathering);
  EXPECT_FALSE(robot.gripper_closed());
  EXPECT_EQ(robot.Step(Covered().Food(0.335), 1000), State::kGathering);
  EXPECT_EQ(robot.forward(), 0.0);
  EXPECT_EQ(robot.turn(), 0.0);
  EXPECT_TRUE(robot.gripper_closed());
}

TEST(Gathering, GoesHomeTheOtherWayRoundWithAnItem) {
  Robot robot(Certain());
  robot.Gather();
  EXPECT_EQ(robot.Step(Scene().Food(0.3).Carrying()), State::kHoming);
  EXPECT_TRUE(robot.gripper_closed());
  double turned = 0.0;
  for (int tick = 0; tick < 100 && robot.turn() != 0.0; ++tick) {
    EXPECT_EQ(robot.forward(), 0.0) << "turns on the spot";
    turned += robot.turn() * sim::kTickSeconds;
    robot.Step(Scene().Carrying());
    if (std::fabs(turned) > kPi / 2.0) break;
  }
  EXPECT_GT(std::fabs(turned), kPi / 2.0);
}

TEST(Gathering, WandersWhenTheFoodIsOutOfSightForLongerThanItsMemory) {
  Robot robot(Certain());
  robot.Gather();
  EXPECT_EQ(robot.Step(Covered(), 20), State::kGathering);
  EXPECT_EQ(robot.Step(Covered()), State::kWandering);
}

// --- Homing ---

TEST(Homing, NeverBecomesABeacon) {
  EXPECT_EQ(Robot(Certain()).Home().Step(Scene().Carrying(), 300), State::kHoming);
}

TEST(Homing, DropsInTheNest) {
  EXPECT_EQ(Robot(Certain()).Home().Step(Scene().InNest().Carrying()), State::kDropping);
  EXPECT_EQ(Robot(Certain()).Home().Step(Scene().HalfInNest().Carrying()), State::kHoming);
}

TEST(Homing, FollowsTheNestOrABeaconThatKnowsIt) {
  EXPECT_EQ(Robot(Certain()).Home().Step(Scene().Nest(2.9).Carrying()), State::kFollowingHome);
  EXPECT_EQ(Robot(Certain()).Home().Step(Scene().Beacon(2.0, 0.0, 13.8).Carrying()), State::kFollowingHome);
  // 1e-6 = exp(-13.816)
  EXPECT_EQ(Robot(Certain()).Home().Step(Scene().Beacon(2.0, 0.0, 13.82).Carrying()), State::kHoming);
  EXPECT_EQ(Robot(Certain()).Home().Step(Scene().Beacon(2.0, 0.0, kNoPheromone, 0.1).Carrying()),
            State::kHoming);
}

// --- F-Homing ---

TEST(FollowingHome, PrefersTheNestToAnyBeacon) {
  Robot robot(Certain());
  robot.FollowHome();
  EXPECT_EQ(robot.Step(Scene().Beacon(1.0, -120.0, -0.02).Nest(2.0, 120.0).Carrying()),
            State::kFollowingHome);
  EXPECT_NEAR(robot.turn(), kTurnRate, 1e-12);
}

TEST(FollowingHome, DrivesToTheBeaconWithMostPheromoneTowardsTheNest) {
  Robot robot(Certain());
  robot.FollowHome();
  robot.Step(Scene().Beacon(1.0, 120.0, 0.1, 2.0).Beacon(2.0, -120.0, 5.0, 0.5).Carrying());
  EXPECT_NEAR(robot.turn(), kTurnRate, 1e-12);
}

TEST(FollowingHome, DropsInTheNest) {
  EXPECT_EQ(Robot(Certain()).FollowHome().Step(Scene().Nest(0.4).InNest().Carrying()), State::kDropping);
}

TEST(FollowingHome, SearchesAloneWhenTheNetworkIsDisconnected) {
  EXPECT_EQ(Robot(Certain()).FollowHome().Step(Scene().Carrying()), State::kHoming);
  EXPECT_EQ(Robot(Certain()).FollowHome().Step(Covered().Carrying()), State::kHoming);
}

TEST(FollowingHome, GivesUpAtABeaconWithoutTheNestInRangeAndIsBarredFromBeaconsForAWhile) {
  const Scene reached = Scene().Beacon(0.39, 0.0, 1.0).Carrying();
  Robot robot(Certain());
  robot.FollowHome();
  EXPECT_EQ(robot.Step(Scene().Beacon(0.41, 0.0, 1.0).Carrying()), State::kFollowingHome);
  EXPECT_EQ(robot.Step(reached), State::kHoming);
  EXPECT_EQ(robot.Step(reached, 199), State::kHoming);
  EXPECT_EQ(robot.Step(reached), State::kFollowingHome);
  EXPECT_EQ(robot.Step(reached), State::kHoming);
  EXPECT_EQ(robot.Step(Scene(reached).Nest(2.0)), State::kFollowingHome) << "the nest is never barred";
  EXPECT_EQ(robot.Step(Scene(reached).Nest(2.0)), State::kFollowingHome);
}

// --- Dropping ---

TEST(Dropping, OpensTheGripperAndStands) {
  Robot robot(Certain());
  robot.Drop();
  EXPECT_FALSE(robot.gripper_closed());
  EXPECT_EQ(robot.forward(), 0.0);
  EXPECT_EQ(robot.turn(), 0.0);
}

TEST(Dropping, WandersTheOtherWayRoundWhenTheItemIsGone) {
  Robot robot(Certain());
  robot.Drop();
  EXPECT_EQ(robot.Step(Covered().InNest().Carrying()), State::kDropping);
  EXPECT_EQ(robot.Step(Covered().InNest()), State::kWandering);
  EXPECT_EQ(robot.forward(), 0.0);
  EXPECT_NEAR(std::fabs(robot.turn()), kTurnRate, 1e-12);
}

// --- Beacon ---

TEST(Beacon, StandsWhileAtMostTwoOthersAreInRange) {
  Robot robot(Certain());
  robot.BeBeacon();
  EXPECT_EQ(robot.Step(Scene().Nest(2.0).Beacon(1.0).Food(1.0).Hit(7.5, 0.01), 100), State::kBeacon);
  EXPECT_EQ(robot.forward(), 0.0);
  EXPECT_EQ(robot.turn(), 0.0);
}

TEST(Beacon, LeavesByChanceWithMoreThanTwoOthersInRange) {
  const Scene crowded = Scene().Nest(2.0).Beacon(1.0).Beacon(1.5);
  EXPECT_EQ(Robot(Certain()).BeBeacon().Step(crowded), State::kWandering);
  ForagerSettings settings = Certain();
  settings.beacons->leave_chance = 0.0;
  EXPECT_EQ(Robot(settings).BeBeacon().Step(crowded, 100), State::kBeacon);
  EXPECT_NEAR(SettingsOf(ForagerParameters()).beacons->leave_chance, 0.01, 1e-15) << "0.1 per second";
}

TEST(Beacon, StartsWithItsOwnTrailAndEvaporates) {
  Robot robot(Certain());
  robot.Step(Covered(), 300);  // 30 s out of the nest
  robot.Step(Scene());
  ASSERT_EQ(robot.controller().state(), State::kBeacon);
  EXPECT_NEAR(robot.says().first, 30.1 / 60.0, 1e-7);
  EXPECT_EQ(robot.says().second, kNoPheromone);
  robot.Step(Scene(), 100);
  EXPECT_NEAR(robot.says().first, 30.1 / 60.0 + 10.0 / 300.0, 1e-7);
}

TEST(Beacon, KnowsTheNestItHears) {
  Robot robot(Certain());
  robot.BeBeacon().Step(Scene().Nest(2.0), 50);
  EXPECT_NEAR(robot.says().first, -std::log(1.01), 1e-7);
}

TEST(Beacon, KeepsTheFreshestOfWhatRobotsLay) {
  Robot robot(Certain());
  robot.Step(Scene());
  robot.Step(Scene().Forager(1.0, true, 10.0).Forager(2.0, true, 50.0).Forager(0.5, false, 500.0));
  EXPECT_NEAR(robot.says().second, (10.0 + 1.0 / kSpeed) / 60.0, 1e-7);
  EXPECT_LT(robot.says().first, 0.1) << "its own trail is fresher";
  robot.Step(Scene().Forager(1.0, true, 20.0));
  EXPECT_NEAR(robot.says().second, (10.0 + 1.0 / kSpeed) / 60.0 + 0.1 / 300.0, 1e-7);
  robot.Step(Scene().Beacon(1.0, 0.0, 0.0, 0.0));
  EXPECT_GT(robot.says().second, 0.5) << "beacons lay nothing";
}

TEST(Beacon, ForgetsWhenItLeaves) {
  Robot robot(Certain());
  robot.BeBeacon().Step(Scene().Nest(2.0).Forager(1.0, true, 10.0));
  robot.Step(Scene().Nest(2.0).Beacon(1.0).Beacon(1.5));
  ASSERT_EQ(robot.Step(Scene()), State::kBeacon);
  EXPECT_GT(robot.says().first, 0.0) << "its own trail, not what it heard of the nest";
  EXPECT_EQ(robot.says().second, kNoPheromone);
}

TEST(ForagingController, TellsHowLongAgoItLeftTheNestOrTheFood) {
  Robot robot(Certain());
  robot.Step(Covered().InNest());
  robot.Step(Covered(), 50);
  EXPECT_FALSE(robot.says().carrying);
  EXPECT_NEAR(robot.says().first, 5.0, 1e-6);
  robot.Home();
  robot.Step(Scene().Carrying(), 30);
  EXPECT_TRUE(robot.says().carrying);
  EXPECT_NEAR(robot.says().first, 3.0, 1e-6);
}

// --- Avoidance ---

TEST(Avoidance, VirtualPheromoneTurnsLeftThenDrivesOnThenResumes) {
  Robot robot(Certain());
  const Scene target = Scene().Nest(1.0).Beacon(1.0, 0.0, 1.0, 1.0);
  robot.Step(target);
  robot.Step(Scene(target).Hit(7.5, 0.05));
  EXPECT_EQ(robot.forward(), 0.0);
  EXPECT_NEAR(robot.turn(), kTurnRate, 1e-12);
  robot.Step(Scene(target).Hit(-52.5, 0.079));
  EXPECT_NEAR(robot.turn(), kTurnRate, 1e-12) << "on until nothing is nearer than 0.08 m";
  const Scene aside = Scene().Nest(1.0).Beacon(1.0, -120.0, 1.0, 1.0).Hit(-67.5, 0.03);
  for (int tick = 0; tick < 20; ++tick) {
    robot.Step(aside);
    EXPECT_NEAR(robot.forward(), kSpeed, 1e-12) << tick;
    EXPECT_NEAR(robot.turn(), 0.0, 1e-12) << tick;
  }
  robot.Step(aside);
  EXPECT_NEAR(robot.turn(), -kTurnRate, 1e-12);
}

int LeftTurns(const ForagerSettings& settings) {
  Robot robot(settings);
  int left = 0;
  for (int encounter = 0; encounter < 200; ++encounter) {
    robot.Step(Covered().Hit(7.5, 0.05));
    left += robot.turn() > 0.0 ? 1 : 0;
    const double side = robot.turn();
    robot.Step(Covered().Hit(7.5, 0.05), 5);
    EXPECT_EQ(robot.turn(), side) << "one side per encounter";
    robot.Step(Covered(), 25);
  }
  return left;
}

TEST(Avoidance, TheSideIsRandomOnlyInTheVariantsThatSaySo) {
  EXPECT_EQ(LeftTurns(Certain()), 200);
  EXPECT_EQ(LeftTurns(Certain(BasicForagerParameters())), 200);
  for (const Table* table : {&RandomSideForagerParameters(), &ImprovedForagerParameters()}) {
    const int left = LeftTurns(Certain(*table));
    EXPECT_GT(left, 70) << table->infos().size();
    EXPECT_LT(left, 130) << table->infos().size();
  }
}

TEST(Avoidance, TheImprovedRobotSlidesAlongWhatIsBetweenItAndItsTarget) {
  Robot robot(Certain(ImprovedForagerParameters()));
  const Scene target = Scene().Nest(1.0).Beacon(1.0, 0.0, 1.0, 1.0);
  robot.Step(target);
  robot.Step(Scene(target).Hit(37.5, 0.04));
  EXPECT_LT(robot.turn(), 0.0) << "away from the obstacle on the left";
  EXPECT_GT(robot.forward(), 0.0);
  robot.Step(Scene(target).Hit(-37.5, 0.04));
  EXPECT_GT(robot.turn(), 0.0);
}

TEST(Avoidance, TheImprovedRobotIsNotRepelledByItsTarget) {
  Robot robot(Certain(ImprovedForagerParameters()));
  robot.FollowHome();
  robot.Step(Scene().Nest(1.0, 90.0).Beacon(0.5, 0.0, 1.0).Carrying());
  const Scene touching = Scene().Beacon(0.41, 0.0, 1.0).Carrying();
  robot.Step(touching);
  EXPECT_NEAR(robot.forward(), kSpeed, 1e-12);
}

// --- The basic algorithm ---

TEST(Basic, HasFourStatesOnly) {
  Robot robot(Certain(BasicForagerParameters()));
  EXPECT_EQ(robot.Step(Scene(), 100), State::kWandering) << "never a beacon";
  EXPECT_EQ(robot.Step(Scene().Beacon(1.0, 0.0, 1.0, 1.0), 10), State::kWandering) << "follows nobody";
  EXPECT_EQ(robot.Step(Scene().Food(1.0)), State::kGathering);
  EXPECT_EQ(robot.Step(Scene().Food(0.3).Carrying()), State::kHoming);
  EXPECT_EQ(robot.Step(Scene().Beacon(1.0, 0.0, 1.0, 1.0).Carrying(), 10), State::kHoming);
  EXPECT_EQ(robot.Step(Scene().Nest(1.0).Carrying(), 10), State::kHoming);
  EXPECT_EQ(robot.Step(Scene().InNest().Carrying()), State::kDropping);
  EXPECT_EQ(robot.Step(Scene().InNest()), State::kWandering);
}

TEST(Basic, MovesTowardsTheNestItHears) {
  Robot robot(Certain(BasicForagerParameters()));
  robot.Home();
  robot.Step(Scene().Nest(1.0, 120.0).Carrying());
  EXPECT_NEAR(robot.turn(), kTurnRate, 1e-12);
}

}  // namespace
}  // namespace gauntlet::controllers
