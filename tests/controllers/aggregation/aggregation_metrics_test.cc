#include "controllers/aggregation/aggregation_metrics.h"

#include <gtest/gtest.h>

#include <vector>

#include "sim/robot/foot_bot.h"

namespace gauntlet::controllers::aggregation {
namespace {

using sim::Vec2;

constexpr double kDiameter = 2.0 * sim::foot_bot::kRadius;

TEST(Dispersion, OfATouchingPairIsAHalf) {
  EXPECT_NEAR(Dispersion(std::vector<Vec2>{{1.0, 1.0}, {1.0 + kDiameter, 1.0}}), 0.5, 1e-12);
  EXPECT_EQ(Dispersion(std::vector<Vec2>{{1.0, 1.0}}), 0.0);
  EXPECT_EQ(Dispersion({}), 0.0);
}

TEST(TotalDistance, IsThatOfAllPairs) {
  EXPECT_DOUBLE_EQ(TotalDistance(std::vector<Vec2>{{0, 0}, {3, 0}, {0, 4}}), 12.0);
}

TEST(ExpectedClusterSize, WeighsEachClusterByItsRobots) {
  EXPECT_DOUBLE_EQ(ExpectedClusterSize(std::vector<int>{3, 1}), 2.5);
  EXPECT_DOUBLE_EQ(ExpectedClusterSize(std::vector<int>{20}), 20.0);
}

// Two in the left, three in the right, one on its own above them.
const std::vector<Vec2> kApart = {{-2, 0}, {-1.8, 0}, {1, 0}, {1.2, 0}, {1.4, 0}, {1.2, 2}};

TEST(FindGroups, TellsTheTwoLargestAndWhoIsInThem) {
  Clusters clusters;
  const sim::Arena arena{sim::TestCase{}};
  const Groups groups = FindGroups(clusters, kApart, arena, 0.34, {});
  EXPECT_EQ(groups.sizes, (std::vector<int>{2, 3, 1}));
  EXPECT_EQ(groups.members, (std::vector<int>{0, 0, 1, 1, 1, 2}));
  EXPECT_EQ(groups.first, 1);
  EXPECT_EQ(groups.second, 0);
  EXPECT_DOUBLE_EQ(groups.Share(groups.first), 0.5);
  EXPECT_EQ(groups.Share(-1), 0.0);
  EXPECT_EQ(groups.Robots(0, kApart), (std::vector<Vec2>{{-2, 0}, {-1.8, 0}}));
}

TEST(FindGroups, AWallParts) {
  Clusters clusters;
  sim::TestCase test_case;
  const std::vector<Vec2> all = {{0, 0}, {0.2, 0}};
  EXPECT_EQ(FindGroups(clusters, all, sim::Arena(test_case), 0.34, {}).second, -1) << "all are in one";
  test_case.obstacles = {{0.1, 0.0, 0.02, 1.0, 0.0}};
  EXPECT_EQ(FindGroups(clusters, all, sim::Arena(test_case), 0.34, {}).sizes, (std::vector<int>{1, 1}));
}

TEST(InSight, EndsAtWallsAndAtTheRange) {
  sim::TestCase test_case;
  const std::vector<Vec2> left = {{-1, 0}, {-1, 0.2}};
  const std::vector<Vec2> right = {{1, 0}};
  EXPECT_TRUE(InSight(left, right, sim::Arena(test_case), 9.0, {}));
  EXPECT_FALSE(InSight(left, right, sim::Arena(test_case), 1.9, {}));
  test_case.obstacles = {{0.0, 0.0, 0.1, 2.0, 0.0}};
  EXPECT_FALSE(InSight(left, right, sim::Arena(test_case), 9.0, {}));
}

}  // namespace
}  // namespace gauntlet::controllers::aggregation
