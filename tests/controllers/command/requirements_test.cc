#include "controllers/command/requirements.h"

#include <gtest/gtest.h>

#include <cmath>

namespace gauntlet::controllers::command {
namespace {

// A kilobot's arena of 0.5 x 0.5 m with its corner in the origin.
sim::TestCase SmallArena() {
  sim::TestCase test_case;
  test_case.side_x = test_case.side_y = 0.5;
  test_case.wall_thickness = 0.01;
  test_case.center = {0.25, 0.25};
  return test_case;
}

Definition Kilobots() {
  Definition definition;
  definition.robot_radius = 0.017;
  definition.points = {{"nest", 0.05, 0.05}, {"food", 0.45, 0.05}, {"water", 0.45, 0.45}};
  return definition;
}

std::string RuleOf(const Definition& definition, const sim::Genome& obstacles = {}) {
  sim::TestCase test_case = SmallArena();
  test_case.obstacles = obstacles;
  const auto violation = CheckValidity(test_case, RequirementsOf(definition));
  return violation ? std::string(NameOf(violation->rule)) : "";
}

TEST(RequirementsTest, RoomAndCellsAreThoseOfTheRobots) {
  Definition definition = Kilobots();
  const sim::ArenaRequirements small = RequirementsOf(definition);
  EXPECT_EQ(small.inflation, 0.017);
  EXPECT_EQ(small.cell_size, 0.0085);
  definition.robot_radius = 0.35;
  EXPECT_EQ(RequirementsOf(definition).inflation, 0.35);
  EXPECT_EQ(RequirementsOf(definition).cell_size, 0.05);
}

TEST(RequirementsTest, APathLeadsFromTheFirstPointToEachOfTheOthers) {
  const sim::ArenaRequirements asked = RequirementsOf(Kilobots());
  EXPECT_TRUE(asked.asks_for_path);
  EXPECT_EQ(asked.start, sim::Vec2(0.05, 0.05));
  EXPECT_EQ(asked.goal, sim::Vec2(0.45, 0.05));
  EXPECT_EQ(asked.further_goals, std::vector<sim::Vec2>{sim::Vec2(0.45, 0.45)});
  EXPECT_EQ(RuleOf(Kilobots()), "");
  EXPECT_EQ(RuleOf(Kilobots(), {{0.25, 0.25, 0.02, 0.4, 0.0}}), "");  // 0.04 m of room beside it
  EXPECT_EQ(RuleOf(Kilobots(), {{0.25, 0.25, 0.02, 0.48, 0.0}}), "no-path");
  EXPECT_EQ(RuleOf(Kilobots(), {{0.25, 0.4, 0.5, 0.02, 0.0}}), "no-path");  // to the third
}

TEST(RequirementsTest, ASinglePointOnlyHasToBeFreeAndWithoutOneNothingDoes) {
  Definition definition = Kilobots();
  const sim::Genome across = {{0.25, 0.25, 0.02, 0.48, 0.0}};
  const sim::Genome on_nest = {{0.05, 0.05, 0.1, 0.1, 0.0}};
  definition.points.resize(1);
  EXPECT_EQ(RuleOf(definition, across), "");
  EXPECT_EQ(RuleOf(definition, on_nest), "start-blocked");
  definition.points.clear();
  EXPECT_EQ(RuleOf(definition, on_nest), "");
  EXPECT_EQ(RequirementsOf(definition).cell_size, sim::OccupancyGrid::kCellSize) << "of no use";
}

TEST(RequirementsTest, ShapesAreDiscsAndTurnedRectangles) {
  Definition definition = Kilobots();
  definition.keep_outs = {{.x = 0.25, .y = 0.25, .radius = 0.05},
                          {.x = 0.1, .y = 0.3, .length = 0.2, .width = 0.02, .degrees = 90.0}};
  const sim::ArenaRequirements asked = RequirementsOf(definition);
  EXPECT_EQ(asked.keep_outs[0].radius, 0.05);
  EXPECT_EQ(asked.keep_outs[0].box.half_extents, sim::Vec2(0.0, 0.0));
  EXPECT_EQ(asked.keep_outs[1].box.half_extents, sim::Vec2(0.1, 0.01));
  EXPECT_EQ(asked.keep_outs[1].box.axis, sim::Vec2(0.0, 1.0));
  EXPECT_EQ(RuleOf(definition), "") << "robots may go there";
  EXPECT_EQ(RuleOf(definition, {{0.3, 0.25, 0.02, 0.02, 0.0}}), "keep-out");
  EXPECT_EQ(RuleOf(definition, {{0.3, 0.3, 0.02, 0.02, 0.0}}), "");
  EXPECT_EQ(RuleOf(definition, {{0.1, 0.38, 0.02, 0.02, 0.0}}), "keep-out");
}

TEST(RequirementsTest, WhatStandsInTheArenaItselfIsInItsWay) {
  Definition definition = Kilobots();
  definition.standing = {{.x = 0.25, .y = 0.25, .length = 0.48, .width = 0.02, .degrees = 90.0}};
  const sim::IncrementalValidity judge(SmallArena(), RequirementsOf(definition));
  ASSERT_TRUE(judge.arena_violation());
  EXPECT_EQ(judge.arena_violation()->message,
            "what stands in the arena itself leaves no path from (0.05, 0.05) to (0.45, 0.05) for a robot's "
            "body");
}

TEST(RequirementsTest, ArenasMayBeSmallAndAnywhere) {
  Definition definition = Kilobots();
  definition.points.clear();
  sim::TestCase test_case = SmallArena();
  test_case.side_x = kLeastArenaSide;
  test_case.center = {-500.0, 500.0};
  EXPECT_FALSE(CheckValidity(test_case, RequirementsOf(definition)));
}

}  // namespace
}  // namespace gauntlet::controllers::command
