#include "sim/arena/occupancy_grid.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <deque>
#include <limits>
#include <vector>

#include "sim/arena/path_planner.h"
#include "tests/sim/arena/random_arenas.h"

namespace gauntlet::sim {
namespace {

// Breadth-first search, one cell at a time.
std::vector<std::uint8_t> ReachableByBreadthFirstSearch(const OccupancyGrid& grid, Cell start) {
  std::vector<std::uint8_t> marks(grid.blocked().size(), 0);
  if (!grid.Free(start)) return marks;
  std::deque<Cell> queue = {start};
  marks[grid.Index(start)] = 1;
  while (!queue.empty()) {
    const Cell cell = queue.front();
    queue.pop_front();
    for (const Cell next : {Cell{cell.column + 1, cell.row}, Cell{cell.column - 1, cell.row},
                            Cell{cell.column, cell.row + 1}, Cell{cell.column, cell.row - 1}}) {
      if (!grid.Free(next) || marks[grid.Index(next)] != 0) continue;
      marks[grid.Index(next)] = 1;
      queue.push_back(next);
    }
  }
  return marks;
}

Cell RandomCell(const OccupancyGrid& grid, RandomStream& random) {
  return {static_cast<int>(random.Below(static_cast<std::uint32_t>(grid.columns()))),
          static_cast<int>(random.Below(static_cast<std::uint32_t>(grid.rows())))};
}

TEST(OccupancyGridTest, SpansTheWallsCentreLinesIn120By120Cells) {
  const OccupancyGrid grid(Arena(TestCase{}), OccupancyGrid::kDefaultInflation);
  EXPECT_EQ(grid.columns(), 120);
  EXPECT_EQ(grid.rows(), 120);
  EXPECT_TRUE(grid.CenterOf({0, 0}).isApprox(Vec2(-2.975, -2.975), 1e-12));
  EXPECT_TRUE(grid.CenterOf({119, 119}).isApprox(Vec2(2.975, 2.975), 1e-12));
  EXPECT_EQ(grid.CellAt({2.5001, -2.4999}), (Cell{110, 10}));
}

TEST(OccupancyGridTest, AnEmptyArenaIsFreeUpToTheInflatedWalls) {
  const OccupancyGrid grid(Arena(TestCase{}), OccupancyGrid::kDefaultInflation);
  // Inner faces at 2.95 m, 0.10 m of inflation: the last free centre is 2.825 m, cell 116.
  EXPECT_TRUE(grid.Free({116, 3}));
  EXPECT_FALSE(grid.Free({117, 60}));
  EXPECT_FALSE(grid.Free({60, 2}));
  EXPECT_EQ(std::count(grid.blocked().begin(), grid.blocked().end(), 0), 114 * 114);
}

TEST(OccupancyGridTest, APartOfACellCountsAsOne) {
  TestCase test_case;
  test_case.side_x = 3.02;
  test_case.side_y = 1.0;
  const OccupancyGrid grid(Arena(test_case), 0.1);
  EXPECT_EQ(grid.columns(), 61);
  EXPECT_EQ(grid.rows(), 20);
  EXPECT_FALSE(grid.Free({60, 10}));
}

TEST(OccupancyGridTest, EveryCenterIsInItsCell) {
  const OccupancyGrid grid(Arena(TestCase{}), 0.1);
  for (int row = 0; row < grid.rows(); ++row) {
    for (int column = 0; column < grid.columns(); ++column) {
      ASSERT_EQ(grid.CellAt(grid.CenterOf({column, row})), (Cell{column, row}));
    }
  }
}

TEST(OccupancyGridTest, PointsOutsideAndNumbersBeyondIntegersLieOutsideTheGrid) {
  const OccupancyGrid grid(Arena(TestCase{}), 0.1);
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  for (const double far : {3.01, -3.01, 1e10, -1e300, std::numeric_limits<double>::infinity(), kNan}) {
    EXPECT_FALSE(grid.InGrid(grid.CellAt({far, 0.0}))) << far;
    EXPECT_FALSE(grid.InGrid(grid.CellAt({0.0, far}))) << far;
    EXPECT_FALSE(grid.Free(grid.CellAt({far, far}))) << far;
  }
}

TEST(OccupancyGridTest, ACellIsBlockedWhenItsCentreIsNearerThanTheInflation) {
  RandomStream random(41, StreamPurpose::kTest);
  for (int i = 0; i < 60; ++i) {
    const Arena arena(testing::AnyTestCase(random, 8, 4.0));
    const double inflation = random.Uniform(0.0, 0.3);
    const OccupancyGrid grid(arena, inflation);
    for (int row = 0; row < grid.rows(); ++row) {
      for (int column = 0; column < grid.columns(); ++column) {
        const Vec2 center = grid.CenterOf({column, row});
        double distance =
            std::min((center - arena.interior_min()).minCoeff(), (arena.interior_max() - center).minCoeff());
        for (const OrientedBox& box : arena.obstacles()) distance = std::min(distance, Distance(box, center));
        ASSERT_EQ(grid.Free({column, row}), distance > 0.0 && distance >= inflation)
            << "centre " << center.transpose() << " distance " << distance << " inflation " << inflation;
        ASSERT_EQ(grid.Clearance(center), distance);
      }
    }
  }
}

TEST(OccupancyGridTest, ObstaclesAddedOneByOneGiveTheGridOfTheWholeArena) {
  RandomStream random(42, StreamPurpose::kTest);
  for (int i = 0; i < 30; ++i) {
    const TestCase test_case = testing::AnyTestCase(random, 10, 4.0);
    OccupancyGrid grid(Arena(TestCase{}), 0.1);
    for (const ObstacleGene& gene : test_case.obstacles) grid.AddObstacle(BoxOf(gene));
    EXPECT_EQ(grid.blocked(), OccupancyGrid(Arena(test_case), 0.1).blocked());
  }
}

TEST(OccupancyGridTest, AnObstacleAroundEverythingBlocksEverything) {
  OccupancyGrid grid(Arena(TestCase{}), 0.1);
  grid.AddObstacle(BoxOf({0.0, 0.0, 200.0, 200.0, 30.0}));
  EXPECT_EQ(std::count(grid.blocked().begin(), grid.blocked().end(), 0), 0);
  grid.AddObstacle(BoxOf({900.0, -900.0, 1.0, 1.0, 30.0}));
}

TEST(OccupancyGridTest, ReachableAndConnectedAgreeWithBreadthFirstSearch) {
  RandomStream random(43, StreamPurpose::kTest);
  int separated = 0;
  for (int i = 0; i < 100; ++i) {
    const int obstacles = 4 + static_cast<int>(random.Below(60));
    const OccupancyGrid grid(Arena(testing::AnyTestCase(random, obstacles, 3.0)), 0.1);
    for (int j = 0; j < 5; ++j) {
      const Cell start = RandomCell(grid, random);
      const std::vector<std::uint8_t> marks = ReachableByBreadthFirstSearch(grid, start);
      ASSERT_EQ(grid.Reachable(start), marks);
      for (int k = 0; k < 20; ++k) {
        const Cell other = RandomCell(grid, random);
        const bool connected = marks[grid.Index(other)] != 0;
        separated += grid.Free(start) && grid.Free(other) && !connected ? 1 : 0;
        ASSERT_EQ(grid.Connected(start, other), connected);
        ASSERT_EQ(grid.Connected(other, start), connected);
      }
    }
  }
  EXPECT_GT(separated, 100) << "the arenas must have several components for this test to mean anything";
}

TEST(OccupancyGridTest, TouchingCornersDoNotConnect) {
  // Two boxes cut the arena along a diagonal of cells, seen without inflation.
  TestCase test_case;
  test_case.side_x = test_case.side_y = 1.0;
  test_case.obstacles = {{-0.25, 0.25, 0.5, 0.5, 0.0}, {0.25, -0.25, 0.5, 0.5, 0.0}};
  const OccupancyGrid grid(Arena(test_case), 0.0);
  ASSERT_TRUE(grid.Free({9, 9}));
  ASSERT_TRUE(grid.Free({10, 10}));
  EXPECT_FALSE(grid.Connected({9, 9}, {10, 10}));
}

TEST(OccupancyGridTest, ASpiralIsOneComponent) {
  OccupancyGrid grid(Arena(TestCase{}), 0.1);
  // Parallel walls with the gap at alternating ends: one long corridor.
  for (int i = 0; i < 9; ++i) {
    const double y = -2.4 + 0.6 * i;
    grid.AddObstacle(BoxOf({i % 2 == 0 ? -0.4 : 0.4, y, 5.2, 0.1, 0.0}));
  }
  EXPECT_TRUE(grid.Connected(grid.CellAt({2.7, 2.7}), grid.CellAt({-2.7, -2.7})));
  grid.AddObstacle(BoxOf({0.0, 0.3, 0.1, 0.7, 0.0}));
  EXPECT_FALSE(grid.Connected(grid.CellAt({2.7, 2.7}), grid.CellAt({-2.7, -2.7})));
}

}  // namespace
TEST(OccupancyGridTest, ATranslatedArenaHasTheSameCells) {
  TestCase test_case;
  test_case.side_x = 3.0;
  const OccupancyGrid grid(Arena(test_case), 0.1);
  test_case.center = {1.5, 3.0};  // then one corner is the origin
  const OccupancyGrid moved(Arena(test_case), 0.1);
  EXPECT_EQ(moved.columns(), 60);
  EXPECT_EQ(moved.rows(), 120);
  EXPECT_EQ(moved.origin(), Vec2(0.0, 0.0));
  EXPECT_EQ(moved.blocked(), grid.blocked());
  EXPECT_EQ(moved.CellAt({0.06, 0.01}), (Cell{1, 0}));
}

TEST(OccupancyGridTest, CellsMayBeFiner) {
  TestCase test_case;
  test_case.side_x = test_case.side_y = 0.5;
  test_case.wall_thickness = 0.01;
  const OccupancyGrid grid(Arena(test_case), 0.017, 0.0085);
  EXPECT_EQ(grid.columns(), 59);
  EXPECT_EQ(grid.cell_size(), 0.0085);
  for (int column = 0; column < grid.columns(); ++column)
    ASSERT_EQ(grid.CellAt(grid.CenterOf({column, 7})), (Cell{column, 7}));
  // 0.005 m of wall and 0.017 m of robot: the centre of the third cell is 0.02125 m from the wall's line.
  EXPECT_FALSE(grid.Free({2, 30}));
  EXPECT_TRUE(grid.Free({3, 30}));
  EXPECT_EQ(PlanPath(grid, {-0.2, -0.2}, {0.2, 0.2}).size(), 2u);
}

TEST(OccupancyGridTest, ADiscIsABoxWithoutExtentAndARadius) {
  OccupancyGrid grid(Arena(TestCase{}), 0.1);
  grid.AddObstacle(RoundedBox{{{0.5, 0.5}, Vec2::Zero()}, 0.4});
  for (int row = 10; row < grid.rows() - 10; ++row) {
    for (int column = 10; column < grid.columns() - 10; ++column) {
      const double distance = (grid.CenterOf({column, row}) - Vec2(0.5, 0.5)).norm();
      if (std::fabs(distance - 0.5) > 1e-9) ASSERT_EQ(grid.Free({column, row}), distance > 0.5);
    }
  }
  EXPECT_NEAR(grid.Clearance({1.5, 0.5}), 0.6, 1e-12);
}

}  // namespace gauntlet::sim
