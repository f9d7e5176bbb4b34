#include "search/margin/monotone_fit.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace gauntlet {
namespace {

using testing::DoubleNear;
using testing::ElementsAre;
using testing::Pointwise;

TEST(MonotoneFitTest, PoolsWhatFalls) {
  const std::vector<LevelTally> levels = {
      {0.0, 10, 1}, {0.2, 10, 5}, {0.4, 20, 4}, {0.6, 10, 8}, {0.8, 5, 5}};
  // 5 of 10 before 4 of 20: together 9 of 30.
  EXPECT_THAT(MonotoneFit(levels), Pointwise(DoubleNear(1e-12), {0.1, 0.3, 0.3, 0.8, 1.0}));
}

TEST(CrossingOfTest, LiesBetweenTheLevelsThatTheTestRejects) {
  const std::vector<LevelTally> levels = {{0.0, 100, 5}, {0.25, 100, 40}, {0.5, 100, 60}, {1.0, 100, 95}};
  // 40 of 100 against one half: 2 * (40 log .8 + 60 log 1.2) = 4.03, beyond 3.84; so is 60 of 100.
  const Crossing crossing = CrossingOf(levels, 0.5, 1.0);
  EXPECT_EQ(crossing.low, 0.25);
  EXPECT_EQ(crossing.high, 0.5);
  EXPECT_DOUBLE_EQ(crossing.estimate, 0.375);
  // With half of the information neither is.
  const Crossing wider = CrossingOf(levels, 0.5, 2.0);
  EXPECT_EQ(wider.low, 0.0);
  EXPECT_EQ(wider.high, 1.0);
}

TEST(CrossingOfTest, SaysOnWhichSideItLies) {
  const std::vector<LevelTally> seldom = {{0.0, 50, 2}, {1.0, 50, 5}};
  EXPECT_EQ(CrossingOf(seldom, 0.5, 1.0).low, 1.0);
  EXPECT_EQ(CrossingOf(seldom, 0.5, 1.0).high, Crossing::kAbove);
  EXPECT_EQ(CrossingOf(seldom, 0.5, 1.0).estimate, Crossing::kAbove);
  const std::vector<LevelTally> mostly = {{0.0, 50, 45}, {1.0, 50, 50}};
  EXPECT_EQ(CrossingOf(mostly, 0.5, 1.0).low, Crossing::kBelow);
  EXPECT_EQ(CrossingOf(mostly, 0.5, 1.0).high, 0.0);
  const std::vector<LevelTally> few = {{0.0, 2, 1}, {1.0, 2, 1}};
  EXPECT_EQ(CrossingOf(few, 0.5, 1.0).low, Crossing::kBelow);
  EXPECT_EQ(CrossingOf(few, 0.5, 1.0).high, Crossing::kAbove);
  EXPECT_EQ(CrossingOf(few, 0.5, 1.0).estimate, 0.5);
}

TEST(DesignEffectTest, IsTheSizeOfCasesWhoseRunsAreAlike) {
  const std::vector<double> fit = {0.5};
  std::vector<CaseOutcome> alike;
  std::vector<CaseOutcome> different;
  for (std::size_t i = 0; i < 40; ++i) {
    alike.push_back({0, i / 4, i / 4 % 2 == 0});
    different.push_back({0, i, i % 2 == 0});
  }
  EXPECT_DOUBLE_EQ(DesignEffect(alike, fit), 4.0);
  EXPECT_DOUBLE_EQ(DesignEffect(different, fit), 1.0);
}

}  // namespace
}  // namespace gauntlet
