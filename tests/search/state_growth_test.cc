// What is saved depends on the population, not on how long the search has been going on.
#include <gtest/gtest.h>

#include "search/search_table.h"
#include "tests/search/state_growth.h"

namespace gauntlet {
namespace {

StateGrowth GrowthOver(const char* algorithm, int runs) {
  SearchSetup setup = ToySetup();
  SearchSpec& spec = setup.experiment.search;
  SetAlgorithm(setup, algorithm);
  spec.population = 8;
  spec.generations = runs / spec.population;
  spec.parameters["cases"] = runs;
  const auto search = RowOf(setup.experiment).make(setup);
  return GrowthOf(**search);
}

class StateGrowthTest : public testing::TestWithParam<const char*> {};

TEST_P(StateGrowthTest, StatesOfManyRunsTakeNoMoreBytesPerRunThanOfFew) {
  const StateGrowth few = GrowthOver(GetParam(), 1'000);
  const StateGrowth many = GrowthOver(GetParam(), 8'000);
  EXPECT_EQ(few.runs, 1'000U);
  EXPECT_EQ(many.runs, 8'000U);
  EXPECT_EQ(many.states, 8 * few.states);
  EXPECT_NEAR(many.bytes_per_run() / few.bytes_per_run(), 1.0, 0.01);
}

INSTANTIATE_TEST_SUITE_P(Searches, StateGrowthTest, testing::Values("genetic", "steady-state", "random"),
                         [](const auto& instance) {
                           const std::string name = instance.param;
                           return name.substr(0, name.find('-'));
                         });

}  // namespace
}  // namespace gauntlet
