#include "master/dispatch/pool/process_watch.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <poll.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <filesystem>

namespace gauntlet {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

// A child that waits to be killed.
class ProcessWatchTest : public testing::Test {
 protected:
  ProcessWatchTest() {
    child_ = IdentifyThisProcess();
    child_.pid = fork();
    if (child_.pid == 0) {
      pause();
      _exit(0);
    }
    child_.start_time = StartTimeOf(child_.pid).value_or(0);
  }
  ~ProcessWatchTest() override {
    Kill();
    waitpid(child_.pid, nullptr, 0);
  }
  void Kill() const { kill(child_.pid, SIGKILL); }
  bool Readable(int patience_ms) const {
    pollfd item{watch_.fd(), POLLIN, 0};
    return poll(&item, 1, patience_ms) == 1;
  }
  static std::ptrdiff_t OpenFiles() {
    return std::distance(std::filesystem::directory_iterator("/proc/self/fd"), {});
  }

  ProcessWatch watch_;
  ProcessIdentity child_;
};

TEST_F(ProcessWatchTest, TellsAnEndAtOnceAndOnce) {
  ASSERT_TRUE(watch_.Watch(7, child_));
  EXPECT_FALSE(Readable(0));
  EXPECT_THAT(watch_.TakeEnded(), IsEmpty());
  Kill();
  EXPECT_TRUE(Readable(10'000));
  EXPECT_THAT(watch_.TakeEnded(), ElementsAre(7));
  EXPECT_FALSE(Readable(0));
  EXPECT_THAT(watch_.TakeEnded(), IsEmpty());
}

TEST_F(ProcessWatchTest, TellsARunnableProcessFromASleepingAndAStoppedOne) {
  ASSERT_TRUE(watch_.Watch(7, child_));
  while (StartTimeOf(child_.pid) && watch_.WaitsForProcessor(7)) continue;  // until it pauses
  EXPECT_FALSE(watch_.WaitsForProcessor(7));
  EXPECT_FALSE(watch_.WaitsForProcessor(8)) << "not watched";
  ProcessIdentity busy = IdentifyThisProcess();
  busy.pid = fork();
  if (busy.pid == 0) {
    while (true) continue;
  }
  busy.start_time = StartTimeOf(busy.pid).value_or(0);
  ASSERT_TRUE(watch_.Watch(9, busy));
  EXPECT_TRUE(watch_.WaitsForProcessor(9));
  kill(busy.pid, SIGSTOP);
  int status = 0;
  EXPECT_EQ(waitpid(busy.pid, &status, WUNTRACED), busy.pid);
  EXPECT_FALSE(watch_.WaitsForProcessor(9));
  kill(busy.pid, SIGKILL);
  waitpid(busy.pid, &status, 0);
  EXPECT_FALSE(watch_.WaitsForProcessor(9));
}

TEST_F(ProcessWatchTest, WatchesNobodyWhoIsNotCertainlyMeant) {
  const std::ptrdiff_t files = OpenFiles();
  ProcessIdentity other = child_;
  other.start_time += 1;  // the pid was another process'
  EXPECT_FALSE(watch_.Watch(1, other));
  other = child_;
  other.boot_id = "another machine's";
  EXPECT_FALSE(watch_.Watch(2, other));
  other = child_;
  other.pid_namespace = "pid:[1]";
  EXPECT_FALSE(watch_.Watch(3, other));
  other = child_;
  other.pid = 0;
  EXPECT_FALSE(watch_.Watch(4, other));
  EXPECT_FALSE(watch_.Watch(5, ProcessIdentity{}));
  EXPECT_EQ(OpenFiles(), files);
  Kill();
  EXPECT_FALSE(Readable(100));
}

TEST_F(ProcessWatchTest, ANameHasOneProcessAndIsForgottenWithoutATrace) {
  const std::ptrdiff_t files = OpenFiles();
  ASSERT_TRUE(watch_.Watch(7, child_));
  ASSERT_TRUE(watch_.Watch(7, child_)) << "as after a reconnect";
  EXPECT_EQ(OpenFiles(), files + 1);
  watch_.Forget(7);
  watch_.Forget(8);
  EXPECT_EQ(OpenFiles(), files);
  Kill();
  EXPECT_FALSE(Readable(100));
}

TEST_F(ProcessWatchTest, HasABound) {
  std::size_t watched = 0;
  while (watched <= ProcessWatch::kMost && watch_.Watch(watched, child_)) ++watched;
  EXPECT_LE(watched, ProcessWatch::kMost);
  EXPECT_GT(watched, 100U) << "fewer only where fewer files may be open";
  Kill();
  ASSERT_TRUE(Readable(10'000));
  EXPECT_EQ(watch_.TakeEnded().size(), watched);
}

}  // namespace
}  // namespace gauntlet
