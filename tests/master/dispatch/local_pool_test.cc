// Real processes: small shell scripts in place of gauntlet-worker.
#include "master/dispatch/pool/local_pool.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <functional>
#include <sstream>
#include <thread>

#include "tests/support/fake_clock.h"

namespace gauntlet {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;
using testing::SizeIs;

bool Exists(pid_t pid) {
  return kill(pid, 0) == 0;
}

std::string ContentOf(const std::string& path) {
  std::ifstream file(path);
  std::stringstream content;
  content << file.rdbuf();
  return content.str();
}

bool Eventually(const std::function<bool()>& condition) {
  const auto deadline = std::chrono::steady_clock::now() + seconds(20);
  while (!condition()) {
    if (std::chrono::steady_clock::now() > deadline) return false;
    std::this_thread::yield();
  }
  return true;
}

class LocalPoolTest : public testing::Test {
 protected:
  LocalPoolTest() {
    char name[] = "/tmp/gauntlet-pool-XXXXXX";
    directory_ = mkdtemp(name);
    options_.program = directory_ + "/worker";
    options_.access_file = directory_ + "/access.json";
    options_.log_directory = directory_;
  }
  ~LocalPoolTest() override { std::filesystem::remove_all(directory_); }

  void WriteWorker(const std::string& script) const {
    std::ofstream(options_.program) << "#!/bin/sh\n" << script << "\n";
    chmod(options_.program.c_str(), 0755);
  }
  std::unique_ptr<LocalPool> Start() {
    Result<std::unique_ptr<LocalPool>> pool = LocalPool::Start(options_, clock_.Now());
    EXPECT_TRUE(pool.ok()) << pool.error().message;
    return *std::move(pool);
  }
  // Supervises until some worker has ended.
  Result<std::vector<pid_t>> NextEnds(LocalPool& pool) {
    Result<std::vector<pid_t>> ended = std::vector<pid_t>{};
    Eventually([&] {
      ended = pool.Supervise(clock_.Now());
      return !ended.ok() || !ended->empty();
    });
    return ended;
  }

  // Until every worker has become `sleep`, and needs its script no more.
  static void AwaitSleeping(const LocalPool& pool) {
    for (const pid_t pid : pool.pids()) {
      EXPECT_TRUE(Eventually([pid] {
        std::string name;
        std::ifstream("/proc/" + std::to_string(pid) + "/comm") >> name;
        return name == "sleep";
      }));
    }
  }

  testing_support::FakeClock clock_;
  std::string directory_;
  LocalPoolOptions options_;
};

TEST_F(LocalPoolTest, StartsItsWorkersWithTheirArgumentsInSessionsOfTheirOwn) {
  WriteWorker("echo \"$@\"; echo complaint >&2; exec sleep 1000");
  options_.workers = 2;
  const std::unique_ptr<LocalPool> pool = Start();
  EXPECT_EQ(pool->running(), 2);
  for (const pid_t pid : pool->pids()) EXPECT_EQ(getsid(pid), pid) << "a Ctrl-C must not reach it";
  const std::string log = directory_ + "/worker-2.log";
  EXPECT_TRUE(Eventually([&] { return ContentOf(log).find("complaint") != std::string::npos; }));
  EXPECT_EQ(ContentOf(log), "--access " + options_.access_file + " --die-with-parent " +
                                std::to_string(getpid()) + " --quiet --log " + log + "\ncomplaint\n");
}

TEST_F(LocalPoolTest, ReplacesAWorkerThatDiedAndReportsIt) {
  WriteWorker("exec sleep 1000");
  options_.workers = 2;
  const std::unique_ptr<LocalPool> pool = Start();
  const std::vector<pid_t> before = pool->pids();
  std::vector<int> fds;
  pool->AppendWaitFds(fds);
  EXPECT_THAT(fds, SizeIs(2));
  clock_.Advance(seconds(100));
  kill(before[1], SIGKILL);
  const Result<std::vector<pid_t>> ended = NextEnds(*pool);
  ASSERT_TRUE(ended.ok());
  EXPECT_THAT(*ended, testing::ElementsAre(before[1]));
  EXPECT_EQ(pool->running(), 2);
  EXPECT_EQ(pool->pids()[0], before[0]);
  EXPECT_NE(pool->pids()[1], before[1]);
  const std::vector<DispatchEvent> events = pool->TakeEvents();
  ASSERT_THAT(events, SizeIs(1));
  EXPECT_EQ(events[0].kind, "worker-died");
  EXPECT_EQ(events[0].text, "worker process " + std::to_string(before[1]) +
                                " ended with signal 9 (Killed); another one takes its place");
}

TEST_F(LocalPoolTest, GivesUpOnAWorkerThatNeverStaysAliveAndShowsItsLastWords) {
  WriteWorker("echo cannot load the widget >&2; exit 7");
  const std::unique_ptr<LocalPool> pool = Start();
  int ends = 0;
  Result<std::vector<pid_t>> ended = std::vector<pid_t>{};
  while (ends < 100) {
    ended = NextEnds(*pool);
    if (!ended.ok()) break;
    ++ends;
    clock_.Advance(milliseconds(1900));
  }
  // The sixth end in a row is reported first, the error comes with the next call.
  EXPECT_EQ(ends, 6);
  ASSERT_FALSE(ended.ok());
  EXPECT_EQ(ended.error().message,
            "workers do not stay alive: " + directory_ +
                "/worker ended 6 times in a row within 2 s of its start, the last time with exit status 7; " +
                directory_ +
                "/worker-1.log ends: cannot load the widget | cannot load the widget | cannot load the "
                "widget | cannot load the widget | cannot load the widget");
  EXPECT_EQ(pool->running(), 0);
}

TEST_F(LocalPoolTest, AWorkerThatLivedLongEnoughMayDieAnyNumberOfTimes) {
  WriteWorker("exec sleep 1000");
  const std::unique_ptr<LocalPool> pool = Start();
  for (int death = 0; death < 10; ++death) {
    clock_.Advance(milliseconds(2100));
    ASSERT_EQ(pool->running(), 1);
    kill(pool->pids()[0], SIGKILL);
    ASSERT_TRUE(NextEnds(*pool).ok());
  }
}

TEST_F(LocalPoolTest, AProcessThatCannotBeHadIsTriedForAgainWhileOthersWork) {
  WriteWorker("exec sleep 1000");
  options_.workers = 2;
  const std::unique_ptr<LocalPool> pool = Start();
  AwaitSleeping(*pool);
  std::filesystem::rename(options_.program, options_.program + ".away");
  kill(pool->pids()[0], SIGKILL);
  ASSERT_THAT(*NextEnds(*pool), SizeIs(1));
  for (int attempt = 0; attempt < 20; ++attempt) {
    clock_.Advance(seconds(10));
    ASSERT_TRUE(pool->Supervise(clock_.Now()).ok()) << attempt;
    EXPECT_EQ(pool->running(), 1);
  }
  const std::vector<DispatchEvent> events = pool->TakeEvents();
  ASSERT_THAT(events, SizeIs(2));
  EXPECT_EQ(events[1].kind, "worker-not-started");
  EXPECT_EQ(events[1].text,
            "cannot start " + directory_ + "/worker: No such file or directory; trying again");

  std::filesystem::rename(options_.program + ".away", options_.program);
  clock_.Advance(seconds(10));
  ASSERT_TRUE(pool->Supervise(clock_.Now()).ok());
  EXPECT_EQ(pool->running(), 2);
}

TEST_F(LocalPoolTest, GivesUpWhenNoProcessCanBeHadAndNoneIsLeft) {
  WriteWorker("exec sleep 1000");
  const std::unique_ptr<LocalPool> pool = Start();
  AwaitSleeping(*pool);
  std::filesystem::rename(options_.program, options_.program + ".away");
  kill(pool->pids()[0], SIGKILL);
  ASSERT_THAT(*NextEnds(*pool), SizeIs(1));
  int attempts = 0;
  for (; attempts < 100 && pool->Supervise(clock_.Now()).ok(); ++attempts) clock_.Advance(seconds(10));
  const Result<std::vector<pid_t>> error = pool->Supervise(clock_.Now());
  ASSERT_FALSE(error.ok()) << attempts;
  EXPECT_EQ(error.error().message, "cannot start " + directory_ + "/worker: No such file or directory");
}

TEST_F(LocalPoolTest, WaitsLongerAndLongerBeforeItStartsAFailingWorkerAgain) {
  WriteWorker("exit 1");
  const std::unique_ptr<LocalPool> pool = Start();
  ASSERT_THAT(*NextEnds(*pool), SizeIs(1));
  ASSERT_THAT(*NextEnds(*pool), SizeIs(1)) << "the first time at once";
  EXPECT_EQ(pool->running(), 0);
  clock_.Advance(milliseconds(49));
  ASSERT_TRUE(pool->Supervise(clock_.Now()).ok());
  EXPECT_EQ(pool->running(), 0);
  clock_.Advance(milliseconds(1));
  ASSERT_TRUE(pool->Supervise(clock_.Now()).ok());
  EXPECT_EQ(pool->running(), 1);
}

TEST_F(LocalPoolTest, LeavesNoChildNotEvenAStoppedOrADeafOne) {
  WriteWorker("trap '' TERM; echo ready; while :; do sleep 1; done");
  options_.workers = 2;
  std::vector<pid_t> pids;
  {
    const std::unique_ptr<LocalPool> pool = Start();
    pids = pool->pids();
    EXPECT_TRUE(Eventually([&] { return ContentOf(directory_ + "/worker-1.log") == "ready\n"; }));
    kill(pids[1], SIGSTOP);
  }
  for (const pid_t pid : pids) EXPECT_FALSE(Exists(pid));
}

TEST_F(LocalPoolTest, WhatADeadWorkerStartedGoesWithIt) {
  WriteWorker("sleep 1000 & echo $!; wait");
  const std::unique_ptr<LocalPool> pool = Start();
  const std::string log = directory_ + "/worker-1.log";
  ASSERT_TRUE(Eventually([&] { return ContentOf(log).ends_with("\n"); }));
  const pid_t grandchild = std::atoi(ContentOf(log).c_str());
  ASSERT_GT(grandchild, 1);
  EXPECT_TRUE(Exists(grandchild));
  kill(pool->pids()[0], SIGKILL);
  ASSERT_THAT(*NextEnds(*pool), SizeIs(1));
  // It is init's to reap: a zombie counts as gone.
  const std::string stat = "/proc/" + std::to_string(grandchild) + "/stat";
  EXPECT_TRUE(Eventually([&] {
    const std::string content = ContentOf(stat);
    return content.empty() || content.find(") Z") != std::string::npos;
  }));
}

TEST_F(LocalPoolTest, DoesNotReplaceWhenItIsToStop) {
  WriteWorker("exec sleep 1000");
  const std::unique_ptr<LocalPool> pool = Start();
  pool->StopReplacing();
  pool->SignalAll(SIGTERM);
  ASSERT_THAT(*NextEnds(*pool), SizeIs(1));
  ASSERT_TRUE(pool->Supervise(clock_.Now()).ok());
  EXPECT_EQ(pool->running(), 0);
}

TEST_F(LocalPoolTest, SaysWhatIsMissing) {
  Result<std::unique_ptr<LocalPool>> pool = LocalPool::Start(options_, clock_.Now());
  ASSERT_FALSE(pool.ok());
  EXPECT_EQ(pool.error().message,
            "cannot start workers: " + options_.program +
                ": No such file or directory (GAUNTLET_WORKER may name another program)");
  WriteWorker("exit 0");
  options_.workers = 0;
  pool = LocalPool::Start(options_, clock_.Now());
  ASSERT_FALSE(pool.ok());
  EXPECT_EQ(pool.error().message, "a pool needs at least one worker, not 0");
}

}  // namespace
}  // namespace gauntlet
