#include "controllers/partitioning/bug_walk.h"

#include <optional>
#include <vector>

#include "gtest/gtest.h"
#include "sim/geometry/trigonometry.h"
#include "sim/sensors/proximity.h"

namespace gauntlet::controllers {
namespace {

using sim::kDegree;

constexpr BugSettings kBug = {.speed = 0.05,
                              .goal_angle = 25.0 * kDegree,
                              .meet_distance = 0.10,
                              .wall_distance = 0.08,
                              .wall_gain = 4.0,
                              .wall_turn = 0.5,
                              .front_angle = 35.0 * kDegree,
                              .front_distance = 0.06,
                              .turn_rate = 0.7,
                              .lost_turn = 0.6,
                              .clear_ticks = 3};

// What it sees, angles in degrees; a scan of 12 rays that meet nothing.
struct Sight {
  std::vector<sim::ScannerReading> rays;
  std::vector<SeenBody> bodies;
  BugView view;

  Sight() {
    for (int i = 0; i < 12; ++i) rays.push_back({.bearing = sim::WrapAngle(i * 30.0 * kDegree)});
    view.goal_distance = 2.0;
  }
  Sight& Goal(double bearing, double distance = 2.0) {
    view.goal_bearing = bearing * kDegree;
    view.goal_distance = distance;
    return *this;
  }
  Sight& Near(double bearing, double distance) {
    const auto sensor = (std::lround((bearing - 7.5) / 15.0) + 24) % 24;
    view.proximity[static_cast<std::size_t>(sensor)] = ProximityReadingAt(distance);
    return *this;
  }
  Sight& Ray(int number, double distance) {
    rays[static_cast<std::size_t>(number)].distance = distance;
    return *this;
  }
  Sight& Robot(double range, double bearing) {
    bodies.push_back({range, bearing * kDegree});
    return *this;
  }
};

std::optional<DriveCommand> Next(BugWalk& bug, Sight sight) {
  sight.view.scan = sight.rays;
  sight.view.bodies = sight.bodies;
  return bug.Next(sight.view);
}

BugWalk Following() {
  BugWalk bug(kBug);
  EXPECT_TRUE(Next(bug, Sight().Near(7.5, 0.05)));
  EXPECT_TRUE(bug.following());
  return bug;
}

TEST(BugWalk, FollowsOnlyWhatLiesInTheWay) {
  BugWalk bug(kBug);
  EXPECT_FALSE(Next(bug, Sight().Near(37.5, 0.01)));
  EXPECT_FALSE(Next(bug, Sight().Goal(90.0).Near(7.5, 0.01)));
  EXPECT_TRUE(Next(bug, Sight().Goal(90.0).Near(97.5, 0.09)));
}

TEST(BugWalk, TurnsLeftAtWhatIsInFront) {
  BugWalk bug = Following();
  const auto command = Next(bug, Sight().Near(7.5, 0.05).Near(-22.5, 0.05));
  EXPECT_EQ(command->forward, 0.0);
  EXPECT_EQ(command->turn, 0.7);
}

TEST(BugWalk, KeepsItsDistanceToTheObstacleOnTheRight) {
  BugWalk bug = Following();
  EXPECT_NEAR(Next(bug, Sight().Goal(-90.0).Near(-97.5, 0.05))->turn, 4.0 * 0.03, 1e-9);
  EXPECT_NEAR(Next(bug, Sight().Goal(-90.0).Near(-97.5, 0.095))->turn, -4.0 * 0.015, 1e-9);
  EXPECT_NEAR(Next(bug, Sight().Goal(-90.0).Ray(9, 0.25))->turn, -0.5, 1e-9);
  EXPECT_NEAR(Next(bug, Sight().Goal(-90.0).Near(-97.5, 0.08))->forward, 0.045, 1e-12);
}

TEST(BugWalk, TurnsRightRoundTheEndOfTheObstacle) {
  BugWalk bug = Following();
  const auto command = Next(bug, Sight().Goal(90.0).Ray(3, 0.2));
  EXPECT_NEAR(command->turn, -0.6, 1e-12);
  EXPECT_NEAR(command->forward, 0.03, 1e-12);
}

TEST(BugWalk, LeavesWhenTheWayToTheGoalIsSeenClearForAWhile) {
  BugWalk bug = Following();
  const Sight clear = Sight().Goal(60.0).Near(-97.5, 0.08);
  EXPECT_TRUE(Next(bug, clear));
  EXPECT_TRUE(Next(bug, clear));
  EXPECT_TRUE(Next(bug, Sight(clear).Ray(2, 0.25))) << "something between";
  EXPECT_TRUE(Next(bug, clear));
  EXPECT_TRUE(Next(bug, clear));
  EXPECT_FALSE(Next(bug, clear));
  EXPECT_FALSE(bug.following());
}

TEST(BugWalk, WhatLiesBeyondTheGoalDoesNotMatter) {
  BugWalk bug = Following();
  const Sight near_goal = Sight().Goal(60.0, 0.25).Near(-97.5, 0.08).Ray(2, 0.2);
  Next(bug, near_goal);
  Next(bug, near_goal);
  EXPECT_FALSE(Next(bug, near_goal));
}

TEST(BugWalk, RobotsAreNoObstacles) {
  BugWalk bug = Following();
  const Sight robot_between = Sight().Goal(60.0).Near(-97.5, 0.08).Ray(2, 0.2).Robot(0.37, 60.0);
  Next(bug, robot_between);
  Next(bug, robot_between);
  EXPECT_FALSE(Next(bug, robot_between));
}

TEST(BugWalk, WaitsForTheScannerBeforeItLeaves) {
  BugWalk bug = Following();
  Sight blind = Sight().Goal(60.0);
  blind.rays.clear();
  for (int i = 0; i < 10; ++i) EXPECT_TRUE(Next(bug, blind));
}

}  // namespace
}  // namespace gauntlet::controllers
