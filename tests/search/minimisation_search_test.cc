#include "search/given/minimisation_search.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <set>

#include "tests/search/toy_search.h"

namespace gauntlet {
namespace {

using testing::ElementsAre;

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

std::unique_ptr<MinimisationSearch> MakeMinimisation(const SearchSetup& setup) {
  return std::move(MinimisationSearch::Create(setup)).value();
}

// Obstacles 2 and 5 together break the swarm; of the second case obstacle 0.
bool Fails(const sim::TestCase& test_case) {
  const auto has = [&](double x) {
    return std::ranges::count(test_case.obstacles, x, &sim::ObstacleGene::x) > 0;
  };
  return test_case.side_x > 6.5 ? has(0.0) : has(0.1 * 2) && has(0.1 * 5);
}

EvaluationOutcome Answer(const EvaluationRequest& request) {
  RunOutcome run;
  run.total_failure = Fails(request.test_case);
  return OutcomeOfRuns(request.individual, request.evaluation, {run});
}

// Tells `at_once` outcomes between two calls of Ask.
std::vector<EvaluationRequest> Drive(MinimisationSearch& search, std::size_t at_once) {
  std::vector<EvaluationRequest> all;
  std::size_t told = 0;
  while (!search.Progress().finished) {
    std::ranges::move(search.Ask(), std::back_inserter(all));
    if (told == all.size()) break;
    for (std::size_t i = 0; i < at_once && told < all.size(); ++i, ++told) search.Tell(Answer(all[told]));
  }
  return all;
}

TEST(MinimisationSearchTest, FindsWhatIsNeededOfEveryCase) {
  const SearchSetup setup = SetupToShorten(2);
  const auto search = MakeMinimisation(setup);
  const std::vector<EvaluationRequest> asked = Drive(*search, 5);
  EXPECT_THAT(search->MinimiserOf(0).layout().kept, ElementsAre(2, 5));
  EXPECT_THAT(search->MinimiserOf(1).layout().kept, ElementsAre(0));
  EXPECT_EQ(search->RunsOf(0) + search->RunsOf(1), asked.size());
  EXPECT_EQ(search->MinimiserOf(0).verification().tally.failures, 30);
  EXPECT_EQ(search->MinimiserOf(0).layout().obstacles[1], setup.cases[0].obstacles[5]);
}

// Robots stay at the right end, where obstacle 7 alone stands: it is not the first that is taken away.
TEST(MinimisationSearchTest, CountsWhereRobotsWere) {
  const auto search = MakeMinimisation(SetupToShorten(1));
  std::vector<EvaluationRequest> asked;
  while (!search->Progress().finished) {
    for (const EvaluationRequest& request : search->Ask()) {
      asked.push_back(request);
      EvaluationOutcome outcome = Answer(request);
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

TEST(MinimisationSearchTest, AsksTheSameHoweverManyOutcomesComeBetweenTwoAsks) {
  const auto one = MakeMinimisation(SetupToShorten(2));
  const auto many = MakeMinimisation(SetupToShorten(2));
  EXPECT_TRUE(SameRequests(Drive(*one, 1), Drive(*many, 9)));
}

TEST(MinimisationSearchTest, NoTwoRunsHaveTheSameSeed) {
  const SearchSetup setup = SetupToShorten(1);
  std::set<std::uint64_t> seeds;
  for (const EvaluationRequest& request : Drive(*MakeMinimisation(setup), 3)) {
    const std::uint64_t seed = RunSeed(setup.experiment, request, 0);
    EXPECT_TRUE(seeds.insert(seed).second);
  }
}

TEST(MinimisationSearchTest, LayoutsAreChildrenOfTheirCase) {
  const auto search = MakeMinimisation(SetupToShorten(2));
  Drive(*search, 4);
  const std::vector<Individual> born = search->TakeNewborns();
  ASSERT_GT(born.size(), 2U);
  EXPECT_TRUE(born[0].parents.empty());
  for (std::size_t i = 2; i < born.size(); ++i) {
    EXPECT_EQ(born[i].id, i + 1);
    const double side = born[i].test_case.side_x;
    EXPECT_THAT(born[i].parents, ElementsAre(side > 6.5 ? 2 : 1));
  }
}

TEST(MinimisationSearchTest, KnowsItsResultsAgainWhenItsStateIsRestored) {
  const SearchSetup setup = SetupToShorten(2);
  const auto search = MakeMinimisation(setup);
  std::vector<EvaluationOutcome> told;
  for (const EvaluationRequest& request : Drive(*search, 3)) told.push_back(Answer(request));
  ASSERT_TRUE(search->AtBoundary());
  const auto again = MakeMinimisation(setup);
  ASSERT_TRUE(RestoreState(*again, StateOf(*search), told));
  EXPECT_TRUE(again->Progress().finished);
  EXPECT_EQ(again->MinimiserOf(0).layout(), search->MinimiserOf(0).layout());
  told.pop_back();
  const auto cut_off = MakeMinimisation(setup);
  EXPECT_FALSE(RestoreState(*cut_off, StateOf(*search), told));
}

}  // namespace
}  // namespace gauntlet
