#include "cli/adopt/adopted_experiment.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "search/experiment/command_table.h"

namespace gauntlet {
namespace {

using testing::HasSubstr;

ArenaBody Body(const std::string& id, double x, double y, double half) {
  return {id, "e-puck", true, true, x, y, x - half, x + half, y - half, y + half};
}

AdoptedProject Project() {
  AdoptedProject project;
  project.name = "mine";
  project.argos_file = "mine.argos";
  project.own = "mine.adopted";
  project.environment = {"PATH=/opt/my argos/bin:/bin"};
  project.form.arena = {{-10.0, -10.0}, {10.0, 10.0}};
  project.form.parameters = {{"speed", 2.5}, {"turn", -0.5}, {"off", 0.0}};
  project.form.boxes["wall"] = {1.0, 2.0, 3.0, 0.1, 45.0};
  project.score = "log:items: (\\d+)";
  project.scores = {9.0, 9.0};
  project.robots = {Body("a", 0.0, 0.0, 0.04), Body("b", 1.0, 0.0, 0.05)};
  project.fixed = {Body("a", 0.0, 0.0, 0.04)};
  project.poses = {{0.0, 0.0}, {3.0, 1.0}};
  return project;
}

TEST(AdoptedExperimentTest, IsARightCommand) {
  AdoptedProject project = Project();
  ArenaBody wall = Body("wall", 1.0, 2.0, 1.2);
  wall.kind = "box";
  project.standing = {wall};
  const std::string text = AdoptedExperimentText(project);
  const auto read = ReadCommand({text, "mine.toml"}, {});
  ASSERT_TRUE(read.ok()) << read.error().message;
  const controllers::command::Definition& command = **read;
  EXPECT_EQ(command.failure, "score < 6.75");
  EXPECT_EQ(command.setup, "export PATH='/opt/my argos/bin:/bin'");
  EXPECT_EQ(command.robot_radius, 0.05);
  ASSERT_EQ(command.parameters.size(), 3U);
  EXPECT_EQ(command.parameters[1].min, -5.0);
  EXPECT_EQ(command.parameters[1].max, 0.0);
  EXPECT_EQ(command.parameters[2].max, 1.0);
  ASSERT_EQ(command.keep_outs.size(), 1U);
  EXPECT_NEAR(command.keep_outs[0].length, 0.1, 1e-12);
  // Not its bounding box.
  ASSERT_EQ(command.standing.size(), 1U);
  EXPECT_EQ(command.standing[0].length, 3.0);
  EXPECT_EQ(command.standing[0].degrees, 45.0);
}

TEST(AdoptedExperimentTest, OnlyKilobotsAreNotConfined) {
  AdoptedProject project = Project();
  EXPECT_TRUE((**ReadCommand({AdoptedExperimentText(project), "mine.toml"}, {})).confine);
  project.robots[1].kind = "kilobot";
  EXPECT_FALSE((**ReadCommand({AdoptedExperimentText(project), "mine.toml"}, {})).confine);
}

TEST(AdoptedExperimentTest, AFailureIsWhatChanceDoesNotBringAbout) {
  AdoptedProject project = Project();
  project.scores = {8.0, 9.0, 10.0, 9.0};  // 9 - 4.541 * 0.8165 * sqrt(1.25)
  EXPECT_THAT(AdoptedExperimentText(project), HasSubstr("failure = \"score < 4.855\""));
  project.scores = {6.0};
  EXPECT_THAT(AdoptedExperimentText(project), HasSubstr("failure = \"score < 4.5\""));
  project.scores = {-4.0, -4.0};
  EXPECT_THAT(AdoptedExperimentText(project), HasSubstr("failure = \"score < -5\""));
  EXPECT_TRUE(ReadCommand({AdoptedExperimentText(project), "mine.toml"}, {}).ok());
  project.scores = {0.0, 0.0};
  EXPECT_TRUE(ReadCommand({AdoptedExperimentText(project), "mine.toml"}, {}).ok());
}

TEST(AdoptedExperimentTest, ObstaclesLieWhereRobotsWent) {
  const sim::Rectangle area = ObstacleArea(Project());
  EXPECT_EQ(area.min, sim::Vec2(-1.0, -1.0));
  EXPECT_EQ(area.max, sim::Vec2(4.0, 2.0));
  AdoptedProject small = Project();
  small.form.arena = {{-0.3, -0.3}, {0.3, 0.3}};
  EXPECT_EQ(ObstacleArea(small).max, sim::Vec2(0.3, 0.3));
  EXPECT_NEAR(ObstacleStep(ObstacleArea(small)), 0.02, 1e-12);
  EXPECT_NEAR(ObstacleStep(area), 0.1, 1e-12);
}

TEST(AdoptedExperimentTest, AnObstacleInTheWayTouchesNothingAtTheBeginning) {
  const AdoptedProject project = Project();
  TrialRun run;
  run.bodies = {Body("a", 0.0, 0.0, 0.05)};
  for (int i = 0; i < 9; ++i) run.poses.push_back({0.0, 0.0});
  for (int i = 0; i < 3; ++i) run.poses.push_back({2.02, 1.02});
  run.poses.push_back({3.0, 0.0});
  const auto obstacle = ObstacleInTheWay(project, run);
  ASSERT_TRUE(obstacle);
  EXPECT_NEAR(obstacle->x, 2.05, 1e-9);
  EXPECT_NEAR(obstacle->y, 1.05, 1e-9);
  run.poses.resize(9);
  EXPECT_FALSE(ObstacleInTheWay(project, run));
}

}  // namespace
}  // namespace gauntlet
