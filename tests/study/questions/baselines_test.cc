#include "study/questions/baselines.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "study/questions/questioned_cases.h"
#include "tests/study/questions/answering.h"

namespace gauntlet {
namespace {

Baseline Of(int failures, int passes, const std::string& settings = "") {
  return {settings, {.failures = failures, .passes = passes}};
}

TEST(BaselineTest, IsTwentyRunsOfTheArenaWithoutObstacles) {
  const Experiment about = BaselineQuestion().about(testing_support::Flocking(), {}).value();
  const auto answers = testing_support::Answers(
      about, {EmptyArena(about.arena)},
      [](const EvaluationRequest& request) {
        EXPECT_TRUE(request.test_case.obstacles.empty());
        return testing_support::Ended(request.evaluation < 13);
      },
      KeyOfCase);
  ASSERT_EQ(answers.size(), 1U);
  EXPECT_TRUE(answers[0].decided);
  EXPECT_EQ(answers[0].tally().failures, 13);
  EXPECT_EQ(answers[0].tally().runs(), kBaselineRuns);
}

TEST(BaselineTest, LeadsWhereItMatters) {
  EXPECT_EQ(InWords({Of(13, 7)}, "gauntlet", "d"),
            "It fails without any obstacle in 13 of 20 runs: what follows says little about obstacles.");
  EXPECT_EQ(
      InWords({Of(2, 18)}, "gauntlet", "d"),
      "It fails without any obstacle in 2 of 20 runs: a failure may have nothing to do with obstacles.");
  EXPECT_EQ(InWords({Of(0, 20)}, "gauntlet", "d"), "It fails without any obstacle in 0 of 20 runs.");
  EXPECT_EQ(InWords({}, "gauntlet", "a d"),
            "How often it fails without any obstacle is not known: gauntlet baseline 'a d' looks.");
  EXPECT_TRUE(Matters({Of(13, 7)}));
  EXPECT_TRUE(Matters({Of(2, 18)}));
  EXPECT_FALSE(Matters({Of(1, 19)}));
  EXPECT_FALSE(Matters({}));
}

TEST(BaselineTest, NamesTheWorstOfASweep) {
  EXPECT_EQ(
      InWords({Of(20, 0, "n=3"), Of(9, 11, "n=4"), Of(1, 19, "n=5"), Of(0, 20, "n=6")}, "gauntlet", "d"),
      "It fails without any obstacle in 20 of 20 runs (n=3), 9 of 20 runs (n=4), 1 of 20 runs (n=5) and 1 "
      "more: what follows says little about obstacles.");
}

TEST(BaselineTest, IsAskedOfSearchesThatMakeLayouts) {
  for (const char* search : {"genetic", "random", "archive", "steady-state"})
    EXPECT_TRUE(HasBaseline(search));
  for (const char* search : {"cases", "confirmation", "fit", "no such search"})
    EXPECT_FALSE(HasBaseline(search));
}

}  // namespace
}  // namespace gauntlet
