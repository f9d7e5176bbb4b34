// Programs under watch: real ones, which do what programs should not.
#include "worker/command/watched_process.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "base/system/process_tree.h"
#include "base/system/resource_limits.h"
#include "tests/support/process.h"
#include "tests/support/sanitizer.h"
#include "worker/runner/confinement.h"

namespace gauntlet::worker {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;
using testing_support::Alive;
using testing_support::Eventually;
using testing_support::kPatience;

std::string Read(const std::string& path) {
  std::ifstream in(path);
  return {std::istreambuf_iterator<char>(in), {}};
}

class WatchedProcessTest : public testing::Test {
 protected:
  void SetUp() override {
    if (testing_support::kSanitized) GTEST_SKIP() << "the sanitizers' threads and memory";
    options_.environment = {"PATH=/usr/bin:/bin", "COLOUR=blue"};
    options_.folder = folder_.path();
    options_.stdout_file = "out";
    options_.stderr_file = "err";
    options_.wall_limit = static_cast<double>(kPatience.count());
  }

  WatchedOutcome Sh(const std::string& script) {
    options_.arguments = {"/bin/sh", "-c", script};
    const Result<WatchedOutcome> outcome = RunWatched(options_);
    EXPECT_TRUE(outcome.ok()) << outcome.error().message;
    return outcome.ok() ? *outcome : WatchedOutcome{};
  }
  std::string Out() const { return Read(folder_ / "out"); }
  pid_t NumberIn(const std::string& file) const { return std::atoi(Read(folder_ / file).c_str()); }
  bool Confines() {
    static const bool confines = [] {
      const pid_t child = fork();
      if (child == 0) _exit(ConfineToTree().valid() ? 0 : 1);
      int status = 0;
      waitpid(child, &status, 0);
      return status == 0;
    }();
    return confines;
  }

  testing_support::TemporaryDirectory folder_;
  WatchedOptions options_;
};

TEST_F(WatchedProcessTest, ItsExitCodeAndItsSignalAreTold) {
  for (const int code : {0, 1, 3, 86, 127, 255}) {
    const WatchedOutcome outcome = Sh("exit " + std::to_string(code));
    EXPECT_TRUE(WIFEXITED(outcome.wait_status));
    EXPECT_EQ(WEXITSTATUS(outcome.wait_status), code);
    EXPECT_EQ(HowItEnded(options_, outcome), "ended with exit code " + std::to_string(code));
  }
  for (const int number : {SIGSEGV, SIGABRT, SIGTERM, SIGKILL}) {
    const WatchedOutcome outcome = Sh("kill -" + std::to_string(number) + " $$");
    EXPECT_TRUE(WIFSIGNALED(outcome.wait_status));
    EXPECT_EQ(WTERMSIG(outcome.wait_status), number);
    EXPECT_EQ(outcome.exceeded, ExceededLimit::kNone);
  }
}

TEST_F(WatchedProcessTest, ItStandsInItsFolderWithItsEnvironmentAndReadsNothing) {
  Sh("pwd; env | grep -c COLOUR=blue; cat; echo to stderr >&2");
  EXPECT_EQ(Out(), fs::canonical(folder_.path()).string() + "\n1\n");
  EXPECT_EQ(Read(folder_ / "err"), "to stderr\n");
  Sh("echo anew");
  EXPECT_EQ(Out(), "anew\n");
}

TEST_F(WatchedProcessTest, ItHasASessionAndNothingOfOurs) {
  Sh("set -- $(cat /proc/$$/stat); echo $(($6 == $$)); ulimit -v; ulimit -t; ulimit -c");
  EXPECT_EQ(Out(), "1\nunlimited\nunlimited\n0\n");
  Sh("exec ls /proc/self/fd");
  EXPECT_EQ(Out(), "0\n1\n2\n3\n") << "the last one is how it reads the folder";
}

TEST_F(WatchedProcessTest, OurSoftLimitsAreNotItsOwn) {
  rlimit before{};
  getrlimit(RLIMIT_AS, &before);
  SetSoftLimit(RLIMIT_AS, rlim_t{8} << 30);
  SetSoftLimit(RLIMIT_CPU, 10'000);
  Sh("ulimit -S -v; ulimit -S -t");
  setrlimit(RLIMIT_AS, &before);
  SetSoftLimit(RLIMIT_CPU, RLIM_INFINITY);
  EXPECT_EQ(Out(), "unlimited\nunlimited\n");
}

TEST_F(WatchedProcessTest, ItFindsTheUsualSignals) {
  signal(SIGXFSZ, SIG_IGN);
  sigset_t one;
  sigemptyset(&one);
  sigaddset(&one, SIGTERM);
  sigprocmask(SIG_BLOCK, &one, nullptr);
  Sh("grep -E 'Sig(Blk|Ign)' /proc/self/status | tr -d '\\t'");
  sigprocmask(SIG_UNBLOCK, &one, nullptr);
  signal(SIGXFSZ, SIG_DFL);
  EXPECT_EQ(Out(), "SigBlk:0000000000000000\nSigIgn:0000000000000000\n");
}

struct Missing {
  const char* name;
  const char* program;
  const char* content;  // of a file "program" in the folder; nullptr: there is none
  mode_t mode;
  const char* why;
};

TEST_F(WatchedProcessTest, AProgramThatCannotBeStartedIsNamed) {
  const Missing some[] = {
      {"nowhere", "no-such-program", nullptr, 0,
       "no-such-program cannot be started: it is in no folder of PATH (/usr/bin:/bin)"},
      {"no file", "./program", nullptr, 0, "./program cannot be started: there is no such file"},
      {"a folder", "/tmp", nullptr, 0, "/tmp cannot be started: it is no file that may be executed here"},
      {"not executable", "program", "#!/bin/sh\n", 0644,
       "program cannot be started: it is no file that may be"},
      {"no interpreter", "program", "#!/no/such/sh\n", 0755, "/program cannot be executed: the interpreter"},
      {"no program", "program", "echo hello\n", 0755, "/program cannot be executed: it is no program of"},
  };
  for (const Missing& missing : some) {
    fs::remove(folder_ / "program");
    if (missing.content != nullptr) {
      std::ofstream(folder_ / "program") << missing.content;
      chmod((folder_ / "program").c_str(), missing.mode);
    }
    options_.arguments = {missing.program};
    const Result<WatchedOutcome> outcome = RunWatched(options_);
    ASSERT_FALSE(outcome.ok()) << missing.name;
    EXPECT_EQ(outcome.error().kind, ErrorKind::kNotFound) << missing.name;
    EXPECT_THAT(outcome.error().message, HasSubstr(missing.why));
  }
  EXPECT_FALSE(HasChildren());
}

TEST_F(WatchedProcessTest, AFileOfTheFolderComesBeforePath) {
  std::ofstream(folder_ / "ls") << "#!/bin/sh\necho mine $1\n";
  chmod((folder_ / "ls").c_str(), 0755);
  options_.arguments = {"ls", "two words"};
  ASSERT_TRUE(RunWatched(options_).ok());
  EXPECT_EQ(Out(), "mine two words\n");
}

TEST_F(WatchedProcessTest, WhatItHasLeftIsEnded) {
  // In the background, in a session of its own, forked twice, deaf to SIGTERM.
  Sh("sleep 600 & echo $! > a;"
     "setsid sh -c 'trap \"\" TERM HUP; echo $$ > b; sleep 600' & "
     "(setsid sh -c 'sleep 600 & echo $! > c' &) ;"
     "until [ -s b ] && [ -s c ]; do :; done");
  for (const char* file : {"a", "b", "c"}) {
    ASSERT_GT(NumberIn(file), 0) << file;
    EXPECT_FALSE(Alive(NumberIn(file))) << file;
  }
  EXPECT_FALSE(HasChildren());
}

TEST_F(WatchedProcessTest, WhoHangsIsEndedByTheWallClock) {
  options_.wall_limit = 0.2;
  const WatchedOutcome outcome = Sh("trap '' TERM HUP INT; sleep 600 & echo $! > pid; wait");
  EXPECT_EQ(outcome.exceeded, ExceededLimit::kWall);
  EXPECT_EQ(HowItEnded(options_, outcome), "exceeded its limit of 0.2 s of wall time");
  EXPECT_FALSE(Alive(NumberIn("pid")));
}

// Whether the kernel limits it or we look.
class WatchedProcessLimitTest : public WatchedProcessTest, public testing::WithParamInterface<bool> {
 protected:
  void SetUp() override {
    WatchedProcessTest::SetUp();
    if (GetParam()) options_.group = &group_;
  }

 private:
  ControlGroup group_;
};
INSTANTIATE_TEST_SUITE_P(With, WatchedProcessLimitTest, testing::Bool(),
                         [](const auto& limited) { return limited.param ? "ControlGroup" : "Looks"; });

TEST_P(WatchedProcessLimitTest, CpuTimeOfAllItsProcessesCounts) {
  options_.cpu_limit = 0.4;
  const std::string spin = "sh -c 'while :; do :; done'";
  for (const std::string& script : {spin, spin + " & " + spin + " & wait",
                                    // Each of them ends soon, and is waited for by its parent or by nobody.
                                    std::string("while :; do ls / > /dev/null; done"),
                                    std::string("while :; do (setsid ls / > /dev/null &); done")}) {
    const WatchedOutcome outcome = Sh(script);
    EXPECT_EQ(outcome.exceeded, ExceededLimit::kCpu) << script;
    EXPECT_GT(outcome.cpu_seconds, 0.4) << script;
  }
  options_.cpu_limit = static_cast<double>(kPatience.count());
  const WatchedOutcome idle = Sh("sleep 0.01");
  EXPECT_EQ(idle.exceeded, ExceededLimit::kNone);
  EXPECT_LT(idle.cpu_seconds, 0.4);
}

TEST_P(WatchedProcessLimitTest, MemoryOfAllItsProcessesCounts) {
  options_.memory_bytes = std::uint64_t{200} << 20;
  const std::string hog = R"(perl -e '$x = "a" x (80 << 20); sleep 600')";
  const WatchedOutcome outcome = Sh(hog + " & " + hog + " & " + hog + " & wait");
  EXPECT_EQ(outcome.exceeded, ExceededLimit::kMemory);
  EXPECT_EQ(HowItEnded(options_, outcome), "exceeded its limit of 200 MB of memory");
  EXPECT_FALSE(HasChildren());
}

TEST_F(WatchedProcessTest, AddressSpaceIsFree) {
  options_.memory_bytes = std::uint64_t{200} << 20;
  SetSoftLimit(RLIMIT_AS, rlim_t{8} << 30);
  const WatchedOutcome outcome = Sh("ulimit -S -v > seen");
  SetSoftLimit(RLIMIT_AS, RLIM_INFINITY);
  EXPECT_EQ(outcome.wait_status, 0);
  EXPECT_EQ(Read(folder_ / "seen"), "unlimited\n");
}

TEST_F(WatchedProcessTest, ManyFilesAreTooMuch) {
  options_.disk_bytes = std::uint64_t{4} << 20;
  const WatchedOutcome outcome =
      Sh("mkdir -p a/b; i=0; while :; do i=$((i+1)); head -c 1000000 /dev/zero > a/b/$i; sleep 0.01; done");
  EXPECT_EQ(outcome.exceeded, ExceededLimit::kDisk);
  EXPECT_EQ(HowItEnded(options_, outcome), "exceeded its limit of 4 MB in its folder");
}

TEST_F(WatchedProcessTest, OneFileAndWhatItPrintsAreLimited) {
  options_.disk_bytes = std::uint64_t{4} << 20;
  for (const char* script : {"exec head -c 1000000000 /dev/zero", "head -c 1000000000 /dev/zero",
                             "exec head -c 1000000000 /dev/zero > big", "exec yes >&2",
                             R"(perl -e '$SIG{XFSZ} = "IGNORE"; print "a" x (8 << 20) or die')"}) {
    const WatchedOutcome outcome = Sh(script);
    EXPECT_EQ(outcome.exceeded, ExceededLimit::kDisk) << script;
    fs::remove(folder_ / "big");
    EXPECT_LE(fs::file_size(folder_ / "out"), options_.disk_bytes);
  }
}

// It may be gone before its folder is looked at for the first time.
TEST_F(WatchedProcessTest, WhatAQuickOneHasLeftIsLimitedToo) {
  options_.disk_bytes = std::uint64_t{4} << 20;
  const WatchedOutcome outcome = Sh("for i in 1 2 3 4 5 6; do head -c 1000000 /dev/zero > $i; done");
  EXPECT_EQ(outcome.exceeded, ExceededLimit::kDisk);
  EXPECT_EQ(outcome.wait_status, 0);
}

TEST_P(WatchedProcessLimitTest, OneThatStartsProcessesWithoutEndEndsWithAllOfThem) {
  options_.wall_limit = 60.0;
  // Not quite without end: what goes wrong here must not take the machine along.
  const WatchedOutcome outcome = Sh("i=0; while [ $i -lt 4000 ]; do sleep 600 & i=$((i+1)); done; wait");
  EXPECT_TRUE(outcome.exceeded == ExceededLimit::kProcesses || outcome.wait_status != 0);
  EXPECT_FALSE(HasChildren());
}

// A child that ends just then interrupts no call that starts another one.
TEST_F(WatchedProcessTest, PipelinesOfShellsWork) {
  const WatchedOutcome outcome =
      Sh("i=0; while [ $i -lt 50 ]; do i=$((i+1)); echo $i | cat | cat >/dev/null || exit 1; done");
  EXPECT_EQ(outcome.wait_status, 0) << Read(folder_ / "err");
}

TEST_F(WatchedProcessTest, ManyProcessesAfterEachOtherAreNotTooMany) {
  const WatchedOutcome outcome = Sh("i=0; while [ $i -lt 400 ]; do i=$((i+1)); /bin/true || exit 1; done");
  EXPECT_EQ(outcome.wait_status, 0);
}

TEST_F(WatchedProcessTest, ItCannotEndUsButItsOwn) {
  if (!Confines()) GTEST_SKIP() << "no filter of system calls here";
  const WatchedOutcome outcome = Sh("kill -9 $PPID || echo refused; sleep 600 & kill $! && echo done");
  EXPECT_EQ(outcome.wait_status, 0);
  EXPECT_EQ(Out(), "refused\ndone\n");
  // Its children may end it.
  EXPECT_EQ(WTERMSIG(Sh("sh -c \"kill -9 $$\"; sleep 600").wait_status), SIGKILL);
}

TEST_F(WatchedProcessTest, RightsCanBeGainedOnlyUnconfined) {
  const char* const script = "grep NoNewPrivs /proc/self/status | tr -d '\\t'";
  Sh(script);
  EXPECT_EQ(Out(), "NoNewPrivs:1\n");
  options_.confine = false;
  options_.wall_limit = 0.5;
  Sh(script);
  EXPECT_EQ(Out(), "NoNewPrivs:0\n");
  EXPECT_EQ(Sh("sleep 600").exceeded, ExceededLimit::kWall);
}

// It is not kept from writing where its user may.
TEST_F(WatchedProcessTest, MayWriteBesideItsFolder) {
  const testing_support::TemporaryDirectory beside;
  EXPECT_EQ(Sh("echo here > " + (beside / "note")).wait_status, 0);
  EXPECT_EQ(Read(beside / "note"), "here\n");
}

TEST_F(WatchedProcessTest, NothingOutlivesUs) {
  const pid_t supervisor = fork();  // takes the orphans of the runner over, as the fork server does
  if (supervisor == 0) {
    TakeOrphans();
    const pid_t runner = fork();
    if (runner == 0) {
      std::ofstream(folder_ / "runner") << getpid() << "\n";
      options_.arguments = {
          "/bin/sh", "-c",
          "echo $$ > a; (setsid sleep 600 & echo $! > b); mv b c; while :; do sleep 1; done"};
      RunWatched(options_).ok();
      _exit(0);
    }
    waitpid(runner, nullptr, 0);
    EndProcessesBelow();
    _exit(0);
  }
  ASSERT_TRUE(Eventually([&] { return NumberIn("c") > 0; }, kPatience));
  kill(NumberIn("runner"), SIGKILL);
  waitpid(supervisor, nullptr, 0);
  for (const char* file : {"a", "c"}) EXPECT_FALSE(Alive(NumberIn(file))) << file;
}

std::ptrdiff_t OpenFiles() {
  return std::distance(fs::directory_iterator("/proc/self/fd"), fs::directory_iterator());
}

TEST_F(WatchedProcessTest, AThousandRunsLeaveNothing) {
  options_.arguments = {"/bin/true"};
  options_.cpu_limit = options_.wall_limit;
  options_.memory_bytes = options_.disk_bytes = std::uint64_t{1} << 30;
  ASSERT_TRUE(RunWatched(options_).ok());
  const std::ptrdiff_t before = OpenFiles();
  for (int run = 0; run < 1000; ++run) {
    const Result<WatchedOutcome> outcome = RunWatched(options_);
    ASSERT_TRUE(outcome.ok());
    ASSERT_EQ(outcome->wait_status, 0);
  }
  EXPECT_EQ(OpenFiles(), before);
  EXPECT_FALSE(HasChildren());
  EXPECT_EQ(std::distance(fs::directory_iterator(folder_.path()), fs::directory_iterator()), 2);
}

TEST_F(WatchedProcessTest, TheTailOfAFileIsItsEnd) {
  std::ofstream(folder_ / "file") << "abcdef";
  EXPECT_EQ(TailOf(folder_ / "file", 2), "ef");
  EXPECT_EQ(TailOf(folder_ / "file", 100), "abcdef");
  EXPECT_EQ(TailOf(folder_ / "none", 100), "");
  EXPECT_EQ(TailOf(folder_.path(), 100), "");
}

}  // namespace
}  // namespace gauntlet::worker
