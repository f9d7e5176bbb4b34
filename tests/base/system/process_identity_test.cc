#include "base/system/process_identity.h"

#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

namespace gauntlet {
namespace {

TEST(ProcessIdentityTest, ThisProcessIsAlive) {
  const ProcessIdentity self = IdentifyThisProcess();
  EXPECT_EQ(self.pid, getpid());
  EXPECT_GT(self.start_time, 0u);
  EXPECT_EQ(self.boot_id.size(), 36u);
  EXPECT_FALSE(self.host.empty());
  EXPECT_EQ(LivenessOf(self, self), Liveness::kAlive);
  EXPECT_EQ(self, IdentifyThisProcess());
}

TEST(ProcessIdentityTest, AProcessThatEndedIsDeadAsAZombieToo) {
  ProcessIdentity child = IdentifyThisProcess();
  child.pid = fork();
  ASSERT_GE(child.pid, 0);
  if (child.pid == 0) {
    pause();
    _exit(0);
  }
  child.start_time = StartTimeOf(child.pid).value_or(0);
  const ProcessIdentity self = IdentifyThisProcess();
  EXPECT_EQ(LivenessOf(child, self), Liveness::kAlive);
  kill(child.pid, SIGKILL);
  siginfo_t ended{};
  ASSERT_EQ(waitid(P_PID, static_cast<id_t>(child.pid), &ended, WEXITED | WNOWAIT), 0);
  EXPECT_EQ(LivenessOf(child, self), Liveness::kDead) << "a zombie";
  waitpid(child.pid, nullptr, 0);
  EXPECT_EQ(LivenessOf(child, self), Liveness::kDead);
}

TEST(ProcessIdentityTest, AReusedPidIsAnotherProcess) {
  const ProcessIdentity self = IdentifyThisProcess();
  ProcessIdentity former = self;
  former.start_time -= 1;
  EXPECT_EQ(LivenessOf(former, self), Liveness::kDead);
}

TEST(ProcessIdentityTest, NothingIsKnownOfAnotherBootOrNamespace) {
  const ProcessIdentity self = IdentifyThisProcess();
  ProcessIdentity other = self;
  other.boot_id = "8c2b8d1e-0000-0000-0000-000000000000";
  EXPECT_EQ(LivenessOf(other, self), Liveness::kUnknown);
  other = self;
  other.boot_id.clear();
  EXPECT_EQ(LivenessOf(other, self), Liveness::kUnknown);
  other = self;
  other.pid_namespace = "pid:[1]";
  EXPECT_EQ(LivenessOf(other, self), Liveness::kUnknown);
}

}  // namespace
}  // namespace gauntlet
