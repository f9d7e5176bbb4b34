// Which cases a call asks about, and what is known of them already.
#include "study/questions/questioned_cases.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "search/experiment/experiment_file.h"
#include "search/given/confirmation_search.h"
#include "study/questions/confirmations.h"
#include "study/questions/minimisations.h"
#include "tests/support/process.h"

namespace gauntlet {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;
using testing::SizeIs;

Experiment Flocking(const std::vector<std::string>& sets = {}) {
  return *LoadExperiment("flocking", sets, BuiltInCatalogue());
}

// One wall at x.
sim::TestCase Wall(double x) {
  sim::TestCase one;
  one.obstacles.push_back({x, 0.0, 1.0, 0.2, 0.0});
  return one;
}

// Three runs of two cases: the first and the last are of one.
QuestionedCampaign Questioned() {
  QuestionedCampaign questioned{{{"", Flocking()}}, {}};
  questioned.cases = {{"run 1", 0, Wall(0.5)}, {"run 2", 0, Wall(1.0)}, {"run 3", 0, Wall(0.5)}};
  return questioned;
}

std::vector<std::string> NamesOf(const CallPlan& call) {
  std::vector<std::string> names;
  for (const SearchPlan& search : call.searches)
    for (const sim::TestCase& one : search.cases) names.push_back(one.name);
  return names;
}

Experiment Confirming(const Experiment& experiment) {
  return ConfirmationOf(experiment, 0);
}

TEST(RunOfName, IsTheNumberOfARunAndOfNothingElse) {
  EXPECT_EQ(RunOfName("run 17"), 17U);
  for (const char* none : {"", "run", "run ", "run x", "run 17 ", "run 1.json", "walls.json", "Run 17"})
    EXPECT_EQ(RunOfName(none), 0U) << none;
}

TEST(KeyOfCase, IsThatOfTheLayoutAndTheExperimentNotOfTheName) {
  sim::TestCase named = Wall(0.5);
  named.name = "a wall";
  EXPECT_EQ(KeyOfCase(Confirming(Flocking()), named), KeyOfCase(Confirming(Flocking()), Wall(0.5)));
  EXPECT_NE(KeyOfCase(Confirming(Flocking()), Wall(0.5)), KeyOfCase(Confirming(Flocking()), Wall(0.6)));
  EXPECT_NE(KeyOfCase(Confirming(Flocking()), Wall(0.5)),
            KeyOfCase(Confirming(Flocking({"seed=2"})), Wall(0.5)));
}

TEST(PlanCall, AsksAboutEqualCasesOnceAndFindsTheSameFolderAgain) {
  const CallPlan call = PlanCall("d", Questioned(), Confirming);
  EXPECT_THAT(NamesOf(call), ElementsAre("run 1", "run 2"));
  EXPECT_EQ(PlanCall("d", Questioned(), Confirming).directory, call.directory);
  QuestionedCampaign fewer = Questioned();
  fewer.cases.resize(1);
  EXPECT_NE(PlanCall("d", fewer, Confirming).directory, call.directory);
  fewer.cases.clear();
  EXPECT_THAT(PlanCall("d", fewer, Confirming).searches, IsEmpty());
}

TEST(PlanConfirmation, LeavesOutWhatIsKnownUnlessMoreRunsAreWanted) {
  Confirmation known;
  known.key = ConfirmationKey(Flocking(), Wall(0.5));
  known.tally = {.failures = 5, .passes = 1, .errors = 0};
  known.verdict = FailureVerdict::kFail;
  EXPECT_THAT(NamesOf(PlanConfirmation("c", Questioned(), {}, 0)), ElementsAre("run 1", "run 2"));
  EXPECT_THAT(NamesOf(PlanConfirmation("c", Questioned(), {known}, 0)), ElementsAre("run 2"));
  EXPECT_THAT(NamesOf(PlanConfirmation("c", Questioned(), {known}, 6)), ElementsAre("run 2"));
  EXPECT_THAT(NamesOf(PlanConfirmation("c", Questioned(), {known}, 7)), ElementsAre("run 1", "run 2"));
  known.verdict = FailureVerdict::kError;  // it would end without a result again
  EXPECT_THAT(NamesOf(PlanConfirmation("c", Questioned(), {known}, 7)), ElementsAre("run 2"));
}

TEST(DistinctFailures, AreByPlaceToughestFirstWithTheSmallestLayout) {
  const auto failed = [](RunId run, int failures, sim::Vec2 place, FailureVerdict verdict) {
    Confirmation one;
    one.run = run;
    one.tally = {.failures = failures, .passes = 10 - failures, .errors = 0};
    one.verdict = verdict;
    one.example = {"flocking", {0, place}, "c/confirm/1", 7};
    return one;
  };
  const std::vector<Confirmation> known = {failed(1, 3, {1.0, 1.0}, FailureVerdict::kFlaky),
                                           failed(2, 9, {1.0, 1.0}, FailureVerdict::kFail),
                                           failed(3, 6, {-1.0, 0.5}, FailureVerdict::kFail), Confirmation{}};
  SmallestLayout large, small;
  large.run = 2;
  large.document.test_case.obstacles.resize(4);
  small.run = 1;
  small.document.test_case.obstacles.resize(2);
  const std::vector<SmallestLayout> layouts = {large, small};
  const std::vector<DistinctFailure> distinct = DistinctFailures(known, layouts);
  ASSERT_THAT(distinct, SizeIs(2));
  EXPECT_THAT(distinct[0].cases, ElementsAre(&known[1], &known[0]));
  EXPECT_TRUE(distinct[0].confirmed);
  EXPECT_EQ(distinct[0].what, "near (1.0, 1.0)");
  EXPECT_EQ(distinct[0].smallest, &layouts[1]);
  EXPECT_THAT(distinct[1].cases, ElementsAre(&known[2]));
  EXPECT_EQ(distinct[1].smallest, nullptr);
}

TEST(QuestionReaders, KnowNothingOfACampaignThatNobodyAskedAbout) {
  const testing_support::TemporaryDirectory campaign;
  EXPECT_THAT(*ReadConfirmations(campaign.path()), IsEmpty());
  EXPECT_THAT(*ReadMinimisations(campaign.path()), IsEmpty());
}

}  // namespace
}  // namespace gauntlet
