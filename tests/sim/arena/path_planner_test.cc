#include "sim/arena/path_planner.h"

#include <gtest/gtest.h>

#include <cmath>
#include <queue>
#include <vector>

#include "tests/sim/arena/random_arenas.h"

namespace gauntlet::sim {
namespace {

using testing::GridWith;

const Vec2 kStart(2.5, 2.5);
const Vec2 kGoal(-2.5, -2.5);

double LengthOf(const std::vector<Vec2>& path) {
  double length = 0.0;
  for (std::size_t i = 1; i < path.size(); ++i) length += (path[i] - path[i - 1]).norm();
  return length;
}

// Whether p is in a free cell; a point within 1e-6 m of a cell's edge may count for either side.
bool InFreeCell(const OccupancyGrid& grid, const Vec2& p) {
  constexpr double kEdge = 1e-6;
  for (const double dx : {-kEdge, kEdge}) {
    for (const double dy : {-kEdge, kEdge}) {
      if (grid.Free(grid.CellAt(p + Vec2(dx, dy)))) return true;
    }
  }
  return false;
}

// Dijkstra from cell to neighbouring cell with the planner's rules; infinity when there is no path.
double GridPathLength(const OccupancyGrid& grid, const Vec2& start, const Vec2& goal) {
  const Cell start_cell = grid.CellAt(start);
  const Cell goal_cell = grid.CellAt(goal);
  const auto point_of = [&](Cell cell) {
    if (cell == start_cell) return start;
    return cell == goal_cell ? goal : grid.CenterOf(cell);
  };
  std::vector<double> lengths(grid.blocked().size(), std::numeric_limits<double>::infinity());
  using Entry = std::pair<double, std::size_t>;
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> open;
  if (!grid.Free(start_cell) || !grid.Free(goal_cell)) return lengths[0];
  lengths[grid.Index(start_cell)] = 0.0;
  open.emplace(0.0, grid.Index(start_cell));
  while (!open.empty()) {
    const auto [length, index] = open.top();
    open.pop();
    if (length > lengths[index]) continue;
    const Cell cell = {static_cast<int>(index) % grid.columns(), static_cast<int>(index) / grid.columns()};
    for (int dx = -1; dx <= 1; ++dx) {
      for (int dy = -1; dy <= 1; ++dy) {
        const Cell next = {cell.column + dx, cell.row + dy};
        if (!grid.Free(next) || !grid.Free({cell.column + dx, cell.row}) ||
            !grid.Free({cell.column, cell.row + dy})) {
          continue;
        }
        const double candidate = length + (point_of(next) - point_of(cell)).norm();
        if (candidate >= lengths[grid.Index(next)]) continue;
        lengths[grid.Index(next)] = candidate;
        open.emplace(candidate, grid.Index(next));
      }
    }
  }
  return lengths[grid.Index(goal_cell)];
}

TEST(PathPlannerTest, TheEmptyArenaHasAStraightPath) {
  const std::vector<Vec2> path = PlanPath(GridWith({}), kStart, kGoal);
  ASSERT_EQ(path.size(), 2u);
  EXPECT_EQ(path[0], kStart);
  EXPECT_EQ(path[1], kGoal);
}

TEST(PathPlannerTest, StartAndGoalInOneCellAreJoinedDirectly) {
  const std::vector<Vec2> path = PlanPath(GridWith({}), {0.01, 0.01}, {0.02, 0.04});
  ASSERT_EQ(path.size(), 2u);
  EXPECT_EQ(path[1], Vec2(0.02, 0.04));
}

// The taut string around a wall from y = -1 to y = 1: tangents to the circle of the inflation around its end,
// and the arc between them.
TEST(PathPlannerTest, AroundAWallThePathIsNearTheTautString) {
  const OccupancyGrid grid = GridWith({{0.0, 0.0, 2.0, 0.2, 90.0}, {0.0, -2.0, 2.0, 0.2, 90.0}});
  const std::vector<Vec2> path = PlanPath(grid, {-2.0, 0.0}, {2.0, 0.0});
  ASSERT_GE(path.size(), 3u);
  const Vec2 to_corner(1.9, 1.0);
  const double radius = OccupancyGrid::kDefaultInflation;
  const double tangent = std::sqrt(to_corner.squaredNorm() - radius * radius);
  const double slope = std::atan2(to_corner.y(), to_corner.x()) + std::asin(radius / to_corner.norm());
  const double taut = 2.0 * (tangent + radius * slope) + 0.2;
  EXPECT_LT(LengthOf(path), 1.02 * taut);
  EXPECT_GT(LengthOf(path), 0.98 * taut);
}

TEST(PathPlannerTest, NoPathIsEmpty) {
  EXPECT_TRUE(
      PlanPath(GridWith({{0.0, 0.0, 6.0, 0.2, 45.0}, {0.0, 0.0, 8.6, 0.2, 135.0}}), kStart, kGoal).empty());
  EXPECT_TRUE(PlanPath(GridWith({{2.5, 2.5, 0.4, 0.4, 0.0}}), kStart, kGoal).empty()) << "start blocked";
  EXPECT_TRUE(PlanPath(GridWith({{-2.5, -2.5, 0.4, 0.4, 0.0}}), kStart, kGoal).empty()) << "goal blocked";
  EXPECT_TRUE(PlanPath(GridWith({}), kStart, {7.0, 0.0}).empty()) << "goal outside";
  EXPECT_TRUE(PlanPath(GridWith({}), {std::nan(""), 0.0}, kGoal).empty());
}

TEST(PathPlannerTest, NeverLeavesFreeCellsAndIsNeverLongerThanTheGridPath) {
  RandomStream random(61, StreamPurpose::kTest);
  const ArenaRequirements requirements = testing::CornerToCorner();
  int bent = 0;
  for (int i = 0; i < 40; ++i) {
    const int obstacles = 4 + static_cast<int>(random.Below(20));
    const OccupancyGrid grid(Arena(testing::ValidTestCase(random, obstacles, requirements, 3.0)), 0.1);
    const std::vector<Vec2> path = PlanPath(grid, kStart, kGoal);
    ASSERT_GE(path.size(), 2u);
    ASSERT_EQ(path.front(), kStart);
    ASSERT_EQ(path.back(), kGoal);
    bent += path.size() > 2 ? 1 : 0;
    for (std::size_t leg = 1; leg < path.size(); ++leg) {
      const Vec2 way = path[leg] - path[leg - 1];
      const int steps = static_cast<int>(std::ceil(way.norm() / kPathSampleDistance));
      for (int step = 0; step <= steps; ++step) {
        const Vec2 sample = path[leg - 1] + way * (static_cast<double>(step) / steps);
        ASSERT_TRUE(InFreeCell(grid, sample)) << "arena " << i << " at " << sample.transpose();
      }
      ASSERT_TRUE(PathIsFree(grid, path[leg - 1], path[leg]));
    }
    const double straight = (kGoal - kStart).norm();
    ASSERT_GE(LengthOf(path), straight - 1e-12);
    ASSERT_LE(LengthOf(path), GridPathLength(grid, kStart, kGoal) + 1e-9) << "arena " << i;
  }
  EXPECT_GT(bent, 20);
}

TEST(PathPlannerTest, TheWayBackIsAboutAsLongAndPlanningIsRepeatable) {
  RandomStream random(62, StreamPurpose::kTest);
  for (int i = 0; i < 30; ++i) {
    const OccupancyGrid grid(Arena(testing::ValidTestCase(random, 12, testing::CornerToCorner())), 0.1);
    const std::vector<Vec2> there = PlanPath(grid, kStart, kGoal);
    EXPECT_EQ(PlanPath(grid, kStart, kGoal), there);
    const double back = LengthOf(PlanPath(grid, kGoal, kStart));
    EXPECT_NEAR(LengthOf(there) / back, 1.0, 0.03) << i;
  }
}

TEST(PathPlannerTest, DoesNotSqueezeBetweenTouchingCorners) {
  TestCase test_case;
  test_case.side_x = test_case.side_y = 1.0;
  test_case.obstacles = {{-0.25, 0.25, 0.5, 0.5, 0.0}, {0.25, -0.25, 0.5, 0.5, 0.0}};
  const OccupancyGrid grid(Arena(test_case), 0.0);
  EXPECT_TRUE(PlanPath(grid, {-0.2, -0.2}, {0.2, 0.2}).empty());
}

TEST(PathPlannerTest, LineOfSightAgreesWithSamplingCells) {
  RandomStream random(63, StreamPurpose::kTest);
  int free = 0;
  for (int i = 0; i < 40; ++i) {
    const OccupancyGrid grid(Arena(testing::AnyTestCase(random, 8)), 0.1);
    for (int j = 0; j < 100; ++j) {
      const Vec2 a(random.Uniform(-2.9, 2.9), random.Uniform(-2.9, 2.9));
      const Vec2 b(random.Uniform(-2.9, 2.9), random.Uniform(-2.9, 2.9));
      const int steps = static_cast<int>(std::ceil((b - a).norm() / kPathSampleDistance));
      bool all_free = true;
      bool near_edge = false;
      for (int step = 0; step <= steps; ++step) {
        const Vec2 sample = a + (b - a) * (static_cast<double>(step) / steps);
        all_free = all_free && grid.Free(grid.CellAt(sample));
        const Vec2 cells = (sample - grid.origin()) / OccupancyGrid::kCellSize;
        const Vec2 off(std::fabs(cells.x() - std::round(cells.x())),
                       std::fabs(cells.y() - std::round(cells.y())));
        near_edge = near_edge || off.minCoeff() < 1e-6;
      }
      if (near_edge) continue;
      free += all_free ? 1 : 0;
      ASSERT_EQ(PathIsFree(grid, a, b), all_free);
    }
  }
  EXPECT_GT(free, 300);
}

}  // namespace
}  // namespace gauntlet::sim
