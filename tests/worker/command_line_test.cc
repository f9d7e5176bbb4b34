// gauntlet-worker as it is shipped: its command line and the real simulation behind it.
// Covers: base/version.cc
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

#include "proto/run.pb.h"
#include "tests/support/paths.h"
#include "tests/support/process.h"

namespace gauntlet::worker {
namespace {

using testing::HasSubstr;
using testing::MatchesRegex;
using testing_support::ProcessResult;
using testing_support::RunProcess;

constexpr const char* kWorker = GAUNTLET_BINARY_DIR "/gauntlet-worker";

TEST(CommandLineTest, NamesVersionCommitAndCompilerAndGoldenHashesAreOneForEachController) {
  EXPECT_THAT(RunProcess({kWorker, "--version"}).out,
              MatchesRegex("gauntlet-worker [0-9]+\\.[0-9]+\\.[0-9]+\ncommit [0-9a-z -]+, compiled by .+\n"));
  const ProcessResult golden = RunProcess({kWorker, "--golden"});
  EXPECT_EQ(golden.exit_code, 0);
  EXPECT_THAT(golden.out, MatchesRegex("([a-z-]+ [0-9a-f]{16}\n)+"));
  EXPECT_EQ(RunProcess({kWorker, "--golden"}).out, golden.out);
  const ProcessResult one = RunProcess({kWorker, "--golden", "flocking", "unheard-of"});
  EXPECT_EQ(one.exit_code, 0);
  EXPECT_THAT(one.out, MatchesRegex("flocking [0-9a-f]{16}\n"));
  EXPECT_THAT(golden.out, HasSubstr(one.out));
}

struct BadLine {
  const char* name;
  std::vector<std::string> arguments;
  const char* complaint;
};

void PrintTo(const BadLine& param, std::ostream* out) {
  *out << param.name;
}

class BadLineTest : public testing::TestWithParam<BadLine> {};

TEST_P(BadLineTest, ExitsTwoAndNamesWhatIsWrong) {
  std::vector<std::string> line{kWorker};
  line.insert(line.end(), GetParam().arguments.begin(), GetParam().arguments.end());
  const ProcessResult ended = RunProcess(line);
  EXPECT_EQ(ended.exit_code, 2);
  EXPECT_THAT(ended.err, HasSubstr(GetParam().complaint));
  EXPECT_EQ(ended.out, "");
}

INSTANTIATE_TEST_SUITE_P(
    Worker, BadLineTest,
    testing::Values(BadLine{"Nothing", {}, "--dir DIR or --access FILE"},
                    BadLine{"Unknown", {"--fast"}, "--fast"},
                    BadLine{"NoSlots", {"--dir", "x", "--slots", "0"}, "--slots"},
                    BadLine{"AbsurdSlots", {"--dir", "x", "--slots", "100000"}, "--slots"},
                    BadLine{"BothPlaces", {"--dir", "x", "--access", "y"}, "--access"},
                    BadLine{"NegativeTimeout", {"--dir", "x", "--orphan-timeout", "-1"}, "--orphan-timeout"},
                    BadLine{"TimeoutThatIsNoNumber", {"--dir", "x", "--orphan-timeout", "nan"}, "'nan'"},
                    BadLine{"EmptyDirectory", {"--dir", ""}, "--dir is empty"},
                    BadLine{"LimitThatIsNoNumber", {"--run-spec", "x", "--cpu-limit", "nan"}, "'nan'"},
                    BadLine{"NegativeMemory", {"--run-spec", "x", "--memory-limit", "-1"}, "--memory-limit"},
                    BadLine{"NoParent", {"--dir", "x", "--die-with-parent", "0"}, "1 to 4194304"},
                    BadLine{"LimitWithoutSpec", {"--dir", "x", "--cpu-limit", "3"}, "--run-spec"},
                    BadLine{"LogNowhere", {"--dir", "x", "--log", "/proc/none/x"}, "/proc/none/x"}),
    [](const auto& test) { return test.param.name; });

TEST(CommandLineTest, UnknownScenarioIsRefusedByNameInTheResult) {
  const testing_support::TemporaryDirectory directory;
  v1::RunSpec spec;
  spec.set_scenario("floking");
  std::ofstream(directory / "spec", std::ios::binary) << spec.SerializeAsString();
  const ProcessResult ended = RunProcess({kWorker, "--run-spec", directory / "spec"});
  EXPECT_EQ(ended.exit_code, 0) << ended.err;
  v1::RunResult result;
  ASSERT_TRUE(result.ParseFromString(ended.out));
  EXPECT_EQ(result.verdict(), v1::VERDICT_REFUSED);
  EXPECT_EQ(result.message(), "unknown scenario 'floking'; did you mean 'flocking'?");
  EXPECT_EQ(ended.err,
            "gauntlet-worker: the run was refused: unknown scenario 'floking'; did you mean 'flocking'?\n");
}

TEST(CommandLineTest, AnOutcomeThatCannotBeWrittenIsAnError) {
  const std::string worker(kWorker);
  for (const char* arguments : {" --golden >&-", " --golden >/dev/full", " --run-spec /dev/null >&-",
                                " --run-spec /dev/null >/dev/full"}) {
    const ProcessResult ended = RunProcess({"/bin/sh", "-c", worker + arguments});
    EXPECT_EQ(ended.exit_code, 4) << arguments;
    EXPECT_THAT(ended.err, HasSubstr("cannot be written to stdout")) << arguments;
  }
}

}  // namespace
}  // namespace gauntlet::worker
