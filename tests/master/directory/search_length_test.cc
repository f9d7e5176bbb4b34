#include "master/directory/search_length.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "search/experiment/experiment_file.h"
#include "search/search_table.h"

namespace gauntlet {
namespace {

using testing::HasSubstr;
using testing::StartsWith;

SearchPlan PlanOf(const std::string& settings, const std::vector<std::string>& sets) {
  return {settings, LoadExperiment("flocking", sets, BuiltInCatalogue()).value()};
}

// What WithLength answers, in words.
std::string Refusal(const std::vector<SearchPlan>& plans, const std::vector<std::string>& sets) {
  const Result<std::vector<SearchPlan>> longer = WithLength(plans, sets);
  return longer ? "" : longer.error().message;
}

TEST(SearchLengthTest, NothingElseOfAnExperimentChanges) {
  const std::vector<std::string> sets = {"seed=18446744073709551615", "search.population=6",
                                         "noise.wheels.gaussian=0.01", "search.generations=5"};
  const std::vector<SearchPlan> plans = {PlanOf("", sets)};
  std::vector<std::string> longer_from_the_start = sets;
  longer_from_the_start.back() = "search.generations=9";
  const Result<std::vector<SearchPlan>> longer = WithLength(plans, {"search.generations=9"});
  ASSERT_TRUE(longer.ok()) << longer.error().message;
  EXPECT_EQ(WriteSearchPlans(*longer), WriteSearchPlans({PlanOf("", longer_from_the_start)}));
  EXPECT_EQ(DescribeLengths(plans, *longer), "search.generations from 5 to 9");
  EXPECT_EQ(DescribeLengths(*longer, *WithLength(*longer, {"search.generations=9"})), "");
}

TEST(SearchLengthTest, EverySearchOfASweepTakesTheKeyThatItGoesBy) {
  const std::vector<SearchPlan> plans = {
      PlanOf("search.algorithm=genetic", {"search.generations=5"}),
      PlanOf("search.algorithm=steady-state", {"search.algorithm=steady-state", "search.generations=5"}),
      PlanOf("search.algorithm=random", {"search.algorithm=random", "search.cases=7"})};
  const Result<std::vector<SearchPlan>> generations = WithLength(plans, {"search.generations=9"});
  ASSERT_TRUE(generations.ok());
  EXPECT_EQ(DescribeLengths(plans, *generations), "search.generations from 5 to 9");
  EXPECT_EQ((*generations)[1].experiment.search.generations, 9);
  EXPECT_EQ(WriteSearchPlans({(*generations)[2]}), WriteSearchPlans({plans[2]}));
  const Result<std::vector<SearchPlan>> both = WithLength(plans, {"search.generations=9", "search.cases=8"});
  ASSERT_TRUE(both.ok());
  EXPECT_EQ(DescribeLengths(plans, *both), "search.cases from 7 to 8, search.generations from 5 to 9");
}

TEST(SearchLengthTest, SearchesAreTheSameWhateverStandsInKeysThatTheyDoNotRead) {
  const std::vector<SearchPlan> plans = {PlanOf("one", {})};
  const auto same = [&](const std::string& settings, const std::vector<std::string>& sets) {
    return AreSameSearches(plans, {PlanOf(settings, sets)});
  };
  EXPECT_TRUE(same("one", {}));
  EXPECT_TRUE(same("one", {"search.cases=7", "search.slots=5"}));
  EXPECT_FALSE(same("two", {}));
  EXPECT_FALSE(same("one", {"search.population=8"}));
  EXPECT_FALSE(same("one", {"search.generations=9"}));
  EXPECT_FALSE(same("one", {"scenario_parameters.time_limit=70"}));
  EXPECT_FALSE(AreSameSearches(plans, {plans.front(), plans.front()}));
}

TEST(SearchLengthTest, WhatWouldMakeAnotherSearchIsRefused) {
  const std::vector<SearchPlan> genetic = {PlanOf("", {"search.generations=5"})};
  EXPECT_THAT(Refusal(genetic, {"search.generations=4"}),
              StartsWith("--set search.generations=4: the campaign has search.generations = 5"));
  EXPECT_THAT(Refusal(genetic, {"search.generations=9", "search.replicates=2"}),
              StartsWith("--set search.replicates=2: of a campaign that exists only its length may change, "
                         "search.generations"));
  EXPECT_THAT(Refusal(genetic, {"search.generations=x"}), StartsWith("--set search.generations=x: "));
  for (const Key& key : BuiltInKeys()) {
    if (key.path == "search.generations") continue;
    EXPECT_THAT(Refusal(genetic, {key.path + "=1"}), HasSubstr("would no longer be the same search"))
        << key.path;
  }
  const std::vector<SearchPlan> cases = {PlanOf("", {"search.algorithm=cases"})};
  EXPECT_EQ(Refusal(cases, {"search.generations=9"}),
            "--set search.generations=9: this campaign ends with the last of its given cases, and nothing "
            "makes it longer: begin a new one");
  const std::vector<SearchPlan> sweep = {PlanOf("search.generations=5, seed 1", {"search.generations=5"}),
                                         PlanOf("search.generations=6, seed 1", {"search.generations=6"})};
  EXPECT_EQ(Refusal(sweep, {"search.generations=9"}),
            "--set search.generations=9: the searches of this campaign are told apart by search.generations "
            "(search.generations=5, seed 1), so none can be made longer: begin a new campaign");
}

}  // namespace
}  // namespace gauntlet
