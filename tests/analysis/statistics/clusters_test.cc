#include "analysis/statistics/clusters.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace gauntlet::analysis {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

std::vector<std::size_t> GroupsOf(const std::vector<double>& places, double most) {
  return GroupByDistance(
      places.size(), [&](std::size_t a, std::size_t b) { return std::abs(places[a] - places[b]); }, most);
}

TEST(ClustersTest, JoinsWhatIsNearAndNumbersGroupsByTheirFirst) {
  EXPECT_THAT(GroupsOf({}, 1.0), IsEmpty());
  EXPECT_THAT(GroupsOf({3.0}, 1.0), ElementsAre(0));
  EXPECT_THAT(GroupsOf({5.0, 0.0, 5.4, 0.3, 9.0}, 1.0), ElementsAre(0, 1, 0, 1, 2));
  EXPECT_THAT(GroupsOf({2.0, 2.0, 2.0}, 0.0), ElementsAre(0, 0, 0));
}

TEST(ClustersTest, AChainOfNeighboursIsNoGroup) {
  EXPECT_THAT(GroupsOf({0.0, 0.9, 1.8, 2.7}, 1.0), ElementsAre(0, 0, 1, 1));
  EXPECT_THAT(GroupsOf({0.0, 0.6, 1.1}, 1.0), ElementsAre(0, 1, 1)) << "the nearest pair first";
}

// Step by step, the nearest two groups of all: slow and plainly right.
std::vector<std::size_t> StepByStep(const std::vector<double>& places, double most) {
  std::vector<std::vector<std::size_t>> groups;
  for (std::size_t i = 0; i < places.size(); ++i) groups.push_back({i});
  for (;;) {
    double best = most;
    std::pair<std::size_t, std::size_t> pair(0, 0);
    for (std::size_t a = 0; a < groups.size(); ++a) {
      for (std::size_t b = a + 1; b < groups.size(); ++b) {
        double diameter = 0.0;
        for (const std::size_t i : groups[a])
          for (const std::size_t j : groups[b])
            diameter = std::max(diameter, std::abs(places[i] - places[j]));
        if (diameter > best || (diameter == best && pair.second > 0)) continue;
        best = diameter;
        pair = {a, b};
      }
    }
    if (pair.second == 0) break;
    std::ranges::move(groups[pair.second], std::back_inserter(groups[pair.first]));
    groups.erase(groups.begin() + static_cast<std::ptrdiff_t>(pair.second));
    for (auto& group : groups) std::ranges::sort(group);
    std::ranges::sort(groups);
  }
  std::vector<std::size_t> group_of(places.size());
  for (std::size_t group = 0; group < groups.size(); ++group)
    for (const std::size_t i : groups[group]) group_of[i] = group;
  return group_of;
}

TEST(ClustersTest, IsWhatJoiningTheNearestTwoStepByStepGives) {
  std::uint64_t state = 1;
  for (int trial = 0; trial < 50; ++trial) {
    std::vector<double> places;
    for (int i = 0; i < 40; ++i) {
      state = state * 6364136223846793005ULL + 1442695040888963407ULL;
      places.push_back(static_cast<double>(state >> 40) / 1e6);
    }
    for (const double most : {0.1, 1.0, 4.0}) EXPECT_EQ(GroupsOf(places, most), StepByStep(places, most));
  }
}

}  // namespace
}  // namespace gauntlet::analysis
