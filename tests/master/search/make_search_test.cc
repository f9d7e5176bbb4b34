#include "master/search/make_search.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/master/search/toy_search.h"

namespace gauntlet::master {
namespace {

using ::testing::HasSubstr;

TEST(MakeSearchTest, MakesTheSearchOfTheExperiment) {
  const SearchSetup setup = ToySetup();
  Experiment experiment = setup.experiment;
  const auto genetic = MakeSearch(experiment, setup.requirements, 1);
  ASSERT_TRUE(genetic.ok());
  EXPECT_EQ((*genetic)->Progress().evaluations_planned, 1000U);
  EXPECT_GE(StatisticOf(**genetic, "clone_rate"), 0.0);

  experiment.search.kind = SearchKind::kRandom;
  experiment.search.cases = 12;
  const auto random = MakeSearch(experiment, setup.requirements, 1);
  ASSERT_TRUE(random.ok());
  EXPECT_EQ((*random)->Progress().evaluations_planned, 12U);
}

TEST(MakeSearchTest, AListOfCasesCannotBeMadeFromAnExperimentAlone) {
  const SearchSetup setup = ToySetup();
  Experiment experiment = setup.experiment;
  experiment.search.kind = SearchKind::kCases;
  const auto search = MakeSearch(experiment, setup.requirements, 1);
  ASSERT_FALSE(search.ok());
  EXPECT_THAT(search.error().message, HasSubstr("gauntlet evaluate"));
}

TEST(MakeSearchTest, UnknownScenarioIsNamed) {
  Experiment experiment = ToySetup().experiment;
  experiment.scenario = "juggling";
  const auto search = MakeSearch(experiment, 1);
  ASSERT_FALSE(search.ok());
  EXPECT_EQ(search.error().kind, ErrorKind::kNotFound);
  EXPECT_THAT(search.error().message, HasSubstr("'juggling'"));
}

}  // namespace
}  // namespace gauntlet::master
