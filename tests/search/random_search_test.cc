#include "search/evolution/random_search.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/search/toy_search.h"

namespace gauntlet {
namespace {

SearchSetup SetupOf(int cases) {
  SearchSetup setup = ToySetup();
  SetAlgorithm(setup, "random");
  setup.experiment.search.parameters["cases"] = cases;
  return setup;
}

std::unique_ptr<RandomSearch> MakeRandom(const SearchSetup& setup) {
  return std::move(RandomSearch::Create(setup)).value();
}

TEST(RandomSearchTest, EvaluatesEveryCaseOnce) {
  const auto search = MakeRandom(SetupOf(250));
  EXPECT_EQ(search->Progress().evaluations_planned, 250U);
  const std::vector<EvaluationRequest> requests = RunToEnd(*search, Noise);
  ASSERT_EQ(requests.size(), 250U);
  for (std::size_t i = 0; i < requests.size(); ++i) {
    EXPECT_EQ(requests[i].individual, i + 1);
    EXPECT_EQ(requests[i].evaluation, 0U);
    EXPECT_EQ(requests[i].generation, 1U);
  }
  EXPECT_TRUE(search->Progress().finished);
  EXPECT_EQ(CountDistinctGenomes(search->TakeNewborns()), 250U);
  const std::vector<Individual> population = search->Population();
  ASSERT_EQ(population.size(), 250U);
  EXPECT_EQ(population[249].fitness, Noise(requests[249]));
}

TEST(RandomSearchTest, CaseKIsTheSameHoweverManyCasesThereAre) {
  const std::vector<EvaluationRequest> few = RunToEnd(*MakeRandom(SetupOf(30)), Noise);
  std::vector<EvaluationRequest> many = RunToEnd(*MakeRandom(SetupOf(150)), Noise);
  many.resize(few.size());
  EXPECT_TRUE(SameRequests(few, many));
}

TEST(RandomSearchTest, CasesThatAreKnownAreTakenAndTheOthersDrawn) {
  std::vector<EvaluationRequest> expected = RunToEnd(*MakeRandom(SetupOf(30)), Noise);
  SearchSetup setup = SetupOf(30);
  for (std::size_t i = 0; i < 20; ++i) setup.cases.push_back(expected[i].test_case);
  EXPECT_TRUE(SameRequests(RunToEnd(*MakeRandom(setup), Noise), expected));
  setup.cases[19].obstacles.clear();
  expected[19].test_case.obstacles.clear();
  EXPECT_TRUE(SameRequests(RunToEnd(*MakeRandom(setup), Noise), expected));
}

TEST(RandomSearchTest, RequestsDoNotDependOnWhenOutcomesArrive) {
  const std::vector<EvaluationRequest> expected = RunToEnd(*MakeRandom(SetupOf(450)), Noise);
  const auto search = MakeRandom(SetupOf(450));
  std::vector<EvaluationRequest> requests;
  while (true) {
    const std::vector<EvaluationRequest> more = search->Ask();
    if (more.empty()) break;
    EXPECT_LE(more.size(), RandomSearch::kChunk);
    requests.insert(requests.end(), more.begin(), more.end());
  }
  EXPECT_TRUE(SameRequests(requests, expected));
  for (const EvaluationRequest& request : requests) {
    search->Tell(OutcomeOf(request, 0.5));
    EXPECT_EQ(search->AtBoundary(), request.individual == 450) << request.individual;
  }
}

// However many cases are outstanding: a boundary depends on the number of outcomes alone.
TEST(RandomSearchTest, BoundariesComeAfterEveryIntervalAndWhatWasAskedIsAskedAgain) {
  const auto search = MakeRandom(SetupOf(2500));
  std::vector<EvaluationRequest> asked;
  std::vector<EvaluationOutcome> told;
  std::vector<std::size_t> boundaries;
  while (!search->Progress().finished) {
    const std::vector<EvaluationRequest> more = search->Ask();
    asked.insert(asked.end(), more.begin(), more.end());
    told.push_back(OutcomeOf(asked[told.size()], Noise(asked[told.size()])));
    search->Tell(told.back());
    if (!search->AtBoundary()) continue;
    boundaries.push_back(told.size());
    const auto restored = MakeRandom(SetupOf(2500));
    ASSERT_TRUE(RestoreState(*restored, StateOf(*search), told).ok());
    EXPECT_EQ(restored->Population().size(), told.size());
    EXPECT_EQ(restored->Population().back().fitness, told.back().fitness);
    if (search->Progress().finished) break;
    EXPECT_EQ(restored->Ask().front().individual, told.size() + 1);
  }
  EXPECT_THAT(boundaries, testing::ElementsAre(1000U, 2000U, 2500U));
}

TEST(RandomSearchTest, AStateWhoseRunsAreMissingIsRefused) {
  const auto search = MakeRandom(SetupOf(30));
  std::vector<EvaluationOutcome> told;
  for (const EvaluationRequest& request : search->Ask()) {
    told.push_back(OutcomeOf(request, 0.5));
    search->Tell(told.back());
  }
  told.pop_back();
  const Status restored = RestoreState(*MakeRandom(SetupOf(30)), StateOf(*search), told);
  ASSERT_FALSE(restored.ok());
  EXPECT_EQ(restored.error().kind, ErrorKind::kCorrupt);
  EXPECT_EQ(restored.error().message,
            "the saved search state is damaged: it has seen 30 evaluations, but the runs of 29 are stored");
}

TEST(RandomSearchTest, AsksNoMoreThanTheLookaheadAheadOfTheOutcomes) {
  const auto search = MakeRandom(SetupOf(3000));
  std::size_t asked = 0;
  while (true) {
    const std::size_t more = search->Ask().size();
    if (more == 0) break;
    asked += more;
  }
  EXPECT_EQ(asked, RandomSearch::kLookahead);
}

TEST(RandomSearchTest, SharesNoCaseWithAnEvolutionOfTheSameSeed) {
  SearchSetup genetic = ToySetup();
  EXPECT_NE(SearchSeed(genetic), SearchSeed(SetupOf(10)));
}

TEST(RandomSearchTest, NewbornsAreTakenOnce) {
  const auto search = MakeRandom(SetupOf(10));
  search->Ask();
  EXPECT_EQ(search->TakeNewborns().size(), 10U);
  EXPECT_TRUE(search->TakeNewborns().empty());
}

TEST(RandomSearchTest, EmptyCasesAreAllowed) {
  SearchSetup setup = SetupOf(3);
  setup.experiment.genome.genes = 0;
  for (const EvaluationRequest& request : RunToEnd(*MakeRandom(setup), Noise)) {
    EXPECT_TRUE(request.test_case.obstacles.empty());
  }
}

TEST(RandomSearchTest, RangesWithoutRoomAreRefusedAtOnce) {
  SearchSetup setup = SetupOf(10);
  setup.experiment.genome.length_min = 20.0;
  setup.experiment.genome.length_max = 20.0;
  setup.experiment.genome.width_min = 20.0;
  setup.experiment.genome.width_max = 20.0;
  setup.experiment.genome.tries_per_gene = 3;
  const auto search = RandomSearch::Create(setup);
  ASSERT_FALSE(search.ok());
  EXPECT_EQ(search.error().message,
            "no valid test case found in 100 starts with genome.genes = 8, positions -3 to 3 m, lengths 20 "
            "to 20 m, widths 20 to 20 m in an arena of 6 x 6 m: use fewer or smaller obstacles");
}

}  // namespace
}  // namespace gauntlet
