// `gauntlet-worker --run-spec`: one run without a master, the one command of a reproduction bundle.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <string>

#include "proto/run.pb.h"
#include "tests/support/paths.h"
#include "tests/support/process.h"
#include "tests/worker/fake_master.h"
#include "tests/worker/faulty_runs.h"

namespace gauntlet::worker {
namespace {

using testing::HasSubstr;
using testing_support::ProcessResult;

constexpr const char* kRunSpecWorker = GAUNTLET_BINARY_DIR "/gauntlet-worker-faulty";

class RunSpecTest : public testing::Test {
 protected:
  ProcessResult RunSpec(const std::string& bytes, const std::string& cpu = "1") {
    std::ofstream(directory_ / "spec.bin", std::ios::binary) << bytes;
    return testing_support::RunProcess(
        {kRunSpecWorker, "--run-spec", directory_ / "spec.bin", cpu, std::to_string(512ULL << 20)});
  }

  testing_support::TemporaryDirectory directory_;
};

TEST_F(RunSpecTest, WritesTheResultToStdout) {
  const ProcessResult ended = RunSpec(SpecBytes(kComplete, "", true));
  EXPECT_EQ(ended.exit_code, 0) << ended.err;
  v1::RunResult result;
  ASSERT_TRUE(result.ParseFromString(ended.out));
  EXPECT_EQ(result.fitness(), 0.5);
  EXPECT_EQ(result.trajectory().states_size(), 20'000 * 50 * 4) << "no size limit here";
}

TEST_F(RunSpecTest, BrokenRunIsAResultWithItsVerdictAndItsOutputOnStderr) {
  const ProcessResult ended = RunSpec(SpecBytes(kAbort));
  EXPECT_EQ(ended.exit_code, 0);
  v1::RunResult result;
  ASSERT_TRUE(result.ParseFromString(ended.out));
  EXPECT_EQ(result.verdict(), v1::VERDICT_CRASHED);
  EXPECT_EQ(result.message(), "crashed with signal 6");
  EXPECT_NE(result.hash(), 0u);
  EXPECT_EQ(ended.err, "gauntlet-worker: the run crashed with signal 6\nabout to abort\n");
}

TEST_F(RunSpecTest, EndlessRunHangs) {
  v1::RunResult result;
  ASSERT_TRUE(result.ParseFromString(RunSpec(SpecBytes(kSpin)).out));
  EXPECT_EQ(result.verdict(), v1::VERDICT_HUNG);
}

TEST_F(RunSpecTest, RunThatOnlyWaitsHangsAfterTwentyTimesItsCpuTime) {
  const ProcessResult ended = RunSpec(SpecBytes(kSleep), "0.05");
  EXPECT_EQ(ended.exit_code, 0);
  v1::RunResult result;
  ASSERT_TRUE(result.ParseFromString(ended.out));
  EXPECT_EQ(result.verdict(), v1::VERDICT_HUNG);
  EXPECT_TRUE(ended.err.ends_with("no end after 1 s: it waits\n")) << ended.err;
}

TEST_F(RunSpecTest, MissingFileExitsTwo) {
  const ProcessResult ended =
      testing_support::RunProcess({kRunSpecWorker, "--run-spec", directory_ / "none", "1", "0"});
  EXPECT_EQ(ended.exit_code, 2);
  EXPECT_THAT(ended.err, HasSubstr("none: No such file"));
}

}  // namespace
}  // namespace gauntlet::worker
