// Runs that are a program: what becomes of what it does.
#include "worker/command/command_runs.h"

#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <filesystem>

#include "base/system/process_tree.h"
#include "controllers/command/placeholders.h"
#include "proto/run_codec.h"
#include "proto/run_failure.h"
#include "tests/support/paths.h"
#include "tests/support/sanitizer.h"
#include "tests/worker/command/command_folder.h"
#include "worker/runner/separate_process.h"

namespace gauntlet::worker {
namespace {

namespace fs = std::filesystem;
using proto::FailureKind;
using testing::EndsWith;
using testing::HasSubstr;
using testing_support::Alive;
using testing_support::Eventually;
using testing_support::kPatience;
using testing_support::ProcessResult;
using testing_support::TemporaryDirectory;

constexpr const char* kWorker = GAUNTLET_BINARY_DIR "/gauntlet-worker";
constexpr const char* kReports = R"(; echo '{"score": 2}' > "$1")";

struct Ran {
  std::optional<sim::RunResult> result;
  RunnerReport report;
  int wait_status = 0;
  std::string said;
  proto::RunnerFailure failure() const { return ClassifyExit(wait_status, said); }
};

class CommandRunsTest : public testing::Test {
 protected:
  void SetUp() override {
    if (testing_support::kSanitized) GTEST_SKIP() << "the sanitizers' threads and memory";
    setenv("TMPDIR", temporary_.path().c_str(), 1);
  }
  void TearDown() override {
    unsetenv("TMPDIR");
    EXPECT_TRUE(fs::is_empty(temporary_.path())) << "folders of runs are left";
  }

  static sim::RunSpec SpecOf(const std::string& hash) {
    sim::RunSpec spec;
    spec.scenario = controllers::command::kScenario;
    spec.scenario_plugin = hash;
    spec.controller = controllers::command::kController;
    spec.scenario_parameters[controllers::command::kWallLimit] = static_cast<double>(kPatience.count());
    spec.seed = 7;
    return spec;
  }
  // In a process like a runner's.
  Ran Run(const sim::RunSpec& spec, const RunnerJob& job = {}, int times = 1) {
    const TemporaryDirectory place;
    const pid_t runner = fork();
    if (runner == 0) {
      dup2(open((place / "stderr").c_str(), O_WRONLY | O_CREAT | O_APPEND, 0600), STDERR_FILENO);
      PluginSettings settings = settings_;
      CommandRuns runs(settings);
      std::string report;
      for (int run = 0; run < times; ++run) report = runs.Execute(job, spec);
      std::ofstream(place / "report") << report;
      _exit(0);
    }
    Ran ran;
    waitpid(runner, &ran.wait_status, 0);
    ControlGroup::RemoveAbandoned();  // as the fork server does
    ran.said = ContentsOf(place / "stderr");
    if (const auto report = DecodeReport(ContentsOf(place / "report")); report && ran.wait_status == 0) {
      ran.report = *report;
      ran.result = *proto::DecodeRunResult(report->result);
    }
    return ran;
  }
  Ran Run(const controllers::command::Definition& definition) { return Run(SpecOf(folder_.Add(definition))); }
  Ran Sh(const std::string& script) { return Run(ShellDefinition(script)); }

  CommandFolder folder_;
  PluginSettings settings_ = folder_.settings();
  TemporaryDirectory temporary_;
};

TEST_F(CommandRunsTest, AProgramGetsItsCaseAndItsMetricsAreTheResult) {
  sim::RunSpec spec = SpecOf(folder_.Add(
      ShellDefinition(R"(grep -q 1.25 "$0" && [ "$HOME" = "$PWD" ] && echo "{\"score\": $2.5}" > "$1")")));
  spec.test_case.obstacles = {{1.25, 0.5, 0.4, 0.2, 30.0}};
  const Ran ran = Run(spec);
  ASSERT_TRUE(ran.result.has_value()) << ran.said;
  EXPECT_EQ(ran.result->verdict, sim::Verdict::kCompleted);
  EXPECT_EQ(ran.result->fitness, controllers::command::SeedOf(7) + 0.5);
  EXPECT_EQ(ran.result->metrics.at(0).first, "score");
  EXPECT_EQ(ran.result->hash, sim::HashOf(*ran.result));
  EXPECT_EQ(ran.said, "");
}

TEST_F(CommandRunsTest, ATemplateIsFilled) {
  auto definition = ShellDefinition(R"(mv "$0" "$1")");
  definition.files = {folder_.AddFile(
      "worlds.d/a.json", "{\"score\": @seed@, \"boxes\": [\n@obstacles@\n@number@\n@end@\n]}\n", false)};
  definition.case_template = "worlds.d/a.json";
  const Ran ran = Run(definition);
  ASSERT_TRUE(ran.result.has_value()) << ran.said;
  EXPECT_EQ(ran.result->fitness, controllers::command::SeedOf(7));
}

TEST_F(CommandRunsTest, TheTimeOfAllItsProcessesIsTheRuns) {
  const Ran ran = Sh("perl -e '1 while (times)[0] < 0.1'" + std::string(kReports));
  ASSERT_TRUE(ran.result.has_value()) << ran.said;
  EXPECT_GT(ran.report.cpu_seconds, 0.05);
  EXPECT_EQ(ran.result->cpu_seconds, ran.report.cpu_seconds);
  EXPECT_GE(ran.report.process_cpu_seconds, ran.report.cpu_seconds);
}

TEST_F(CommandRunsTest, OneRunAfterTheOtherFindsNothingOfTheLast) {
  auto definition =
      ShellDefinition("[ ! -e left ] && echo > left && [ \"$LOADED\" = yes ]" + std::string(kReports));
  definition.setup = "export LOADED=yes";
  const Ran ran = Run(SpecOf(folder_.Add(definition)), {}, 3);
  EXPECT_TRUE(ran.result.has_value()) << ran.said;
}

TEST_F(CommandRunsTest, WhatItLeavesIsRemovedAlsoWhenItIsReadOnly) {
  EXPECT_TRUE(Sh("mkdir -p a/b; echo > a/b/file; chmod 400 a/b/file; chmod 0 a/b; chmod 500 a" +
                 std::string(kReports) + "; chmod 500 .")
                  .result.has_value());
}

TEST_F(CommandRunsTest, ARefusedCaseIsAResultWithoutTheNameOfTheFolder) {
  auto definition = ShellDefinition(R"(printf 'noise\nno place: \a%s/x\n' "$PWD" >&2; exit 1)");
  definition.refused = {"no place"};
  const Ran ran = Run(definition);
  ASSERT_TRUE(ran.result.has_value()) << ran.said;
  EXPECT_EQ(ran.result->verdict, sim::Verdict::kRefused);
  EXPECT_EQ(ran.result->message, "the program refuses this case: no place: \\x07x");
  definition.run[2] = "printf 'no place: %0999d\\n' 1; exit 1";
  const Ran wordy = Run(definition);
  ASSERT_TRUE(wordy.result.has_value()) << wordy.said;
  EXPECT_EQ(wordy.result->message, "the program refuses this case: no place: " + std::string(190, '0'));
}

TEST_F(CommandRunsTest, ExitCodesArePassedOnAsTheyAre) {
  for (const int code : {1, 2, 3, 84, 94, 127, 139, 255}) {
    const Ran ran = Sh("echo words; echo more >&2; exit " + std::to_string(code));
    EXPECT_EQ(ran.wait_status, code << 8);
    EXPECT_EQ(Describe(ran.failure()), "crashed with exit code " + std::to_string(code));
    EXPECT_EQ(ran.said, "words\nmore\nthe program ended with exit code " + std::to_string(code) + "\n");
  }
}

TEST_F(CommandRunsTest, ItsExitCodesAreNotTakenForOurs) {
  for (int code = kExitUnheard; code <= kExitOverProcesses; ++code) {
    const Ran ran = Sh("printf 'no newline'; exit " + std::to_string(code));
    EXPECT_EQ(ran.wait_status, kExitOfProgram << 8);
    EXPECT_EQ(ran.failure().kind, FailureKind::kCrashed);
    EXPECT_EQ(ran.failure().exit_code, code);
    EXPECT_EQ(Describe(ran.failure()), "crashed with exit code " + std::to_string(code));
    EXPECT_FALSE(IsWithoutPlugin(ran.failure()));
  }
}

TEST_F(CommandRunsTest, SignalsArePassedOn) {
  for (const int number : {SIGSEGV, SIGABRT, SIGFPE, SIGBUS, SIGKILL}) {
    const Ran ran = Sh("kill -" + std::to_string(number) + " $$");
    EXPECT_EQ(ran.wait_status & 0x7f, number);
    EXPECT_EQ(ran.failure().signal, number);
    EXPECT_THAT(ran.said, HasSubstr("the program was ended by signal " + std::to_string(number)));
  }
  const Ran ran = Sh("kill -TERM $$");
  EXPECT_EQ(ran.wait_status, (kExitSignalled + SIGTERM) << 8);
  EXPECT_THAT(ran.said, EndsWith("the program ended its process by signal 15 (Terminated)\n"));
}

TEST_F(CommandRunsTest, AnEndWithoutMetricsIsACrash) {
  const Ran ran = Sh("echo almost");
  EXPECT_EQ(ran.wait_status, kExitWithoutMetrics << 8);
  EXPECT_EQ(ran.failure().kind, FailureKind::kCrashed);
  EXPECT_THAT(ran.said, testing::StartsWith("almost\nthe program ended with exit code 0, but it has "));
  EXPECT_EQ(proto::Explained(Describe(ran.failure())),
            "crashed with exit code 92 (its outcome could not be read)");
}

TEST_F(CommandRunsTest, LimitsEndARunAsThoseOfOurs) {
  auto waits = ShellDefinition("echo begun; sleep 600");
  sim::RunSpec spec = SpecOf(folder_.Add(waits));
  spec.scenario_parameters[controllers::command::kWallLimit] = 0.2;
  const Ran waited = Run(spec);
  EXPECT_EQ(waited.failure().kind, FailureKind::kHung);
  EXPECT_EQ(waited.said, "begun\nthe program exceeded its limit of 0.2 s of wall time\n");

  auto spins = ShellDefinition("while :; do :; done");
  spins.cpu_limit = 1.0;
  const Ran spun = Run(spins);
  EXPECT_EQ(spun.failure().kind, FailureKind::kHung);
  EXPECT_EQ(spun.said, "the program exceeded its limit of 1 s of CPU time\n");

  auto grows = ShellDefinition(R"(perl -e '$x = "a" x (90 << 20); sleep 600')");
  grows.memory = 64;
  const Ran grown = Run(grows);
  EXPECT_EQ(grown.failure().kind, FailureKind::kOutOfMemory);
  // A shell says besides what the kernel has done to its child.
  EXPECT_THAT(grown.said, EndsWith("the program exceeded its limit of 64 MB of memory\n"));

  auto prints = ShellDefinition("exec yes");
  prints.disk = 2;
  const Ran printed = Run(prints);
  EXPECT_EQ(proto::Explained(Describe(printed.failure())),
            "crashed with exit code 91 (its folder grew beyond its limit)");
  EXPECT_THAT(printed.said, EndsWith("y\nthe program exceeded its limit of 2 MB in its folder\n"));
  EXPECT_LE(printed.said.size(), proto::kMaxStderrTail);
}

TEST_F(CommandRunsTest, WhatCannotBeStartedIsThisWorkersTrouble) {
  auto definition = ShellDefinition("true");
  definition.run[0] = "no-such-simulator";
  const Ran missing = Run(definition);
  EXPECT_TRUE(IsWithoutPlugin(missing.failure()));
  EXPECT_THAT(missing.said,
              HasSubstr("the program no-such-simulator cannot be started: it is in no folder of PATH ("));
  definition = ShellDefinition("true");
  definition.setup = "echo module: not found >&2; false";
  const Ran without_setup = Run(definition);
  EXPECT_TRUE(IsWithoutPlugin(without_setup.failure()));
  EXPECT_EQ(without_setup.said, "the command's setup ended with exit code 1\nmodule: not found\n");
  const Ran unknown = Run(SpecOf(std::string(64, '0')));
  EXPECT_TRUE(IsWithoutPlugin(unknown.failure()));
}

TEST_F(CommandRunsTest, ANamedFolderIsKeptAndWasEmpty) {
  const TemporaryDirectory place;
  settings_.scratch = place / "kept";
  EXPECT_TRUE(Sh(std::string("echo words") + kReports).result.has_value());
  EXPECT_EQ(ContentsOf(place / "kept/.gauntlet-stdout"), "words\n");
  EXPECT_THAT(ContentsOf(place / "kept/out.json"), HasSubstr("score"));
  const Ran again = Sh("true");
  EXPECT_TRUE(IsWithoutPlugin(again.failure()));
  EXPECT_THAT(again.said, HasSubstr("kept is not empty"));
}

// With the fork server above it, as in every worker.
class CommandWorkerTest : public CommandRunsTest {
 protected:
  std::vector<std::string> Line(const std::string& hash, const sim::RunSpec& spec) {
    std::ofstream(place_ / "spec") << proto::EncodeRunSpec(spec);
    return {kWorker, "--run-spec", place_ / "spec", "--plugin", folder_.PathOf(hash)};
  }
  ProcessResult Start(const controllers::command::Definition& definition) {
    const std::string hash = folder_.Add(definition);
    return testing_support::RunProcess(Line(hash, SpecOf(hash)));
  }
  TemporaryDirectory place_;
};

TEST_F(CommandWorkerTest, AWorkerRunsIt) {
  const ProcessResult ended = Start(ShellDefinition("true" + std::string(kReports)));
  EXPECT_EQ(ended.exit_code, 0) << ended.err;
  EXPECT_EQ(proto::DecodeRunResult(ended.out)->fitness, 2.0);
  const ProcessResult crashed = Start(ShellDefinition("exit 88"));
  EXPECT_EQ(crashed.exit_code, 0) << crashed.err;
  EXPECT_EQ(proto::DecodeRunResult(crashed.out)->message, "crashed with exit code 88");
  auto missing = ShellDefinition("true");
  missing.run[0] = "./nothing";
  const ProcessResult refused = Start(missing);
  EXPECT_EQ(refused.exit_code, 2);
  EXPECT_EQ(refused.err, "gauntlet-worker: the program ./nothing cannot be started: there is no such file\n");
}

// As when its lease is cancelled.
TEST_F(CommandWorkerTest, TheEndOfTheRunnerLeavesNothing) {
  const std::string a = place_ / "a";
  const std::string b = place_ / "b";
  const std::string hash =
      folder_.Add(ShellDefinition("(setsid sleep 600 & echo $! > " + b + "0); mv " + b + "0 " + b +
                                  "; echo \"$PPID $$\" > " + a + "0; mv " + a + "0 " + a + "; sleep 600"));
  testing_support::Process worker(Line(hash, SpecOf(hash)));
  ASSERT_TRUE(Eventually([&] { return fs::exists(a); }, kPatience)) << worker.Err();
  pid_t runner = 0;
  pid_t program = 0;
  std::ifstream(a) >> runner >> program;
  const pid_t daemon = std::atoi(ContentsOf(b).c_str());
  ASSERT_TRUE(Alive(runner) && Alive(program) && Alive(daemon));
  kill(runner, SIGKILL);
  EXPECT_EQ(worker.Wait().exit_code, 4) << "the run was ended from outside";
  for (const pid_t process : {runner, program, daemon}) EXPECT_FALSE(Alive(process));
}

}  // namespace
}  // namespace gauntlet::worker
