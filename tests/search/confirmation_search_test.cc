#include "search/given/confirmation_search.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <map>
#include <set>

#include "tests/search/toy_search.h"

namespace gauntlet {
namespace {

SearchSetup SetupOfCases(std::size_t cases, int replicates = 0) {
  SearchSetup setup = ToySetup();
  setup.experiment = ConfirmationOf(setup.experiment, replicates);
  setup.row = &RowOf(setup.experiment);
  for (std::size_t i = 0; i < cases; ++i) {
    setup.cases.emplace_back().obstacles = {{.x = static_cast<double>(i), .length = 1, .width = 0.2}};
  }
  return setup;
}

std::unique_ptr<ConfirmationSearch> MakeConfirmation(const SearchSetup& setup) {
  return std::move(ConfirmationSearch::Create(setup)).value();
}

EvaluationOutcome Confirmed(const EvaluationRequest& request, bool failed,
                            sim::Verdict verdict = sim::Verdict::kCompleted) {
  return OutcomeOfRuns(
      request.individual, request.evaluation,
      {{.verdict = verdict, .fitness = failed ? 0.0 : 1.0, .total_failure = failed, .metrics = {}}});
}

// Case 1 always fails, case 2 never, case 3 in every second run.
bool Fails(const EvaluationRequest& request) {
  if (request.individual == 3) return request.evaluation % 2 == 0;
  return request.individual == 1;
}

// Tells `at_once` outcomes between two calls of Ask; returns everything that was asked for.
std::vector<EvaluationRequest> Drive(ConfirmationSearch& search, std::size_t at_once) {
  std::vector<EvaluationRequest> all;
  std::size_t told = 0;
  while (!search.Progress().finished) {
    std::ranges::move(search.Ask(), std::back_inserter(all));
    if (told == all.size()) break;
    for (std::size_t i = 0; i < at_once && told < all.size(); ++i, ++told) {
      search.Tell(Confirmed(all[told], Fails(all[told])));
    }
  }
  return all;
}

std::map<IndividualId, int> RunsByCase(const std::vector<EvaluationRequest>& requests) {
  std::map<IndividualId, int> runs;
  for (const EvaluationRequest& request : requests) ++runs[request.individual];
  return runs;
}

TEST(ConfirmationSearchTest, StopsAsSoonAsACaseIsDecided) {
  const auto search = MakeConfirmation(SetupOfCases(3));
  EXPECT_THAT(RunsByCase(Drive(*search, 100)),
              testing::ElementsAre(testing::Pair(1, 5), testing::Pair(2, 6), testing::Pair(3, 9)));
}

TEST(ConfirmationSearchTest, AsksTheSameHoweverManyOutcomesComeBetweenTwoAsks) {
  const auto one = MakeConfirmation(SetupOfCases(3));
  const auto many = MakeConfirmation(SetupOfCases(3));
  EXPECT_TRUE(SameRequests(Drive(*one, 1), Drive(*many, 7)));
}

TEST(ConfirmationSearchTest, GivesEveryRunOfACaseAnEvaluationOfItsOwn) {
  const auto search = MakeConfirmation(SetupOfCases(3));
  std::set<std::pair<IndividualId, std::uint32_t>> seen;
  for (const EvaluationRequest& request : Drive(*search, 2)) {
    EXPECT_EQ(request.replicates, 1U);
    EXPECT_TRUE(seen.emplace(request.individual, request.evaluation).second);
  }
}

TEST(ConfirmationSearchTest, RunsExactlyAsOftenAsWasAsked) {
  const auto search = MakeConfirmation(SetupOfCases(3, 12));
  EXPECT_THAT(RunsByCase(Drive(*search, 4)),
              testing::ElementsAre(testing::Pair(1, 12), testing::Pair(2, 12), testing::Pair(3, 12)));
}

TEST(ConfirmationSearchTest, ARunWithoutAResultEndsItsCase) {
  const auto search = MakeConfirmation(SetupOfCases(1));
  for (const EvaluationRequest& request : search->Ask()) {
    search->Tell(Confirmed(request, false, sim::Verdict::kCrashed));
  }
  EXPECT_TRUE(search->Ask().empty());
  EXPECT_TRUE(search->Progress().finished);
}

TEST(ConfirmationSearchTest, IsFinishedAgainWhenItsStateIsRestored) {
  const SearchSetup setup = SetupOfCases(3);
  const auto search = MakeConfirmation(setup);
  std::vector<EvaluationOutcome> told;
  for (const EvaluationRequest& request : Drive(*search, 3))
    told.push_back(Confirmed(request, Fails(request)));
  ASSERT_TRUE(search->AtBoundary());
  const auto again = MakeConfirmation(setup);
  ASSERT_TRUE(RestoreState(*again, StateOf(*search), told));
  EXPECT_TRUE(again->Progress().finished);
  EXPECT_TRUE(again->Ask().empty());
  EXPECT_EQ(StateOf(*again), StateOf(*search));
}

TEST(ConfirmationSearchTest, SeedsAreThoseOfTheCaseAndNoSearchHasThem) {
  const SearchSetup setup = SetupOfCases(2);
  const sim::TestCase& one = setup.cases[0];
  const auto seed_of = [&](IndividualId individual, const sim::TestCase& test_case) {
    return RunSeed(setup.experiment, {.individual = individual, .test_case = test_case}, 0);
  };
  EXPECT_EQ(seed_of(1, one), seed_of(2, one));
  EXPECT_NE(seed_of(1, one), seed_of(1, setup.cases[1]));
  for (const SearchRow& row : Searches()) {
    EXPECT_EQ(row.purpose == sim::SeedPurpose::kConfirm, row.info.name == "confirmation") << row.info.name;
  }
}

TEST(FailureTallyTest, KeepsTheFourVerdictsApart) {
  EXPECT_EQ(VerdictOf({.failures = 4, .passes = 5}, 0), FailureVerdict::kOpen);
  EXPECT_EQ(VerdictOf({.failures = 5, .passes = 5}, 0), FailureVerdict::kFail);
  EXPECT_EQ(VerdictOf({.failures = 4, .passes = 6}, 0), FailureVerdict::kFlaky);
  EXPECT_EQ(VerdictOf({.failures = 0, .passes = 6}, 0), FailureVerdict::kPass);
  EXPECT_EQ(VerdictOf({.failures = 5, .errors = 1}, 0), FailureVerdict::kError);
  EXPECT_EQ(VerdictOf({.failures = 5, .passes = 0}, 20), FailureVerdict::kOpen);
  EXPECT_EQ(VerdictOf({.failures = 10, .passes = 10}, 20), FailureVerdict::kFail);
}

TEST(FailureTallyTest, ForagingFailsByItsSecondConditionAlone) {
  Experiment foraging;
  foraging.scenario = "foraging";
  FailureTally tally;
  tally.Add({.total_failure = true, .metrics = {{"condition_1", 1.0}, {"condition_2", 0.0}}},
            FailingOf(foraging));
  tally.Add({.total_failure = true, .metrics = {{"condition_1", 1.0}, {"condition_2", 1.0}}},
            FailingOf(foraging));
  EXPECT_EQ(tally.failures, 1);
  EXPECT_EQ(tally.passes, 1);
}

}  // namespace
}  // namespace gauntlet
