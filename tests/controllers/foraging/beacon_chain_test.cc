#include "controllers/foraging/beacon_chain.h"

#include <vector>

#include "gmock/gmock.h"
#include "gtest/gtest.h"

namespace gauntlet::controllers {
namespace {

constexpr double kRange = 3.0;
const ChainEnds kEnds = {{0.0, -2.0}, {0.0, 2.0}};

std::size_t ChainLength(const std::vector<sim::Vec2>& beacons, const sim::TestCase& test_case = {}) {
  return FindBeaconChain(sim::Arena(test_case), kEnds, beacons, kRange).size();
}

TEST(BeaconChain, OneBeaconInRangeOfBothEndsIsAPath) {
  EXPECT_EQ(ChainLength({}), 0u);
  EXPECT_EQ(ChainLength({{0.0, 0.0}}), 3u);
  EXPECT_EQ(ChainLength({{0.0, -1.5}}), 0u) << "3.5 m from the food";
  EXPECT_EQ(ChainLength({{0.0, 1.5}}), 0u) << "3.5 m from the nest";
  EXPECT_EQ(ChainLength({{0.0, -1.5}, {0.0, 1.4}}), 4u);
}

TEST(BeaconChain, GoesFromTheNestToTheFoodByTheFewestBeacons) {
  const auto chain = FindBeaconChain(sim::Arena(sim::TestCase{}), kEnds,
                                     std::vector<sim::Vec2>{{1.0, -1.8}, {0.5, 1.8}, {0.2, 0.1}}, kRange);
  ASSERT_EQ(chain.size(), 3u);
  EXPECT_EQ(chain[0], kEnds.nest);
  EXPECT_EQ(chain[1], sim::Vec2(0.2, 0.1));
  EXPECT_EQ(chain[2], kEnds.food);
}

TEST(BeaconChain, NeedsALineOfSight) {
  sim::TestCase wall;
  wall.obstacles = {{-0.5, 0.5, 4.0, 0.1, 0.0}};  // from x = -2.5 to 1.5
  EXPECT_EQ(ChainLength({{0.0, 0.0}}, wall), 0u);
  EXPECT_EQ(ChainLength({{0.0, 0.0}, {1.8, 0.3}}, wall), 3u) << "around the end";
}

}  // namespace
}  // namespace gauntlet::controllers
