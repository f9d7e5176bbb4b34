// Requirements of real runs: what they add to the result, and what they leave as it is.
#include "controllers/requirements/run_judge.h"

#include <gmock/gmock.h>

#include "controllers/registry.h"
#include "tests/controllers/run_support.h"
#include "worker/run_executor.h"

namespace gauntlet::controllers {
namespace {

using testing_support::Metric;
using testing_support::SpecOf;

sim::RunSpec Flocking(const std::string& requirements) {
  sim::RunSpec spec = SpecOf("flocking", "flocking", 7);
  spec.requirements = requirements;
  return spec;
}

TEST(RunJudgeTest, AddsMetricsAndChangesNothingElse) {
  const sim::RunResult plain = worker::Run(Flocking(""));
  const sim::RunResult judged = worker::Run(Flocking("there = eventually distance_to(goal) < 1\n"));
  ASSERT_EQ(judged.verdict, sim::Verdict::kCompleted) << judged.message;
  EXPECT_EQ(judged.trajectory_hash, plain.trajectory_hash);
  EXPECT_EQ(judged.fitness, plain.fitness);
  ASSERT_EQ(judged.metrics.size(), plain.metrics.size() + 3);
  EXPECT_TRUE(std::ranges::equal(plain.metrics, std::span(judged.metrics).first(plain.metrics.size())));
  EXPECT_NE(judged.hash, plain.hash) << "a result's hash covers its metrics";
  EXPECT_EQ(judged.hash, sim::HashOf(judged));
}

TEST(RunJudgeTest, SaysWhetherTheRunFailed) {
  const sim::RunResult failed = worker::Run(Flocking("never = always distance_to(start) < 0.5\n"));
  EXPECT_TRUE(failed.failure.total);
  EXPECT_LT(Metric(failed, "robustness"), 0.0);
  EXPECT_GT(Metric(failed, "violated_at.never"), 0.0);
  EXPECT_FALSE(worker::Run(Flocking("ever = distance_to(start) < 0.5\n")).failure.total);
}

// The prey of a flock is not under test: it leads the way to the goal, and the birds are ten.
TEST(RunJudgeTest, CountsTheRobotsUnderTest) {
  const sim::RunResult result = worker::Run(Flocking("ten = robots == 10\n"));
  EXPECT_FALSE(result.failure.total);
}

TEST(RunJudgeTest, JudgesEveryScenario) {
  for (const ScenarioInfo& scenario : Scenarios()) {
    sim::RunSpec spec = SpecOf(scenario.name, scenario.default_controller, 3);
    if (scenario.check_definition) spec.definition = "fitness = 1\nfailure = 0\n";
    spec.scenario_parameters[scenario.time_limit] = 20;
    spec.requirements = "late = eventually time >= 20\nall = count(distance_to(goal) < 100) == robots\n";
    const sim::RunResult result = worker::Run(spec);
    ASSERT_EQ(result.verdict, sim::Verdict::kCompleted) << scenario.name << ": " << result.message;
    EXPECT_FALSE(result.failure.total) << scenario.name;
    EXPECT_EQ(Metric(result, "robustness.all"), 0.0) << scenario.name;
  }
}

TEST(RunJudgeTest, IsRefusedWhereTheRequirementsCannotBeRead) {
  const sim::RunResult result = worker::Run(Flocking("a = tim > 1\n"));
  EXPECT_EQ(result.verdict, sim::Verdict::kRefused);
  EXPECT_THAT(result.message, testing::HasSubstr("requirements.a = \"tim > 1\""));
}

TEST(RunJudgeTest, TheRowHasItsMetricsAndFailsAsTheySay) {
  sim::RunSettings settings = SpecOf("foraging", "foraging", 1);
  const ScenarioInfo& plain = *FindScenario(settings);
  EXPECT_NE(plain.failing, kTotalFailure);
  settings.requirements = "late = eventually time >= 20\n";
  const ScenarioInfo& row = *FindScenario(settings);
  EXPECT_EQ(row.failing, kTotalFailure);
  EXPECT_EQ(row.metrics.size(), plain.metrics.size() + 3);
  EXPECT_EQ(row.metrics.back().name, "violated_at.late");
  EXPECT_EQ(FindScenario(settings), &row) << "made once";
}

}  // namespace
}  // namespace gauntlet::controllers
