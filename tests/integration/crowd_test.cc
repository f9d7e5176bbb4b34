// Many workers, and many runs: all are served, and the master's memory does not grow with what it has done.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <fstream>

#include "tests/integration/service_driver.h"
#include "tests/integration/worker_crowd.h"
#include "tests/perf/noop_runs.h"
#include "tests/support/paths.h"

namespace gauntlet::testing_support {
namespace {

constexpr const char* kNoopWorker = GAUNTLET_BINARY_DIR "/gauntlet-worker-noop";

// `gauntlet master flocking` for workers whose runs do nothing.
std::unique_ptr<Process> StartNoopMaster(const std::string& dir, const std::string& endpoint, int population,
                                         int replicates, int generations) {
  return std::make_unique<Process>(
      std::vector<std::string>{GAUNTLET_BINARY_DIR "/gauntlet", "master", "flocking", "--bind", endpoint,
                               "--dir", dir, "--quiet", "--population", std::to_string(population),
                               "--generations", std::to_string(generations), "--set",
                               "search.replicates=" + std::to_string(replicates)},
      std::vector<std::string>{std::string("GAUNTLET_WORKER=") + kNoopWorker});
}

TEST(CrowdTest, FiveHundredEncryptedWorkersAreAllLeasedWhenAGenerationIsQueued) {
  // The crowd shakes hands 512 times in this process; with a sanitizer it would be silent for too long.
  constexpr int kCrowd = kSanitized ? 32 : 512;
  const TemporaryDirectory scratch;
  const auto master = StartNoopMaster(scratch / "c", "tcp://0.0.0.0:*", 2 * kCrowd, 1, 2);
  ASSERT_TRUE(Serves(scratch / "c"));
  WorkerCrowd crowd(scratch / "c", kCrowd, perf::kNoopGoldenHashes);
  ASSERT_TRUE(crowd.Join(kPatience)) << master->Err();
  const sim::RunResult result = perf::NoopResult(1);
  ASSERT_GE(crowd.AwaitLeases(2 * kCrowd, kPatience), 0.0) << "each has two";
  EXPECT_EQ(crowd.AnswerAll(result, 1.0), 2U * kCrowd);
  EXPECT_GE(crowd.AwaitLeases(kCrowd, kPatience), 0.0) << "each has one of the next generation";
}

// As many as the largest clusters have: takes both cores for a minute, a long drill.
TEST(CrowdDrill, FourThousandConnectedWorkersAreAllLeasedAndNoneIsLost) {
  constexpr int kCrowd = 4096;
  const TemporaryDirectory scratch;
  const auto master = StartNoopMaster(scratch / "c", "tcp://0.0.0.0:*", 2 * kCrowd, 1, 2);
  ASSERT_TRUE(Serves(scratch / "c"));
  WorkerCrowd crowd(scratch / "c", kCrowd, perf::kNoopGoldenHashes);
  ASSERT_TRUE(crowd.Join(kPatience)) << master->Err();
  ASSERT_GE(crowd.AwaitLeases(2 * kCrowd, kPatience), 0.0) << "each has two";
  // So long that every worker had to be heard, more than once.
  (void)crowd.AwaitLeases(3 * kCrowd, std::chrono::seconds(20));
  ASSERT_EQ(crowd.AnswerAll(perf::NoopResult(1), 1.0), 2U * kCrowd);
  const double seconds = crowd.AwaitLeases(kCrowd, kPatience);
  fmt::print("leased {:.2f} s after the last answer\n", seconds);
  EXPECT_GE(seconds, 0.0) << "each has one of the next generation";
  EXPECT_LT(seconds, 2.0);
  std::ifstream file(scratch / "c/status.json");
  const auto status = nlohmann::json::parse(file, nullptr, false);
  EXPECT_EQ(status.value("workers", 0), kCrowd);
  EXPECT_EQ(status.value("workers_lost", -1), 0);
}

TEST(CrowdTest, MasterDoesNotGrowWithTheRunsItHasStored) {
  if (kSanitized) GTEST_SKIP() << "sanitizers keep what is freed for a while";
  const TemporaryDirectory scratch;
  const auto master = StartNoopMaster(scratch / "c", "tcp://127.0.0.1:*", 200, 10, 30);
  ASSERT_TRUE(Serves(scratch / "c"));
  const Process worker({kNoopWorker, "--dir", scratch / "c", "--quiet"});
  const auto memory_after = [&](int runs) {
    double memory = 0.0;
    EXPECT_TRUE(Eventually(
        [&] {
          std::ifstream file(scratch / "c/status.json");
          const auto status = nlohmann::json::parse(file, nullptr, false);
          if (!status.is_object() || status.value("runs_done", 0) < runs) return !master->Running();
          memory = ResidentMebibytes(master->pid());
          return true;
        },
        kPatience));
    return memory;
  };
  const double early = memory_after(5'000);
  const double late = memory_after(30'000);
  ASSERT_GT(early, 0.0);
  ASSERT_GT(late, 0.0) << "it was done before anybody looked";
  // 25,000 runs have 30 MB of specs and results.
  EXPECT_LT(late - early, 6.0) << early << " MiB, then " << late;
}

}  // namespace
}  // namespace gauntlet::testing_support
