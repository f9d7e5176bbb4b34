// What a plug-in does in a run costs that run, and is told.
// Covers: worker/runner/scratch_folder.cc, worker/runner/separate_process.cc, worker/runner/shifted_clock.cc
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "proto/run_codec.h"
#include "tests/plugin/plugin_files.h"

namespace gauntlet::testing_support {
namespace {

using testing::HasSubstr;

struct Ended {
  sim::RunResult result;
  ProcessResult process;
};

class PluginRun : public testing::Test {
 protected:
  // A short run of a controller of the plug-in.
  sim::RunSpec SpecOf(const std::string& plugin, const std::string& controller,
                      const std::string& scenario = "light-flocking") const {
    sim::RunSpec spec;
    spec.scenario = scenario;
    spec.scenario_parameters = {{"time_limit", 3.0}};
    spec.controller = controller;
    spec.seed = 11;
    if (!plugin.empty()) spec.plugin = Sha256(ReadFile(PluginPath(plugin)));
    return spec;
  }

  Ended Run(const sim::RunSpec& spec, const std::string& library, std::vector<std::string> more = {}) const {
    std::ofstream(directory_ / "spec", std::ios::binary) << proto::EncodeRunSpec(spec);
    std::vector<std::string> command = {WorkerPath(),  "--run-spec", directory_ / "spec",
                                        "--cpu-limit", "2",          "--memory-limit",
                                        "300000000",   "--plugin",   library};
    command.insert(command.end(), more.begin(), more.end());
    Ended ended;
    ended.process = RunProcess(command);
    const Result<sim::RunResult> result = proto::DecodeRunResult(ended.process.out);
    if (result) ended.result = *result;
    return ended;
  }

  TemporaryDirectory directory_;
};

TEST_F(PluginRun, IsNamedByItsSpec) {
  sim::RunSpec spec = SpecOf("of_twins", "twin");
  const Result<sim::RunSpec> read = proto::DecodeRunSpec(proto::EncodeRunSpec(spec));
  ASSERT_TRUE(read.ok());
  EXPECT_EQ(read->plugin, spec.plugin);
  spec.plugin = "../libtwin.so";
  EXPECT_FALSE(proto::DecodeRunSpec(proto::EncodeRunSpec(spec)).ok());
}

TEST_F(PluginRun, IsTheRunOfTheBuiltInControllerBitForBit) {
  sim::RunSpec built_in = SpecOf("", "light-flocking");
  std::ofstream(directory_ / "built_in", std::ios::binary) << proto::EncodeRunSpec(built_in);
  const Result<sim::RunResult> expected =
      proto::DecodeRunResult(RunProcess({WorkerPath(), "--run-spec", directory_ / "built_in"}).out);
  ASSERT_TRUE(expected.ok());
  const Ended ended = Run(SpecOf("of_twins", "twin"), PluginPath("of_twins"));
  EXPECT_EQ(ended.result.verdict, sim::Verdict::kCompleted) << ended.process.err;
  EXPECT_EQ(ended.result.hash, expected->hash);
  EXPECT_EQ(ended.result.trajectory_hash, expected->trajectory_hash);
}

struct Fault {
  std::string controller;
  sim::Verdict verdict;
  std::string message;
  std::string said;  // on stderr
};
void PrintTo(const Fault& fault, std::ostream* os) {
  *os << fault.controller;
}

class FaultyPluginRun : public PluginRun, public testing::WithParamInterface<Fault> {};

TEST_P(FaultyPluginRun, CostsTheRun) {
  if (kSanitized) GTEST_SKIP() << "sanitizers end such processes in their own way, and know no memory limit";
  const Ended ended = Run(SpecOf("of_faults", GetParam().controller), PluginPath("of_faults"));
  EXPECT_EQ(ended.process.exit_code, 0) << ended.process.err;
  EXPECT_EQ(ended.result.verdict, GetParam().verdict);
  EXPECT_EQ(ended.result.message, GetParam().message);
  EXPECT_THAT(ended.process.err, HasSubstr(GetParam().said));
}

INSTANTIATE_TEST_SUITE_P(
    Faults, FaultyPluginRun,
    testing::Values(
        Fault{"crash", sim::Verdict::kCrashed, "crashed with signal 11", ""},
        Fault{"exit", sim::Verdict::kCrashed, "crashed with exit code 89", "exit(0) was called before"},
        Fault{"exit-three", sim::Verdict::kCrashed, "crashed with exit code 3", ""},
        Fault{"terminate", sim::Verdict::kCrashed, "crashed with exit code 143",
              "the plug-in ended its process by signal 15"},
        Fault{"close-all", sim::Verdict::kCrashed, "crashed with exit code 85",
              "closed files that are not its own"},
        Fault{"limit-files", sim::Verdict::kCompleted, "", ""},
        Fault{"spin", sim::Verdict::kHung, "exceeded its CPU time", ""},
        Fault{"allocate", sim::Verdict::kOutOfMemory, "exceeded its memory", "out of memory"},
        Fault{"throw", sim::Verdict::kCrashed, "crashed with exit code 87",
              "uncaught exception: tired of walking"},
        Fault{"throw-in-thread", sim::Verdict::kCrashed, "crashed with signal 6", "lost in a thread"},
        Fault{"throw-in-factory", sim::Verdict::kCrashed, "crashed with exit code 87", "no factory today"},
        Fault{"throw-in-constructor", sim::Verdict::kCrashed, "crashed with exit code 87", "no robot today"}),
    [](const testing::TestParamInfo<Fault>& parameter) {
      std::string name = parameter.param.controller;
      std::ranges::replace(name, '-', '_');
      return name;
    });

TEST_F(PluginRun, WritesIntoAFolderOfTheRunThatIsRemoved) {
  const std::string before = std::filesystem::current_path();
  const Ended ended = Run(SpecOf("of_faults", "chatty"), PluginPath("of_faults"));
  EXPECT_EQ(ended.result.verdict, sim::Verdict::kCompleted) << ended.process.err;
  EXPECT_FALSE(std::filesystem::exists(before + "/notes.txt"));
  EXPECT_EQ(ended.process.err.find("on stdout"), std::string::npos);
}

TEST_F(PluginRun, KeepsTheFolderOnRequest) {
  const std::string scratch = directory_ / "scratch";
  const Ended ended = Run(SpecOf("of_faults", "chatty"), PluginPath("of_faults"),
                          {"--scratch", std::filesystem::relative(scratch)});
  EXPECT_EQ(ended.result.verdict, sim::Verdict::kCompleted) << ended.process.err;
  EXPECT_EQ(ReadFile(scratch + "/notes.txt"), "in a file\n");
  EXPECT_THAT(ReadFile(scratch + "/output.txt"), HasSubstr("on stdout\n"));
  EXPECT_THAT(ReadFile(scratch + "/output.txt"), HasSubstr("on stderr\n"));
}

TEST_F(PluginRun, KeepsWhatWasPrintedWithoutAFlush) {
  const std::string scratch = directory_ / "scratch";
  Run(SpecOf("of_faults", "printing"), PluginPath("of_faults"), {"--scratch", scratch});
  EXPECT_THAT(ReadFile(scratch + "/output.txt"), HasSubstr("without the end of a line"));
}

TEST_F(PluginRun, HasWhatItsLibraryPrintsWhenLoaded) {
  const std::string scratch = directory_ / "scratch";
  const Ended ended = Run(SpecOf("of_noise", "loud"), PluginPath("of_noise"), {"--scratch", scratch});
  EXPECT_EQ(ended.result.verdict, sim::Verdict::kCompleted) << ended.process.err;
  EXPECT_EQ(ReadFile(scratch + "/output.txt"), "loaded\n");
}

TEST_F(PluginRun, IsWorthNothingWithAnotherLibrary) {
  const Ended ended = Run(SpecOf("of_twins", "twin"), PluginPath("of_faults"));
  EXPECT_EQ(ended.process.exit_code, 2);
  EXPECT_EQ(ended.process.out, "");
  EXPECT_THAT(ended.process.err, HasSubstr("is not the plug-in that the run was made for"));
}

TEST_F(PluginRun, IsRefusedInAnotherScenario) {
  const Ended ended = Run(SpecOf("of_twins", "twin", "flocking"), PluginPath("of_twins"));
  EXPECT_EQ(ended.result.verdict, sim::Verdict::kRefused);
  EXPECT_THAT(ended.result.message, HasSubstr("written for the scenario 'light-flocking'"));
}

}  // namespace
}  // namespace gauntlet::testing_support
