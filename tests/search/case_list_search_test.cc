#include "search/given/case_list_search.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/search/toy_search.h"

namespace gauntlet {
namespace {

std::vector<sim::TestCase> ThreeCases() {
  std::vector<sim::TestCase> cases(3);
  cases[0].name = "empty";
  cases[1].obstacles = {{.x = 1, .y = 0, .length = 1, .width = 0.2, .orientation_deg = 30}};
  cases[2].obstacles = cases[1].obstacles;
  return cases;
}

std::unique_ptr<CaseListSearch> MakeList(std::vector<sim::TestCase> cases, int replicates) {
  SearchSetup setup = ToySetup();
  SetAlgorithm(setup, "cases");
  setup.experiment.search.replicates = replicates;
  setup.cases = std::move(cases);
  return std::move(CaseListSearch::Create(setup)).value();
}

TEST(CaseListSearchTest, AsksEveryCaseOnceWithItsReplicates) {
  const auto list = MakeList(ThreeCases(), 5);
  CaseListSearch& search = *list;
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

TEST(CaseListSearchTest, CountsDistinctGenomes) {
  EXPECT_EQ(CountDistinctGenomes(MakeList(ThreeCases(), 1)->Population()), 2U);
}

TEST(CaseListSearchTest, AnEmptyListIsFinished) {
  const auto list = MakeList({}, 1);
  CaseListSearch& search = *list;
  EXPECT_TRUE(search.Ask().empty());
  EXPECT_TRUE(search.Progress().finished);
  EXPECT_TRUE(search.AtBoundary());
}

}  // namespace
}  // namespace gauntlet
