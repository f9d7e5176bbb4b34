#include "report/tables/conditions.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "analysis/statistics/proportions.h"
#include "tests/report/swept_campaign.h"

namespace gauntlet {
namespace {

using ::testing::ElementsAre;
using ::testing::SizeIs;

TEST(ConditionOf, LeavesOutTheSeedAndTheSearchThatCasesComeFrom) {
  EXPECT_EQ(ConditionOf(""), "");
  EXPECT_EQ(ConditionOf("seed 3"), "");
  EXPECT_EQ(ConditionOf("genome.genes=2, seed 3"), "genome.genes=2");
  EXPECT_EQ(ConditionOf("a=1, b=2"), "a=1, b=2");
  EXPECT_EQ(ConditionOf("evolved, seed 1"), "evolved") << "a part of a study";
  EXPECT_EQ(ConditionOf("campaigns/first:search:12"), "campaigns/first");
}

TEST(ConditionsOf, AConditionOfOneSearchHasTheIntervalOfItsCases) {
  const auto conditions =
      ConditionsOf(SweptCampaign({SearchOfCases("birds=5", 3, 30), SearchOfCases("birds=6", 0, 30)}));
  ASSERT_THAT(conditions, SizeIs(2));
  EXPECT_EQ(conditions[0].settings, "birds=5");
  EXPECT_EQ(conditions[0].failing_runs, 3U);
  EXPECT_DOUBLE_EQ(conditions[0].share, 0.1);
  const analysis::Interval wilson = analysis::WilsonInterval(3, 30, 0.95);
  EXPECT_NEAR(conditions[0].interval->low, wilson.low, 0.02) << "a run each: the cases are the runs";
  EXPECT_NEAR(conditions[0].interval->high, wilson.high, 0.02);
  EXPECT_EQ(conditions[1].interval->low, 0.0);
  EXPECT_EQ(RangeOf(conditions), "from 0.0 % (birds=6) to 10.0 % (birds=5)");
}

TEST(ConditionsOf, SearchesThatDifferInTheirSeedAreUnitsOfOneCondition) {
  const auto conditions = ConditionsOf(
      SweptCampaign({SearchOfCases("seed 1", 10, 10, "genetic"), SearchOfCases("seed 2", 0, 10, "genetic")}));
  ASSERT_THAT(conditions, SizeIs(1));
  EXPECT_THAT(conditions[0].searches, ElementsAre(0, 1));
  EXPECT_DOUBLE_EQ(conditions[0].share, 0.5);
  EXPECT_LT(conditions[0].interval->low, 0.1) << "two searches that differ wholly say next to nothing";
  EXPECT_GT(conditions[0].interval->high, 0.9);
}

TEST(ConditionsOf, OneSearchThatLearnsHasNoIntervalAndOneCaseThatOfItsRuns) {
  const auto learning = ConditionsOf(SweptCampaign({SearchOfCases("", 5, 10, "genetic")}));
  EXPECT_FALSE(learning[0].interval.has_value());
  SearchSummary one_case = SearchOfCases("", 0, 1);
  one_case.population[0].runs = {1, 2, 3, 4};
  one_case.population[0].failing_runs = one_case.failing_runs = 2;
  one_case.runs_done = 4;
  const auto alone = ConditionsOf(SweptCampaign({one_case}));
  EXPECT_DOUBLE_EQ(alone[0].interval->low, analysis::WilsonInterval(2, 4, 0.95).low);
}

TEST(ConditionsTable, NamesTheSearchesOnlyWhereThereAreSeveralOfASetting) {
  const auto single = ConditionsOf(SweptCampaign({SearchOfCases("a=1", 1, 2), SearchOfCases("a=2", 2, 2)}));
  EXPECT_THAT(ConditionsTable(single).ToText(), ::testing::Not(::testing::HasSubstr("searches")));
  EXPECT_EQ(ConditionsTable(single).ToJson()[1]["searches"], 1) << "programs are told in any case";
}

}  // namespace
}  // namespace gauntlet
