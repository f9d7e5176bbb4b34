// Calls in processes that are forked from a prepared one.
#include "worker/runner/prepared_process.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <thread>

#include "base/system/sha256.h"
#include "proto/run_codec.h"
#include "tests/support/process.h"
#include "tests/support/sanitizer.h"
#include "worker/runner/pipe.h"
#include "worker/runner/runner.h"

namespace gauntlet::worker {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;
using testing_support::TemporaryDirectory;

// What the processes of a test share.
struct Counts {
  int prepared = 0;
};

// The state that a library would have.
int statics = 0;

class PreparedProcessTest : public testing::Test {
 protected:
  PreparedProcessTest()
      : counts_(static_cast<Counts*>(
            mmap(nullptr, sizeof(Counts), PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0))) {}
  ~PreparedProcessTest() override { munmap(counts_, sizeof(Counts)); }

  void SetUp() override {
    // The sanitizers' own threads and descriptors look like those of a library.
    if (testing_support::kSanitized) GTEST_SKIP() << "threads and descriptors of the sanitizers";
  }

  // Prepares the statics and then what else is asked for; a call gives what it finds, and changes it.
  PreparedProcess Make(std::function<void()> and_then = [] {}) {
    return PreparedProcess(
        [this, and_then = std::move(and_then)] {
          ++counts_->prepared;
          statics = 7;
          and_then();
        },
        [](const std::string& request) { return request + std::to_string(statics++); });
  }
  static std::string Answer(PreparedProcess& process, const std::string& request) {
    const Result<SeparateOutcome> outcome = process.Call(request, {});
    if (!outcome) return outcome.error().message;
    return outcome->bytes.value_or("ended: " + outcome->output_tail);
  }

  Counts* counts_;
};

TEST_F(PreparedProcessTest, EveryCallFindsWhatWasPreparedOnce) {
  PreparedProcess process = Make();
  for (const char* request : {"a", "b", "c"}) EXPECT_EQ(Answer(process, request), request + std::string("7"));
  EXPECT_EQ(counts_->prepared, 1);
  EXPECT_EQ(statics, 0) << "nothing of it is done in this process";
}

TEST_F(PreparedProcessTest, WhatTheCallsCostIsCounted) {
  PreparedProcess process([] {},
                          [](const std::string&) {
                            while (SecondsWithChildren() < 0.05) continue;
                            return std::string();
                          });
  EXPECT_EQ(Answer(process, ""), "");
  EXPECT_GT(process.cpu_seconds(), 0.05);
  const double before = SecondsWithChildren();
  process.End();
  EXPECT_EQ(process.cpu_seconds(), 0.0);
  EXPECT_GT(SecondsWithChildren(), before + 0.05);
}

TEST_F(PreparedProcessTest, ACallThatEndsItsProcessDoesNotEndTheNext) {
  PreparedProcess process([] {},
                          [](const std::string& request) {
                            if (request == "abort") std::abort();
                            return request;
                          });
  const Result<SeparateOutcome> aborted = process.Call("abort", {});
  ASSERT_TRUE(aborted.ok());
  EXPECT_FALSE(aborted->bytes.has_value());
  EXPECT_EQ(WTERMSIG(aborted->wait_status), SIGABRT);
  EXPECT_EQ(Answer(process, "fine"), "fine");
}

TEST_F(PreparedProcessTest, HowPreparingEndedIsTheOutcome) {
  PreparedProcess process = Make([] {
    fprintf(stderr, "no license\n");
    _exit(3);
  });
  for (int attempt = 0; attempt < 2; ++attempt) {
    const Result<SeparateOutcome> outcome = process.Call("", {});
    ASSERT_TRUE(outcome.ok());
    EXPECT_EQ(WEXITSTATUS(outcome->wait_status), 3);
    EXPECT_EQ(outcome->output_tail, "no license\n");
  }
}

TEST_F(PreparedProcessTest, LimitsHoldWhenItPreparesAndInEveryCall) {
  if (!kMemoryLimitWorks) GTEST_SKIP();
  const SeparateOptions tight = {.memory_limit_bytes = std::uint64_t{256} << 20};
  const auto allocate = [](const std::string&) { return std::string(std::size_t{1} << 30, 'x'); };
  PreparedProcess in_call([] {}, allocate);
  PreparedProcess in_preparing([allocate] { allocate(""); },
                               [](const std::string& request) { return request; });
  for (PreparedProcess* process : {&in_call, &in_preparing}) {
    const Result<SeparateOutcome> outcome = process->Call("", tight);
    ASSERT_TRUE(outcome.ok());
    EXPECT_EQ(WEXITSTATUS(outcome->wait_status), kExitOutOfMemory);
  }
}

TEST_F(PreparedProcessTest, TimeLimitsAreThoseOfACall) {
  PreparedProcess process([] {},
                          [](const std::string& request) {
                            rlimit cpu{};
                            getrlimit(RLIMIT_CPU, &cpu);
                            return request + std::to_string(cpu.rlim_cur) + ", " + std::to_string(alarm(0));
                          });
  EXPECT_EQ(process.Call("", {.cpu_limit_seconds = 5.0, .wall_limit_seconds = 50})->bytes, "5, 50");
  EXPECT_EQ(process.Call("", {.cpu_limit_seconds = 7.5, .wall_limit_seconds = 0})->bytes, "8, 0");
}

TEST_F(PreparedProcessTest, EveryCallBeginsInAnEmptyFolderWhichIsGoneAfterwards) {
  PreparedProcess process([] {},
                          [](const std::string& request) {
                            const fs::path here = fs::current_path();
                            for (const fs::directory_entry& entry : fs::directory_iterator(here))
                              if (entry.path().filename() != kOutputFile)
                                return "found " + entry.path().string();
                            if (request == "write") std::ofstream("notes.txt") << "notes\n";
                            if (request == "print") std::printf("words\n"), std::fflush(stdout);
                            return here.string();
                          });
  const std::string first = Answer(process, "");
  EXPECT_EQ(Answer(process, "write"), first) << "an empty folder is as good as a new one";
  const std::string second = Answer(process, "print");
  EXPECT_NE(second, first);
  EXPECT_FALSE(fs::exists(first));
  const std::string third = Answer(process, "");
  EXPECT_NE(third, second);
  EXPECT_TRUE(fs::exists(third));
}

// As temporary folders of a group are.
TEST_F(PreparedProcessTest, PreparesOnceInATemporaryFolderWhoseGroupIsInherited) {
  const TemporaryDirectory place;
  fs::permissions(place.path(), fs::perms::owner_all | fs::perms::set_gid);
  setenv("TMPDIR", place.path().c_str(), /*overwrite=*/1);
  {
    PreparedProcess process = Make();
    for (const char* request : {"a", "b"}) EXPECT_EQ(Answer(process, request), request + std::string("7"));
    EXPECT_EQ(counts_->prepared, 1);
  }
  unsetenv("TMPDIR");
  EXPECT_TRUE(fs::is_empty(place.path()));
}

TEST_F(PreparedProcessTest, AFolderThatACallReplacesIsRemovedWithWhatReplacedIt) {
  const TemporaryDirectory place;
  setenv("TMPDIR", place.path().c_str(), /*overwrite=*/1);
  PreparedProcess process([] {},
                          [](const std::string&) {
                            const fs::path here = fs::current_path();
                            std::ofstream(here / "notes.txt") << "notes";
                            fs::rename(here, here.string() + "-moved");
                            fs::create_directory(here);
                            std::ofstream(here / "more.txt") << "notes";
                            return std::string("moved");
                          });
  for (int call = 0; call < 2; ++call) EXPECT_EQ(Answer(process, ""), "moved");
  EXPECT_EQ(Answer(process, ""), "moved");
  process.End();
  unsetenv("TMPDIR");
  std::ptrdiff_t left = 0;
  for (const fs::directory_entry& entry : fs::directory_iterator(place.path()))
    left += entry.exists() ? 1 : 0;
  EXPECT_LE(left, 2) << "of the last call, as long as there is no next one";
}

TEST_F(PreparedProcessTest, UsesTheFolderThatIsNamed) {
  const TemporaryDirectory scratch;
  PreparedProcess process([] {}, [](const std::string&) { return fs::current_path().string(); });
  const Result<SeparateOutcome> outcome = process.Call("", {.scratch = scratch / "mine"});
  ASSERT_TRUE(outcome.ok());
  EXPECT_EQ(outcome->bytes, fs::canonical(scratch / "mine").string());
}

struct Trace {
  const char* name;
  void (*leave)();
};
void PrintTo(const Trace& trace, std::ostream* os) {
  *os << trace.name;
}

class PreparedWithTraces : public PreparedProcessTest, public testing::WithParamInterface<Trace> {};

// Two processes cannot share these as each would have its own.
TEST_P(PreparedWithTraces, EveryCallPreparesForItself) {
  PreparedProcess process = Make(GetParam().leave);
  EXPECT_EQ(Answer(process, "a"), "a7");
  const int before = counts_->prepared;
  EXPECT_EQ(Answer(process, "b"), "b7");
  EXPECT_EQ(Answer(process, "c"), "c7");
  EXPECT_EQ(counts_->prepared, before + 2);
}

INSTANTIATE_TEST_SUITE_P(Traces, PreparedWithTraces,
                         testing::Values(Trace{"Output", [] { fprintf(stderr, "hello\n"); }},
                                         Trace{"File", [] { std::ofstream("made.txt") << "x"; }},
                                         Trace{"Descriptor",
                                               [] { [[maybe_unused]] const int fd = dup(STDIN_FILENO); }},
                                         Trace{"Thread", [] { std::thread([] { pause(); }).detach(); }},
                                         Trace{"Child",
                                               [] {
                                                 if (fork() == 0) pause();
                                               }}),
                         [](const testing::TestParamInfo<Trace>& parameter) { return parameter.param.name; });

}  // namespace
}  // namespace gauntlet::worker
