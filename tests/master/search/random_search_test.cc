#include "master/search/random_search.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/master/search/toy_search.h"

namespace gauntlet::master {
namespace {

using ::testing::HasSubstr;

SearchSetup SetupOf(int cases) {
  SearchSetup setup = ToySetup();
  setup.experiment.search.kind = SearchKind::kRandom;
  setup.experiment.search.cases = cases;
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
  EXPECT_EQ(StatisticOf(*search, "distinct_individuals"), 250.0);
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
  EXPECT_FALSE(search->AtBoundary());
  for (const EvaluationRequest& request : requests) search->Tell(OutcomeOf(request, 0.5));
  EXPECT_TRUE(search->AtBoundary());
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
  EXPECT_THAT(search.error().message, HasSubstr("no valid test case found"));
}

}  // namespace
}  // namespace gauntlet::master
