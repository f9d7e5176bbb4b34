#include "controllers/coverage/coverage_metrics.h"

#include <gtest/gtest.h>

#include "sim/geometry/trigonometry.h"

namespace gauntlet::controllers::coverage {
namespace {

using sim::Vec2;

const Vec2 kStart(2.5, 2.5);
// Of the empty arena: 5.9 m less 0.10 m on either side.
constexpr double kReachable = 5.7 * 5.7;

double Covered(const sim::Arena& arena, const std::vector<Vec2>& robots, double radius,
               const std::vector<Vec2>& obstacles = {}) {
  const CoverageMap map(arena, kStart);
  CellMarks seen = map.NothingSeen();
  map.See(robots, radius, obstacles, seen);
  return map.ShareOf(seen);
}

TEST(CoverageMap, ARobotInTheOpenCoversADisc) {
  const sim::Arena arena((sim::TestCase()));
  const double disc = sim::kPi * 0.75 * 0.75;
  EXPECT_NEAR(Covered(arena, {{0.0, 0.0}}, 0.75), disc / kReachable, 0.02 * disc / kReachable);
}

TEST(CoverageMap, AnObstacleHidesWhatIsBehindItWhereItIs) {
  sim::TestCase test_case;
  test_case.obstacles = {{0.0, 0.4, 4.0, 0.1, 0.0}};
  const double hidden = Covered(sim::Arena(test_case), {{0.0, 0.0}}, 0.75);
  const double both = Covered(sim::Arena(test_case), {{0.0, 0.0}, {0.0, 0.8}}, 0.75);
  EXPECT_NEAR(both, 2.0 * hidden, 0.1 * hidden) << "neither sees the other's side";

  test_case.obstacles[0].path = {{0.0, -2.0}};
  test_case.obstacles[0].speed = 0.1;
  EXPECT_EQ(Covered(sim::Arena(test_case), {{0.0, 0.0}}, 0.75, {{0.0, 0.4}}), hidden);
  EXPECT_GT(Covered(sim::Arena(test_case), {{0.0, 0.0}}, 0.75, {{0.0, -2.0}}), hidden);
}

TEST(CoverageMap, OnlyCellsThatTheStartIsConnectedWithCount) {
  sim::TestCase test_case;
  test_case.obstacles = {{0.0, 0.0, 6.0, 0.1, 90.0}};
  EXPECT_EQ(Covered(sim::Arena(test_case), {{-1.5, 0.0}}, 0.75), 0.0);
  EXPECT_EQ(Covered(sim::Arena(test_case), {{1.5, 0.0}}, 9.0), 1.0);
}

TEST(CoverageMap, TheLargestHoleIsWhatIsLeft) {
  const sim::Arena arena((sim::TestCase()));
  const CoverageMap map(arena, kStart);
  CellMarks seen = map.NothingSeen();
  const Hole all = map.LargestHole(seen);
  EXPECT_NEAR(all.area, kReachable, 0.02 * kReachable);

  // A column of robots leaves the larger part to its left.
  std::vector<Vec2> column;
  for (double y = -3.0; y <= 3.0; y += 0.1) column.emplace_back(1.0, y);
  map.See(column, 0.3, {}, seen);
  const Hole left = map.LargestHole(seen);
  EXPECT_NEAR(left.area, 5.7 * 3.55, 0.3);
  EXPECT_NEAR(left.centroid.x(), -2.85 + 3.55 / 2.0, 0.05);
  EXPECT_NEAR(left.centroid.y(), 0.0, 1e-9);

  map.See(std::vector<Vec2>{{0.0, 0.0}}, 9.0, {}, seen);
  EXPECT_EQ(map.LargestHole(seen).area, 0.0);
  EXPECT_EQ(map.LargestHole(seen).centroid.x(), kNowhere);
}

TEST(NearestNeighbourDistance, IsTheMeanOverRobots) {
  EXPECT_NEAR(NearestNeighbourDistance(std::vector<Vec2>{{0.0, 0.0}, {1.0, 0.0}, {-1.9, 0.0}}), 1.3, 1e-12);
}

}  // namespace
}  // namespace gauntlet::controllers::coverage
