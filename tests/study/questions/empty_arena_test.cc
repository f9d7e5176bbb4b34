#include "study/questions/empty_arena.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <set>

#include "search/experiment/experiment_file.h"
#include "search/search_table.h"

namespace gauntlet {
namespace {

using ::testing::HasSubstr;

// Runs of the empty arena, of which the first `failures` fail.
struct Simulator {
  int failures = 0;
  std::set<std::uint64_t> seeds = {};
  std::size_t obstacles = 0;

  Status Check(const std::string& name) {
    const Experiment experiment = LoadExperiment(name, {}, BuiltInCatalogue()).value();
    return CheckEmptyArena(experiment, FirstRuns(experiment, /*all=*/false));
  }
  FailureTally FirstRuns(const Experiment& experiment, bool all) {
    return FirstEmptyRuns(experiment, all,
                          [this](const sim::RunSpec& spec) -> Result<sim::RunResult> {
                            const bool fails = std::ssize(seeds) < failures;
                            seeds.insert(spec.seed);
                            obstacles += spec.test_case.obstacles.size();
                            sim::RunResult result;
                            result.failure.total = fails;
                            result.metrics = {{"condition_2", fails ? 1.0 : 0.0}};
                            return result;
                          })
        .value();
  }
};

TEST(EmptyArenaTest, AControllerThatAlwaysFailsIsRefused) {
  for (const char* experiment : {"flocking", "foraging"}) {
    Simulator simulator{.failures = 5};
    const Status status = simulator.Check(experiment);
    ASSERT_FALSE(status.ok()) << experiment;
    EXPECT_THAT(status.error().message, HasSubstr("fails without any obstacle, in 5 of 5 runs"));
    EXPECT_EQ(simulator.seeds.size(), 5U) << "a seed of its own for each run";
    EXPECT_EQ(simulator.obstacles, 0U);
  }
}

TEST(EmptyArenaTest, OneThatCameThroughOnceIsNot) {
  Simulator simulator{.failures = 4};
  EXPECT_TRUE(simulator.Check("flocking").ok());
  Simulator sound{.failures = 0};
  EXPECT_TRUE(sound.Check("flocking").ok());
  EXPECT_EQ(sound.seeds.size(), 1U) << "the first run says it";
}

TEST(EmptyArenaTest, ADryRunLooksAtAllOfThem) {
  Simulator simulator{.failures = 2};
  const FailureTally tally =
      simulator.FirstRuns(LoadExperiment("flocking", {}, BuiltInCatalogue()).value(), /*all=*/true);
  EXPECT_EQ(tally.failures, 2);
  EXPECT_EQ(tally.runs(), 5);
}

}  // namespace
}  // namespace gauntlet
