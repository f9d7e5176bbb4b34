// Many workers, and many runs: all are served, and the master's memory does not grow with what it has done.
#include <gtest/gtest.h>

#include <fstream>

#include "tests/integration/service_driver.h"
#include "tests/integration/worker_crowd.h"
#include "tests/perf/noop_runs.h"
#include "tests/support/paths.h"

namespace gauntlet::testing_support {
namespace {

constexpr const char* kNoopWorker = GAUNTLET_BINARY_DIR "/gauntlet-worker-noop";

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
