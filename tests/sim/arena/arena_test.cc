#include "sim/arena/arena.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "sim/geometry/ray_cast.h"
#include "sim/geometry/trigonometry.h"
#include "tests/sim/arena/random_arenas.h"

namespace gauntlet::sim {
namespace {

TEST(ObstacleGeneTest, QuarterTurnsGiveExactAxes) {
  const Vec2 axes[] = {{1.0, 0.0}, {0.0, 1.0}, {-1.0, 0.0}, {0.0, -1.0}};
  for (int quarter = -8; quarter <= 8; ++quarter) {
    const OrientedBox box = BoxOf({0.0, 0.0, 1.0, 0.2, 90.0 * quarter});
    EXPECT_EQ(box.axis, axes[((quarter % 4) + 4) % 4]) << quarter;
  }
}

TEST(ObstacleGeneTest, ABoxHasTheGenesPlaceSizeAndAngle) {
  for (int degrees = 0; degrees < 360; ++degrees) {
    const OrientedBox box = BoxOf({1.5, -2.25, 1.4, 0.3, static_cast<double>(degrees)});
    EXPECT_EQ(box.center, Vec2(1.5, -2.25));
    EXPECT_EQ(box.half_extents, Vec2(0.7, 0.15));
    EXPECT_LT((box.axis - UnitVector(degrees * kDegree)).norm(), 1e-15) << degrees;
    EXPECT_LT((BoxOf({1.5, -2.25, 1.4, 0.3, degrees - 360.0}).axis - box.axis).norm(), 1e-15) << degrees;
  }
}

TEST(ArenaTest, WallsStandOnTheirCentreLinesAndLeaveNoGap) {
  TestCase test_case;
  test_case.side_x = 6.0;
  test_case.side_y = 4.0;
  const Arena arena(test_case);
  EXPECT_DOUBLE_EQ(arena.interior_max().x(), 2.95);
  EXPECT_DOUBLE_EQ(arena.interior_max().y(), 1.95);
  EXPECT_EQ(arena.interior_min(), -arena.interior_max());
  ASSERT_EQ(arena.walls().size(), 4u);
  EXPECT_EQ(arena.walls()[0].center, Vec2(0.0, 2.0));
  EXPECT_EQ(arena.walls()[1].center, Vec2(0.0, -2.0));
  EXPECT_EQ(arena.walls()[2].center, Vec2(3.0, 0.0));
  EXPECT_EQ(arena.walls()[3].center, Vec2(-3.0, 0.0));
  for (int degrees = 0; degrees < 360; ++degrees) {
    const Vec2 outside = 10.0 * UnitVector(degrees * kDegree);
    EXPECT_TRUE(std::any_of(arena.walls().begin(), arena.walls().end(), [&](const OrientedBox& wall) {
      return SegmentTouches(wall, {0, 0}, outside);
    })) << degrees;
  }
}

TEST(ArenaTest, BoxesAreObstaclesInGeneOrderThenWalls) {
  TestCase test_case;
  test_case.obstacles = {{1.0, 0.0, 0.5, 0.2, 10.0}, {-1.0, 0.5, 0.6, 0.3, 20.0}};
  const Arena arena(test_case);
  ASSERT_EQ(arena.boxes().size(), 6u);
  EXPECT_EQ(arena.boxes()[0].center, Vec2(1.0, 0.0));
  EXPECT_EQ(arena.boxes()[1].center, Vec2(-1.0, 0.5));
  EXPECT_EQ(arena.boxes()[2].center, arena.walls()[0].center);
  EXPECT_EQ(arena.obstacles().size(), 2u);
}

TEST(ArenaTest, TheInteriorEndsAtTheInnerFaces) {
  const Arena arena(TestCase{});
  EXPECT_TRUE(arena.InInterior({2.949, -2.949}));
  EXPECT_FALSE(arena.InInterior({2.95, 0.0}));
  EXPECT_FALSE(arena.InInterior({0.0, -2.951}));
}

TEST(ArenaTest, AnObstacleBlocksTheLineOfSightAndItsVisiblePartEndsAtTheWall) {
  TestCase test_case;
  test_case.obstacles = {{2.95, 0.0, 1.0, 0.5, 0.0}};
  const Arena arena(test_case);
  EXPECT_FALSE(arena.LineOfSight({2.7, 1.0}, {2.7, -1.0}));
  EXPECT_TRUE(arena.LineOfSight({2.4, 1.0}, {2.4, -1.0}));
  EXPECT_NEAR(Area(arena.VisiblePart(0)), 0.25, 1e-12);
}

TEST(ArenaTest, LineOfSightIsThatNoBoxTouchesTheSegmentWhereverItsEndsAre) {
  RandomStream random(31, StreamPurpose::kTest);
  int blocked = 0;
  for (int i = 0; i < 50; ++i) {
    const Arena arena(testing::AnyTestCase(random, 8));
    for (int j = 0; j < 200; ++j) {
      const Vec2 a(random.Uniform(-3.2, 3.2), random.Uniform(-3.2, 3.2));
      const Vec2 b(random.Uniform(-3.2, 3.2), random.Uniform(-3.2, 3.2));
      const bool clear = std::none_of(arena.boxes().begin(), arena.boxes().end(),
                                      [&](const OrientedBox& box) { return SegmentTouches(box, a, b); });
      blocked += clear ? 0 : 1;
      ASSERT_EQ(arena.LineOfSight(a, b), clear);
      ASSERT_EQ(arena.LineOfSight(b, a), clear);
    }
  }
  EXPECT_GT(blocked, 2000);
  EXPECT_LT(blocked, 9500);
}

}  // namespace
TEST(ArenaTest, LiesAroundItsCentre) {
  TestCase test_case;
  test_case.center = {8.0, -0.5};
  const Arena arena(test_case);
  EXPECT_EQ(arena.interior_min(), Vec2(5.05, -3.45));
  EXPECT_EQ(arena.interior_max(), Vec2(10.95, 2.45));
  EXPECT_EQ(arena.walls()[0].center, Vec2(8.0, 2.5));
  EXPECT_EQ(arena.walls()[3].center, Vec2(5.0, -0.5));
  EXPECT_TRUE(arena.InInterior({8.0, 0.0}));
  EXPECT_FALSE(arena.InInterior({0.0, 0.0}));
  EXPECT_TRUE(arena.LineOfSight({5.5, 0.0}, {10.5, 0.0}));
}

}  // namespace gauntlet::sim
