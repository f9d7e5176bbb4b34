// Covers: controllers/coverage/coverage_registry.cc
#include "controllers/coverage/coverage_scenario.h"

#include <gtest/gtest.h>

#include "tests/controllers/run_support.h"
#include "worker/run_executor.h"

namespace gauntlet::controllers::coverage {
namespace {

using testing_support::Metric;
using testing_support::SpecOf;

TEST(CoverageScenario, TheEmptyArenaIsCovered) {
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    const sim::RunResult field = worker::Run(SpecOf("coverage", "coverage-field", seed));
    const sim::RunResult walk = worker::Run(SpecOf("coverage", "coverage-field-walk", seed));
    ASSERT_EQ(field.verdict, sim::Verdict::kCompleted) << field.message;
    EXPECT_GE(field.fitness, 0.63) << "seed " << seed;
    EXPECT_GE(walk.fitness, 0.75) << "seed " << seed;
    EXPECT_EQ(Metric(field, "connected_share"), 1.0);
    EXPECT_GT(Metric(walk, "explored"), Metric(field, "explored") + 0.3);
    EXPECT_EQ(field.annotations.size(), 2U);
  }
}

TEST(CoverageScenario, WallsAroundTheStartBreakIt) {
  sim::RunSpec spec = SpecOf("coverage", "coverage-field", 1);
  spec.test_case.obstacles = {{2.7, 0.2, 1.9, 0.2, 176.0},
                              {2.0, 2.5, 1.6, 0.2, 241.0},
                              {1.1, 1.7, 1.3, 0.2, 286.0},
                              {1.3, 0.7, 1.4, 0.2, 307.0}};
  const sim::RunResult result = worker::Run(spec);
  ASSERT_EQ(result.verdict, sim::Verdict::kCompleted) << result.message;
  ASSERT_TRUE(result.failure.total) << result.fitness;
  EXPECT_EQ(result.failure.label, CoverageFailureTypes().Find(result.failure.type)->name);
  EXPECT_TRUE(result.failure.label.find("above 8 m^2") != std::string::npos) << result.failure.label;
}

TEST(CoverageScenario, SameSpecSameRun) {
  for (const char* controller : {"coverage-field", "coverage-field-walk"}) {
    const sim::RunSpec spec = SpecOf("coverage", controller, 7);
    EXPECT_EQ(worker::Run(spec).hash, worker::Run(spec).hash);
    EXPECT_NE(worker::Run(spec).hash, worker::Run(SpecOf("coverage", controller, 8)).hash);
  }
}

TEST(CoverageScenario, AnArenaThatObstaclesCloseIsRefused) {
  sim::RunSpec spec = SpecOf("coverage", "coverage-field", 1);
  // Closes the lower right quarter.
  spec.test_case.obstacles = {{0.0, -1.5, 3.0, 0.1, 90.0}, {1.5, 0.0, 3.2, 0.1, 0.0}};
  const sim::RunResult result = worker::Run(spec);
  EXPECT_EQ(result.verdict, sim::Verdict::kRefused);
  EXPECT_TRUE(result.message.find("open-area") != std::string::npos) << result.message;
}

TEST(CoverageFailureTypes, AreNumberedByPlaceSizeAndJam) {
  EXPECT_EQ(CoverageFailureTypes().types.size(), 54U);
  EXPECT_EQ(FailureTypeOf(0, 3.9, false), 0);
  EXPECT_EQ(FailureTypeOf(8, 8.1, true), 53);
  EXPECT_EQ(CoverageFailureTypes().Find(FailureTypeOf(4, 4.0, true))->name, "hole middle, 4 to 8 m^2, a jam");
}

}  // namespace
}  // namespace gauntlet::controllers::coverage
