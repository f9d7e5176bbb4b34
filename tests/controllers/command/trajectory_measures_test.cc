#include "controllers/command/trajectory_measures.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/controllers/command/command_definitions.h"

namespace gauntlet::controllers::command {
namespace {

using testing::Contains;
using testing::Not;

// Two robots for 2 s: one stands at the goal, the other comes from 2 m away at 1 m/s.
std::vector<std::vector<sim::RobotState>> Meeting() {
  std::vector<std::vector<sim::RobotState>> trajectory;
  for (int tick = 0; tick <= 20; ++tick)
    trajectory.push_back({{.x = 11.0, .y = 1.0}, {.x = 13.0 - 0.1 * tick, .y = 1.0, .heading = 3.0}});
  return trajectory;
}

TEST(TrajectoryMeasures, AreThoseOfGenericInTheProgramsCoordinates) {
  const Definition definition =
      DefinitionWith({{"point", nlohmann::json::array({{{"name", "goal"}, {"x", 11}, {"y", 1}}})}});
  sim::RunSpec spec;
  spec.test_case.center = {12.0, 1.0};
  const auto measured = TrajectoryMeasures(definition, spec, Meeting());
  EXPECT_DOUBLE_EQ(measured.at("center_x"), 11.0);
  EXPECT_DOUBLE_EQ(measured.at("center_x_max"), 12.0);
  EXPECT_EQ(measured.at("robots_in_goal"), 2.0);
  EXPECT_EQ(measured.at("robots_in_goal_min"), 1.0);
  EXPECT_EQ(measured.at("largest_cluster_min"), 1.0);
  EXPECT_NEAR(measured.at("path_length"), 1.0, 1e-9);
  EXPECT_NEAR(measured.at("displacement"), 1.0, 1e-9);
  for (const std::string& name : TrajectoryMeasureNames()) EXPECT_EQ(measured.count(name), 1U) << name;
}

// A program may tell once a second where its robots are; between, they are taken to stand.
TEST(TrajectoryMeasures, SpeedsAreThoseOfASecond) {
  std::vector<std::vector<sim::RobotState>> trajectory;
  for (int tick = 0; tick <= 40; ++tick) trajectory.push_back({{.x = 0.1 * (tick / 10), .y = 0.0}});
  const auto measured = TrajectoryMeasures(DefinitionWith({}), {}, trajectory);
  EXPECT_NEAR(measured.at("speed"), 0.1, 1e-9);
  EXPECT_NEAR(measured.at("speed_max"), 0.1, 1e-9);
}

TEST(TrajectoryMeasures, LeaveOutWhatNeedsMoreThanPositions) {
  EXPECT_THAT(TrajectoryMeasureNames(), Contains("dispersion_mean"));
  EXPECT_THAT(TrajectoryMeasureNames(), Not(Contains("collisions")));
  EXPECT_THAT(TrajectoryMeasureNames(), Not(Contains("items_brought")));
}

}  // namespace
}  // namespace gauntlet::controllers::command
