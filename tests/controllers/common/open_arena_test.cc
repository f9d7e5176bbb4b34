#include "controllers/common/open_arena.h"

#include <gtest/gtest.h>

namespace gauntlet::controllers {
namespace {

using sim::Vec2;

constexpr OpenArena kOpenArena = {.robots = 20, .corner_distance = 0.5, .open_share = 0.75};

TEST(OpenArena, AsksForAPathFromCornerToCornerAndForRoom) {
  sim::TestCase test_case;
  test_case.side_x = 8.0;
  const sim::ArenaRequirements asked = kOpenArena.Requirements(test_case);
  EXPECT_EQ(asked.start, Vec2(3.5, 2.5));
  EXPECT_EQ(asked.goal, Vec2(-3.5, -2.5));
  EXPECT_EQ(asked.open_share, 0.75);
}

TEST(StartPoses, AreThoseOfTheTestCaseOrDrawnInTheArea) {
  sim::TestCase test_case;
  const sim::Rectangle area{{1.0, 1.0}, {2.5, 2.5}};
  const auto drawn = StartPoses(test_case, 20, area, {2.5, 2.5}, 7);
  ASSERT_TRUE(drawn.ok());
  ASSERT_EQ(drawn->size(), 20U);
  for (const sim::Pose& pose : *drawn) {
    EXPECT_TRUE((pose.position.array() >= 1.0).all() && (pose.position.array() <= 2.5).all());
  }
  test_case.robots = 1;
  EXPECT_EQ(StartPoses(test_case, 20, area, {2.5, 2.5}, 7)->size(), 1U);
  test_case.start_poses = {{{-1.0, 0.5}, 0.25}};
  EXPECT_EQ(StartPoses(test_case, 20, area, {2.5, 2.5}, 7)->front().position, Vec2(-1.0, 0.5));
  const auto refused = StartPoses({}, 0, area, {2.5, 2.5}, 7);
  ASSERT_FALSE(refused.ok());
  EXPECT_EQ(refused.error().message, "swarm-size: 0 robots; from 1 to 1000 can be tested");
}

// Two robots: the first drives for `moving` ticks at 0.1 m/s, the second stands.
sim::Observer Recorded(sim::Tick ticks, sim::Tick moving) {
  sim::Observer observer(2, ticks);
  for (sim::Tick tick = 0; tick <= ticks; ++tick) {
    const std::vector<sim::RobotState> states = {{.x = 0.01 * std::min(tick, moving)}, {.x = 1.0}};
    observer.Record(states);
  }
  return observer;
}

TEST(LastSeconds, AreOnePerSecondUpToTheEnd) {
  EXPECT_EQ(LastSeconds(Recorded(55, 0), 30), (std::vector<sim::Tick>{25, 35, 45, 55}));
  EXPECT_EQ(LastSeconds(Recorded(15, 0), 30), (std::vector<sim::Tick>{5, 15})) << "the run was shorter";
}

TEST(IsStuck, WhoKeptToItsPlaceForTheLastMinute) {
  const sim::Observer run = Recorded(900, 290);
  EXPECT_TRUE(IsStuck(run, 1));
  EXPECT_TRUE(IsStuck(run, 0)) << "it stopped 61 s before the end";
  EXPECT_FALSE(IsStuck(Recorded(900, 320), 0));
  EXPECT_FALSE(IsStuck(Recorded(500, 0), 1)) << "a run of less than a minute";
}

TEST(PositionsAt, AreThoseOfTheTick) {
  EXPECT_EQ(PositionsAt(Recorded(5, 5), 3), (std::vector<Vec2>{{0.03, 0.0}, {1.0, 0.0}}));
}

TEST(PlaceOf, NamesTheNinthsOfTheArena) {
  const sim::Arena arena{sim::TestCase{}};
  EXPECT_EQ(NameOfPlace(PlaceOf({-2.9, -2.9}, arena)), "lower left");
  EXPECT_EQ(NameOfPlace(PlaceOf({2.9, -2.9}, arena)), "lower right");
  EXPECT_EQ(NameOfPlace(PlaceOf({0.0, 0.0}, arena)), "middle");
  EXPECT_EQ(NameOfPlace(PlaceOf({5.0, 5.0}, arena)), "upper right") << "what lies beyond belongs to the edge";
}

}  // namespace
}  // namespace gauntlet::controllers
