#include "sim/geometry/neighbour_pairs.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>

namespace gauntlet::sim {
namespace {

RC_GTEST_PROP(NeighbourPairs, MissNobodyInReachOnAnyWay, ()) {
  NeighbourPairs neighbours(0.1);
  const std::size_t robots = *rc::gen::inRange<std::size_t>(0, 15);
  const auto coordinate = [] { return *rc::gen::inRange(-1000, 1001) * 1e-3; };
  std::vector<Vec2> positions;
  for (std::size_t i = 0; i < robots; ++i) positions.emplace_back(coordinate(), coordinate());
  for (int step = 0; step < 20; ++step) {
    for (Vec2& p : positions) p += 0.02 * Vec2(coordinate(), coordinate());
    const double reach = *rc::gen::inRange(0, 400) * 1e-3;
    const std::vector<NeighbourPairs::Pair> before(neighbours.pairs().begin(), neighbours.pairs().end());
    const bool renewed = neighbours.Update(positions, reach);
    const std::span<const NeighbourPairs::Pair> pairs = neighbours.pairs();
    RC_ASSERT(renewed || std::ranges::equal(pairs, before));
    RC_ASSERT(std::ranges::is_sorted(pairs));
    for (std::size_t j = 0; j < robots; ++j) {
      for (std::size_t i = 0; i < j; ++i) {
        const bool listed = std::ranges::binary_search(pairs, NeighbourPairs::Pair{i, j});
        RC_ASSERT(listed || (positions[i] - positions[j]).norm() >= reach);
      }
    }
  }
}

TEST(NeighbourPairs, LeaveOutFarRobots) {
  NeighbourPairs neighbours(0.1);
  const std::vector<Vec2> positions = {{0.0, 0.0}, {5.0, 0.0}, {0.2, 0.1}};
  EXPECT_TRUE(neighbours.Update(positions, 0.3));
  EXPECT_FALSE(neighbours.Update(positions, 0.3));
  const std::span<const NeighbourPairs::Pair> pairs = neighbours.pairs();
  ASSERT_EQ(pairs.size(), 1u);
  EXPECT_EQ(pairs[0], (NeighbourPairs::Pair{0, 2}));
}

}  // namespace
}  // namespace gauntlet::sim
