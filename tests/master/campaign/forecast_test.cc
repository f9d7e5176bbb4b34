#include "master/campaign/forecast.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <set>
#include <string>

#include "search/experiment/experiment_file.h"
#include "search/search_table.h"

namespace gauntlet {
namespace {

Experiment Flocking(const std::vector<std::string>& sets) {
  return LoadExperiment("flocking", sets, BuiltInCatalogue()).value();
}

// Answers every run at once, and notes which were asked.
struct TimedSimulator {
  double seconds = 0.25;
  std::vector<sim::RunSpec> asked;

  Result<Forecast> Of(const std::vector<SearchPlan>& plans) {
    return MakeForecast(plans, [this](const sim::RunSpec& spec) -> Result<sim::RunResult> {
      asked.push_back(spec);
      sim::RunResult result;
      result.cpu_seconds = seconds;
      return result;
    });
  }
};

TEST(Forecast, CountsTheRunsAndCasesOfAnEvolution) {
  TimedSimulator simulator;
  const auto forecast = simulator.Of({{"", Flocking({"search.generations=5", "search.replicates=2"})}});
  ASSERT_TRUE(forecast.ok()) << forecast.error().message;
  EXPECT_EQ(forecast->runs, 20U * 5 * 2);
  EXPECT_EQ(forecast->cases, 20U + 4 * 2);
  EXPECT_FALSE(forecast->cases_exact);
  EXPECT_EQ(forecast->measured_runs, 12U);
  EXPECT_DOUBLE_EQ(forecast->seconds_per_run, 0.25);
  EXPECT_DOUBLE_EQ(forecast->Seconds(2), 200 * 0.25 / 2);
  EXPECT_GT(forecast->bytes, 100'000.0);
}

TEST(Forecast, RandomCasesAreExactWhenEverySearchHasASeedOfItsOwn) {
  const auto plan = [](const std::string& seed) {
    return SearchPlan{"", Flocking({"search.algorithm=random", "search.cases=30", "seed=" + seed})};
  };
  TimedSimulator simulator;
  const auto different = simulator.Of({plan("1"), plan("2"), plan("3")});
  ASSERT_TRUE(different.ok());
  EXPECT_EQ(different->cases, 90U);
  EXPECT_TRUE(different->cases_exact);
  EXPECT_FALSE(simulator.Of({plan("1"), plan("1")})->cases_exact);
}

TEST(Forecast, MeasuresRunsOfSearchesThatAreSpreadOverThemAll) {
  std::vector<SearchPlan> plans;
  for (int birds = 3; birds < 23; ++birds) {
    plans.push_back({"", Flocking({"scenario_parameters.birds=" + std::to_string(birds),
                                   "scenario_parameters.min_swarm=2"})});
  }
  TimedSimulator simulator;
  EXPECT_EQ(simulator.Of(plans)->measured_runs, 12U);
  std::set<double> birds;
  for (const sim::RunSpec& spec : simulator.asked) birds.insert(spec.scenario_parameters.at("birds"));
  EXPECT_EQ(birds.size(), 12U);
  EXPECT_EQ(*birds.begin(), 3.0);
  EXPECT_GT(*birds.rbegin(), 18.0);
}

TEST(Forecast, TellsOfRunsWithoutAResult) {
  std::uint64_t run = 0;
  const auto forecast =
      MakeForecast({{"", Flocking({})}}, [&](const sim::RunSpec&) -> Result<sim::RunResult> {
        sim::RunResult result;
        if (++run % 3 != 0) return result;
        result.verdict = sim::Verdict::kInvalidCommand;
        result.message = "invalid-outcome: it divides 1 by 0";
        return result;
      });
  ASSERT_TRUE(forecast.ok());
  EXPECT_EQ(forecast->measured_without_result, 4U);
  EXPECT_EQ(forecast->why_without_result, "invalid-outcome: it divides 1 by 0");
}

TEST(Forecast, StopsMeasuringLongRuns) {
  TimedSimulator simulator;
  simulator.seconds = 60.0;
  EXPECT_EQ(simulator.Of({{"", Flocking({})}})->measured_runs, 2U);
}

TEST(Forecast, OneGivenCaseIsMeasuredOnceForEachReplicate) {
  const Experiment experiment = Flocking({"search.algorithm=cases", "search.replicates=3"});
  TimedSimulator simulator;
  const auto forecast = simulator.Of({{"", experiment, {EmptyArena(experiment.arena)}}});
  ASSERT_TRUE(forecast.ok()) << forecast.error().message;
  EXPECT_EQ(forecast->runs, 3U);
  EXPECT_EQ(forecast->cases, 1U);
  EXPECT_TRUE(forecast->cases_exact);
  EXPECT_EQ(forecast->measured_runs, 3U);
}

TEST(Forecast, ASearchThatCannotBeginIsAnError) {
  TimedSimulator simulator;
  EXPECT_FALSE(simulator.Of({{"", Flocking({"search.algorithm=cases"})}}).ok());
  EXPECT_TRUE(simulator.asked.empty());
}

}  // namespace
}  // namespace gauntlet
