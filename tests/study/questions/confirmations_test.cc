// How often cases fail again: the reader, the key, and what is told.
// Covers: search/failure_tally.cc
#include "study/questions/confirmations.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "search/given/repeated_case.h"
#include "tests/study/questions/answering.h"

namespace gauntlet {
namespace {

using testing::SizeIs;
using namespace testing_support;  // NOLINT(google-build-using-namespace)

// The case of run 4 always fails, that of run 5 in every third run, that of the file never.
std::vector<CaseAnswer> Confirmed(int replicates = 0) {
  return Answers(
      ConfirmationOf(Flocking(), replicates), {Walls(1, "run 4"), Walls(2, "run 5"), Walls(3, "walls.json")},
      [](const EvaluationRequest& request) {
        return Ended(request.individual == 1 || (request.individual == 2 && request.evaluation % 3 == 0));
      },
      ConfirmationKey);
}

TEST(ConfirmationKey, IsThatOfTheCaseAndTheExperimentHoweverManyRunsAreWanted) {
  const Experiment flocking = Flocking();
  EXPECT_EQ(ConfirmationKey(flocking, Walls(1, "a wall")), ConfirmationKey(flocking, Walls(1)));
  EXPECT_NE(ConfirmationKey(flocking, Walls(1)), ConfirmationKey(flocking, Walls(2)));
  EXPECT_NE(ConfirmationKey(flocking, Walls(1)), ConfirmationKey(Flocking({"seed=2"}), Walls(1)));
  EXPECT_EQ(Confirmed(20)[0].key, ConfirmationKey(flocking, Walls(1)));
}

TEST(ConfirmationIn, HasTheVerdictAndTheRunThatShowsItBest) {
  const std::vector<CaseAnswer> answers = Confirmed();
  const Confirmation fails = ConfirmationIn(answers[0]);
  EXPECT_EQ(fails.run, 4U);
  EXPECT_EQ(fails.tally.failures, 5);
  EXPECT_EQ(fails.verdict, FailureVerdict::kFail);
  EXPECT_EQ(fails.campaign, "d/asked/1");
  ASSERT_THAT(fails.failed, SizeIs(5));
  EXPECT_EQ(fails.failed[0].features.place.substr(0, 5), "near ");
  EXPECT_EQ(fails.Typical(), &fails.failed[0]);
  EXPECT_EQ(ConfirmationIn(answers[1]).verdict, FailureVerdict::kFlaky);
  const Confirmation passes = ConfirmationIn(answers[2]);
  EXPECT_EQ(passes.verdict, FailureVerdict::kPass);
  EXPECT_EQ(passes.Typical(), nullptr);
  EXPECT_EQ(ConfirmationIn(Confirmed(20)[1]).tally.runs(), 20);
}

TEST(ConfirmQuestion, AnAnswerIsEnoughUnlessMoreRunsAreWanted) {
  const CaseAnswer five = Confirmed()[0];
  const auto enough = [&](const CaseAnswer& answer, const std::string& replicates) {
    return ConfirmQuestion().enough(answer, {.options = {{"--replicates", {replicates}}}});
  };
  EXPECT_TRUE(enough(five, ""));
  EXPECT_TRUE(enough(five, "5"));
  EXPECT_FALSE(enough(five, "6"));
  CaseAnswer crashed = five;
  crashed.runs[0].became.tally = {.errors = 1};  // it would end without a result again
  EXPECT_TRUE(enough(crashed, "6"));
}

TEST(ConfirmQuestion, TellsATableAndLeadsOnToTheObstaclesOfTheToughest) {
  const Told told = ConfirmQuestion().tell({.place = "d"}, {}, Confirmed()).value();
  EXPECT_EQ(ToText(told.section),
            "  case        failed  probability (95 %)  verdict\n"
            "  run 4       5 of 5   57 to 100 %        fail\n"
            "  run 5       3 of 9   12 to  65 %        flaky\n"
            "  walls.json  0 of 6    0 to  39 %        pass\n"
            "  1 of 3 cases (1 from a file) confirmed: with fresh seeds they fail in at least half of the "
            "runs.\n"
            "  How often it fails without any obstacle is not known: gauntlet baseline d looks.\n"
            "  gauntlet minimise d 4  # which of its obstacles does it take?\n"
            "  gauntlet blame d 4     # how much does each of them do?\n");
  EXPECT_EQ(told.conclusion, Conclusion::kDone);
}

TEST(ToughestOf, IsThatOfTheHighestLowerBound) {
  const auto failed = [](RunId run, int failures, int passes) {
    Confirmation one{.run = run, .tally = {.failures = failures, .passes = passes}};
    one.verdict = FailureVerdict::kFail;
    one.interval = FailureInterval(one.tally);
    return one;
  };
  const std::vector<Confirmation> known = {failed(1, 5, 0), failed(2, 95, 5), failed(0, 100, 0)};
  EXPECT_EQ(ToughestOf(known)->run, 2U) << "5 of 5 runs say less; a case from a file has no run";
  EXPECT_EQ(ToughestOf({}), nullptr);
}

TEST(Confirmation, ItsTypicalRunFailsAsMostOfItsRuns) {
  Confirmation one;
  one.failed = {{1, {"a", "x"}}, {2, {"b", "y"}}, {3, {"b", "x"}}, {4, {"b", "x"}}};
  EXPECT_EQ(one.Typical()->id, 3U);
}

}  // namespace
}  // namespace gauntlet
