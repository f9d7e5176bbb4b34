#include "study/sets/failure_mechanism.h"

#include <gtest/gtest.h>

namespace gauntlet {
namespace {

using Metrics = std::vector<std::pair<std::string, double>>;

controllers::ScenarioInfo Scenario(bool lost_is_failure = true) {
  return {.name = "toy",
          .description = "",
          .default_controller = "",
          .style = {.lost_is_failure = lost_is_failure},
          .metrics = {},
          .failures = {.kinds = {{"taken", 0.0, "no item was taken"}}}};
}

// From the start at (-2, 0) in steps of so many metres along x, 20 of them.
sim::RobotSummary Driven(double step, bool lost = true) {
  sim::RobotSummary robot{.lost = lost};
  for (int i = 0; i <= 20; ++i) robot.waypoints.emplace_back(-2.0 + step * i, 0.0);
  return robot;
}

std::string Mechanism(const std::vector<sim::RobotSummary>& robots, const sim::TestCase& test_case = {},
                      const controllers::ScenarioInfo& scenario = Scenario(), const Metrics& metrics = {}) {
  return MechanismOf(scenario, test_case, metrics, robots);
}

TEST(FailureMechanismTest, IsWhatMostLostRobotsDid) {
  EXPECT_EQ(Mechanism({Driven(0.04), Driven(0.04), Driven(0.2)}), "stood still in the open");
  EXPECT_EQ(Mechanism({Driven(0.06), Driven(0.04), Driven(0.07)}), "stayed near the start")
      << "1.4 m of an arena of 6 m";
  EXPECT_EQ(Mechanism({Driven(0.08), Driven(0.04), Driven(0.2)}), "lost far from the start") << "1.6 m";
  EXPECT_EQ(Mechanism({Driven(0.2), Driven(0.04, /*lost=*/false), Driven(0.04, /*lost=*/false)}),
            "lost far from the start")
      << "those that were not lost do not count";
}

TEST(FailureMechanismTest, OfWhoStoodStillItMattersWhetherObstaclesWereThere) {
  sim::TestCase wall;
  wall.obstacles.push_back({.x = -2.0, .y = 0.2, .length = 1.0, .width = 0.1});
  EXPECT_EQ(Mechanism({Driven(0.0)}, wall), "stood still at obstacles");
  wall.obstacles[0].y = 1.0;
  EXPECT_EQ(Mechanism({Driven(0.0)}, wall), "stood still in the open");
}

TEST(FailureMechanismTest, WhereNobodyIsLostAllRobotsCount) {
  EXPECT_EQ(Mechanism({Driven(0.2, false), Driven(0.2, false), Driven(0.0, false)}), "kept driving");
  EXPECT_EQ(Mechanism({Driven(0.2, true), Driven(0.0, false), Driven(0.0, false)}, {}, Scenario(false)),
            "stood still in the open")
      << "being lost is not what fails here";
}

TEST(FailureMechanismTest, WhatTheScenarioDeclaresComesFirst) {
  EXPECT_EQ(Mechanism({Driven(0.0)}, {}, Scenario(), {{"taken", 0.0}}), "no item was taken");
  EXPECT_EQ(Mechanism({Driven(0.0)}, {}, Scenario(), {{"taken", 1.0}}), "stood still in the open");
}

TEST(FailureMechanismTest, IsNotKnownWithoutWaypoints) {
  EXPECT_EQ(Mechanism({sim::RobotSummary{.lost = true}}), "");
  EXPECT_EQ(Mechanism({}), "");
}

}  // namespace
}  // namespace gauntlet
