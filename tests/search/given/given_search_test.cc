// Covers: search/given/repeated_case.cc
#include "search/given/given_search.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <functional>
#include <map>
#include <set>

#include "search/given/case_minimiser.h"
#include "search/given/repeated_case.h"
#include "tests/search/toy_search.h"

namespace gauntlet {
namespace {

SearchSetup SetupToConfirm(std::size_t cases, int replicates = 0) {
  SearchSetup setup = ToySetup();
  setup.experiment = ConfirmationOf(setup.experiment, replicates);
  setup.row = &RowOf(setup.experiment);
  for (std::size_t i = 0; i < cases; ++i) {
    setup.cases.emplace_back().obstacles = {{.x = static_cast<double>(i), .length = 1, .width = 0.2}};
  }
  return setup;
}

std::unique_ptr<SearchAlgorithm> MakeGiven(const SearchSetup& setup) {
  return std::move(GivenSearch::Create(setup)).value();
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

using Answer = std::function<EvaluationOutcome(const EvaluationRequest&)>;

EvaluationOutcome OutcomeOfCase(const EvaluationRequest& request) {
  return Confirmed(request, Fails(request));
}

// Tells `at_once` outcomes between two calls of Ask; returns everything that was asked for.
std::vector<EvaluationRequest> Drive(SearchAlgorithm& search, std::size_t at_once,
                                     const Answer& answer = OutcomeOfCase) {
  std::vector<EvaluationRequest> all;
  std::size_t told = 0;
  while (!search.Progress().finished) {
    std::ranges::move(search.Ask(), std::back_inserter(all));
    if (told == all.size()) break;
    for (std::size_t i = 0; i < at_once && told < all.size(); ++i, ++told) search.Tell(answer(all[told]));
  }
  return all;
}

std::map<IndividualId, int> RunsByCase(const std::vector<EvaluationRequest>& requests) {
  std::map<IndividualId, int> runs;
  for (const EvaluationRequest& request : requests) ++runs[request.individual];
  return runs;
}

TEST(GivenSearchTest, StopsAsSoonAsACaseIsDecided) {
  const auto search = MakeGiven(SetupToConfirm(3));
  EXPECT_THAT(RunsByCase(Drive(*search, 100)),
              testing::ElementsAre(testing::Pair(1, 5), testing::Pair(2, 6), testing::Pair(3, 9)));
}

TEST(GivenSearchTest, AsksTheSameHoweverManyOutcomesComeBetweenTwoAsks) {
  const auto one = MakeGiven(SetupToConfirm(3));
  const auto many = MakeGiven(SetupToConfirm(3));
  EXPECT_TRUE(SameRequests(Drive(*one, 1), Drive(*many, 7)));
}

TEST(GivenSearchTest, GivesEveryRunOfACaseAnEvaluationOfItsOwn) {
  const auto search = MakeGiven(SetupToConfirm(3));
  std::set<std::pair<IndividualId, std::uint32_t>> seen;
  for (const EvaluationRequest& request : Drive(*search, 2)) {
    EXPECT_EQ(request.replicates, 1U);
    EXPECT_TRUE(seen.emplace(request.individual, request.evaluation).second);
  }
}

TEST(GivenSearchTest, RunsExactlyAsOftenAsWasAsked) {
  const auto search = MakeGiven(SetupToConfirm(3, 12));
  EXPECT_THAT(RunsByCase(Drive(*search, 4)),
              testing::ElementsAre(testing::Pair(1, 12), testing::Pair(2, 12), testing::Pair(3, 12)));
}

TEST(GivenSearchTest, ARunWithoutAResultEndsItsCase) {
  const auto search = MakeGiven(SetupToConfirm(1));
  for (const EvaluationRequest& request : search->Ask()) {
    search->Tell(Confirmed(request, false, sim::Verdict::kCrashed));
  }
  EXPECT_TRUE(search->Ask().empty());
  EXPECT_TRUE(search->Progress().finished);
}

TEST(GivenSearchTest, IsFinishedAgainWhenItsStateIsRestored) {
  const SearchSetup setup = SetupToConfirm(3);
  const auto search = MakeGiven(setup);
  std::vector<EvaluationOutcome> told;
  for (const EvaluationRequest& request : Drive(*search, 3))
    told.push_back(Confirmed(request, Fails(request)));
  ASSERT_TRUE(search->AtBoundary());
  const auto again = MakeGiven(setup);
  ASSERT_TRUE(RestoreState(*again, StateOf(*search), told));
  EXPECT_TRUE(again->Progress().finished);
  EXPECT_TRUE(again->Ask().empty());
  EXPECT_EQ(StateOf(*again), StateOf(*search));
}

TEST(GivenSearchTest, SeedsAreThoseOfTheCaseAndNoSearchHasThem) {
  const SearchSetup setup = SetupToConfirm(2);
  const sim::TestCase& one = setup.cases[0];
  const auto seed_of = [&](IndividualId individual, const sim::TestCase& test_case) {
    return RunSeed(setup.experiment, {.individual = individual, .test_case = test_case}, /*replicate=*/0);
  };
  EXPECT_EQ(seed_of(1, one), seed_of(2, one));
  EXPECT_NE(seed_of(1, one), seed_of(1, setup.cases[1]));
  for (const SearchRow& row : Searches()) {
    EXPECT_EQ(row.purpose == sim::SeedPurpose::kConfirm, row.info.name == "confirmation") << row.info.name;
  }
}

// Obstacles are told apart by their x.
SearchSetup SetupToShorten(std::size_t cases) {
  SearchSetup setup = ToySetup();
  setup.experiment = MinimisationOf(setup.experiment, false);
  setup.row = &RowOf(setup.experiment);
  for (std::size_t i = 0; i < cases; ++i) {
    sim::TestCase& one = setup.cases.emplace_back();
    one.side_x = 6.0 + static_cast<double>(i);
    for (int x = 0; x < 8; ++x) one.obstacles.push_back({.x = 0.1 * x, .length = 1, .width = 0.2});
  }
  return setup;
}

// Obstacles 2 and 5 together break the swarm; of the second case obstacle 0.
bool Breaks(const sim::TestCase& test_case) {
  const auto has = [&](double x) {
    return std::ranges::count(test_case.obstacles, x, &sim::ObstacleGene::x) > 0;
  };
  return test_case.side_x > 6.5 ? has(0.0) : has(0.1 * 2) && has(0.1 * 5);
}

EvaluationOutcome OutcomeOfLayout(const EvaluationRequest& request) {
  RunOutcome run;
  run.total_failure = Breaks(request.test_case);
  return OutcomeOfRuns(request.individual, request.evaluation, {run});
}

// What is left of a case is what its last runs verify.
sim::Genome LeftOf(const std::vector<EvaluationRequest>& asked, double side) {
  sim::Genome left;
  for (const EvaluationRequest& one : asked) {
    if (one.test_case.side_x == side) left = one.test_case.obstacles;
  }
  return left;
}

TEST(GivenSearchTest, FindsWhatIsNeededOfEveryCase) {
  const SearchSetup setup = SetupToShorten(2);
  const std::vector<EvaluationRequest> asked = Drive(*MakeGiven(setup), 5, OutcomeOfLayout);
  const sim::Genome& all = setup.cases[0].obstacles;
  EXPECT_THAT(LeftOf(asked, 6.0), testing::ElementsAre(all[2], all[5]));
  EXPECT_THAT(LeftOf(asked, 7.0), testing::ElementsAre(all[0]));
}

// Robots stay at the right end, where obstacle 7 alone stands: it is not the first that is taken away.
TEST(GivenSearchTest, CountsWhereRobotsWere) {
  const auto search = MakeGiven(SetupToShorten(1));
  std::vector<EvaluationRequest> asked;
  while (!search->Progress().finished) {
    for (const EvaluationRequest& request : search->Ask()) {
      asked.push_back(request);
      EvaluationOutcome outcome = OutcomeOfLayout(request);
      outcome.runs[0].robots.resize(1);
      outcome.runs[0].robots[0].waypoints = {{1.35, 0.0}, {1.35, 0.0}};
      search->Tell(outcome);
    }
  }
  const auto without = [&](double x) {
    return std::ranges::find_if(asked, [&](const EvaluationRequest& request) {
      const sim::Genome& genome = request.test_case.obstacles;
      return !genome.empty() && std::ranges::count(genome, x, &sim::ObstacleGene::x) == 0;
    });
  };
  EXPECT_LT(without(0.1 * 6) - asked.begin(), without(0.1 * 7) - asked.begin());
}

TEST(GivenSearchTest, ChildrenAreAskedForInTheSameOrderHoweverManyOutcomesCome) {
  const auto one = MakeGiven(SetupToShorten(2));
  const auto many = MakeGiven(SetupToShorten(2));
  EXPECT_TRUE(SameRequests(Drive(*one, 1, OutcomeOfLayout), Drive(*many, 9, OutcomeOfLayout)));
}

TEST(GivenSearchTest, NoTwoRunsHaveTheSameSeed) {
  const SearchSetup setup = SetupToShorten(1);
  std::set<std::uint64_t> seeds;
  for (const EvaluationRequest& request : Drive(*MakeGiven(setup), 3, OutcomeOfLayout)) {
    EXPECT_TRUE(seeds.insert(RunSeed(setup.experiment, request, /*replicate=*/0)).second);
  }
}

TEST(GivenSearchTest, LayoutsAreChildrenOfTheirCase) {
  const auto search = MakeGiven(SetupToShorten(2));
  Drive(*search, 4, OutcomeOfLayout);
  const std::vector<Individual> born = search->TakeNewborns();
  ASSERT_GT(born.size(), 2U);
  EXPECT_TRUE(born[0].parents.empty());
  for (std::size_t i = 2; i < born.size(); ++i) {
    EXPECT_EQ(born[i].id, i + 1);
    const double side = born[i].test_case.side_x;
    EXPECT_THAT(born[i].parents, testing::ElementsAre(side > 6.5 ? 2 : 1));
  }
}

TEST(GivenSearchTest, AStateWithRunsThatItWouldNotAskForIsRefused) {
  const SearchSetup setup = SetupToShorten(2);
  const auto search = MakeGiven(setup);
  std::vector<EvaluationOutcome> told;
  for (const EvaluationRequest& request : Drive(*search, 3, OutcomeOfLayout))
    told.push_back(OutcomeOfLayout(request));
  ASSERT_TRUE(search->AtBoundary());
  const auto again = MakeGiven(setup);
  ASSERT_TRUE(RestoreState(*again, StateOf(*search), told));
  EXPECT_TRUE(again->Progress().finished);
  told.pop_back();
  EXPECT_FALSE(RestoreState(*MakeGiven(setup), StateOf(*search), told));
}

std::vector<sim::TestCase> ThreeCases() {
  std::vector<sim::TestCase> cases(3);
  cases[0].name = "empty";
  cases[1].obstacles = {{.x = 1, .y = 0, .length = 1, .width = 0.2, .orientation_deg = 30}};
  cases[2].obstacles = cases[1].obstacles;
  return cases;
}

std::unique_ptr<SearchAlgorithm> MakeList(std::vector<sim::TestCase> cases, int replicates) {
  SearchSetup setup = ToySetup();
  SetAlgorithm(setup, "cases");
  setup.experiment.search.replicates = replicates;
  setup.cases = std::move(cases);
  return MakeGiven(setup);
}

TEST(GivenSearchTest, AsksEveryCaseOnceWithItsReplicates) {
  const auto list = MakeList(ThreeCases(), 5);
  SearchAlgorithm& search = *list;
  EXPECT_FALSE(search.Progress().finished);
  const std::vector<EvaluationRequest> requests = RunOneAsk(search, Noise);
  ASSERT_EQ(requests.size(), 3U);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(requests[i].individual, i + 1);
    EXPECT_EQ(requests[i].replicates, 5U);
  }
  EXPECT_EQ(requests[0].test_case.name, "empty");
  EXPECT_TRUE(search.Progress().finished);
  EXPECT_TRUE(search.Ask().empty());
  EXPECT_EQ(search.TakeNewborns().size(), 3U);
  EXPECT_EQ(search.Population()[1].fitness, Noise(requests[1]));
}

TEST(GivenSearchTest, CountsDistinctGenomes) {
  EXPECT_EQ(CountDistinctGenomes(MakeList(ThreeCases(), 1)->Population()), 2U);
}

TEST(GivenSearchTest, AnEmptyListIsFinished) {
  const auto list = MakeList({}, 1);
  SearchAlgorithm& search = *list;
  EXPECT_TRUE(search.Ask().empty());
  EXPECT_TRUE(search.Progress().finished);
  EXPECT_TRUE(search.AtBoundary());
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

TEST(FailureTallyTest, RefusedRunsOfAProgramAreLeftOutUntilTheyAreHalf) {
  EXPECT_EQ(VerdictOf({.failures = 5, .passes = 5, .refused = 9}, 0), FailureVerdict::kFail);
  EXPECT_EQ(VerdictOf({.passes = 6, .refused = 5}, 0), FailureVerdict::kPass);
  EXPECT_EQ(VerdictOf({.passes = 6, .refused = 6}, 0), FailureVerdict::kError);
  EXPECT_EQ(VerdictOf({.failures = 10, .passes = 10, .refused = 19}, 20), FailureVerdict::kFail);
  EXPECT_EQ(VerdictOf({.failures = 10, .passes = 9, .refused = 20}, 20), FailureVerdict::kError);
  EXPECT_EQ(RunsToVerdict({.failures = 10, .passes = 8, .refused = 4}, 20), 2) << "they are made up for";
  EXPECT_EQ(RunsToVerdict({.refused = 8}, 0), 2) << "after which all ten were refused";
  EXPECT_EQ(VerdictOf({.refused = 10}, 0), FailureVerdict::kError);
}

TEST(RunJudgeTest, ARefusedRunIsLeftOutOfAProgramAndAnErrorElsewhere) {
  Experiment experiment;
  for (const bool program : {true, false}) {
    experiment.scenario = program ? "command" : "flocking";
    const RunJudge judge(experiment);
    const FailureTally refused = judge.WhatBecameOf({.verdict = sim::Verdict::kRefused}, {}).tally;
    EXPECT_EQ(refused.refused, program ? 1 : 0);
    EXPECT_EQ(refused.errors, program ? 0 : 1);
    EXPECT_EQ(judge.WhatBecameOf({.verdict = sim::Verdict::kCrashed}, {}).tally.errors, 1);
  }
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
