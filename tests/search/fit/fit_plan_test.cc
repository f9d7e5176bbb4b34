#include "search/fit/fit_plan.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/search/fit/toy_fit.h"

namespace gauntlet {
namespace {

using testing::ElementsAre;

const std::string kTwoKinds =
    "metric=fitness value=1 n=100; cases=given:1-6 metric=fitness value=1 n=6; "
    "statistic=every cases=empty runs=100 formula=birds_left == 10";

TEST(FitPlanTest, SpendsTheRunsOnSettingsAndCases) {
  const FitPlan plan =
      ToyPlan({.vary = kToyVary, .targets = kTwoKinds, .runs = 20'000, .judged = 500}).value();
  EXPECT_EQ(plan.settings, 120u);  // 30 for each of three directions and one more
  // 166 runs of a setting: 24 on the six given cases, four each, and the rest in halves.
  EXPECT_THAT(plan.runs, ElementsAre(71, 24, 71));
  EXPECT_LE(plan.settings * static_cast<std::size_t>(plan.RunsEach()), 20'000u);
  // Those that have to keep to something are as many as it says, given cases are judged equally often.
  EXPECT_THAT(plan.judged, ElementsAre(500, 504, 100));
  std::size_t settings = 0;
  for (std::size_t round = 0; round < FitPlan::kRounds; ++round) settings += plan.SettingsOfRound(round);
  EXPECT_EQ(settings, plan.settings);
}

TEST(FitPlanTest, AskedForNumbersOfRandomCasesAreKept) {
  const FitPlan plan =
      ToyPlan({.vary = kToyVary, .targets = "cases=random:50 metric=fitness value=1 n=50", .runs = 4000})
          .value();
  EXPECT_THAT(plan.runs, ElementsAre(50));
  EXPECT_EQ(plan.settings, 80u);
}

TEST(FitPlanTest, TooFewRunsSayHowManyAreNeeded) {
  const auto plan = ToyPlan({.vary = kToyVary, .targets = kTwoKinds, .runs = 1000});
  ASSERT_FALSE(plan.ok());
  EXPECT_EQ(plan.error().message,
            "1,000 runs are too few for a posterior over 3 keys: at least 40 settings with 64 runs each are "
            "needed, 2,560 runs in all");
}

TEST(FitPlanTest, WithoutTargetsOrKeysThereIsNothingToFit) {
  EXPECT_EQ(ToyPlan({.vary = kToyVary}).error().message, "there is no target to fit to");
  EXPECT_EQ(ToyPlan({.targets = kTwoKinds}).error().message,
            "nothing varies: --vary KEY=LOW..HIGH is needed");
}

}  // namespace
}  // namespace gauntlet
