#include "base/system/process_tree.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>

#include "tests/support/sanitizer.h"

namespace gauntlet {
namespace {

// A process with a child of its own; both live until they are ended.
class ProcessTreeTest : public testing::Test {
 protected:
  ProcessTreeTest() {
    std::array<int, 2> pipe_ends{};
    if (pipe(pipe_ends.data()) != 0) std::abort();
    child_ = fork();
    if (child_ == 0) {
      const pid_t below = fork();
      if (below == 0) {
        while (true) pause();
      }
      [[maybe_unused]] const ssize_t written = write(pipe_ends[1], &below, sizeof below);
      while (true) pause();
    }
    [[maybe_unused]] const ssize_t got = read(pipe_ends[0], &grandchild_, sizeof grandchild_);
    for (const int end : pipe_ends) close(end);
  }
  ~ProcessTreeTest() override { EndProcessesBelow(); }

  pid_t child_ = 0;
  pid_t grandchild_ = 0;
};

TEST_F(ProcessTreeTest, KnowsWhoIsBelowWhom) {
  EXPECT_THAT(ProcessesBelow(getpid()), testing::UnorderedElementsAre(child_, grandchild_));
  EXPECT_THAT(ProcessesBelow(child_), testing::ElementsAre(grandchild_));
  EXPECT_THAT(SampleBelow(getpid()), testing::UnorderedElementsAre(child_, grandchild_));
  EXPECT_FALSE(IsBelow(child_, grandchild_));
  EXPECT_FALSE(IsBelow(child_, child_));
  // The thread sanitizer has one of its own in each.
  EXPECT_EQ(ThreadsOf(child_), testing_support::kSanitized ? ThreadsOf(grandchild_) : 1);
}

TEST_F(ProcessTreeTest, KnowsTheMemoryThatAProcessHasInUse) {
  EXPECT_GT(ResidentBytesOf(getpid()), std::uint64_t{1} << 20);
  const pid_t none = child_;
  EndProcessesBelow();
  EXPECT_EQ(ResidentBytesOf(none), 0U);
}

TEST_F(ProcessTreeTest, EndsOrphansToo) {
  TakeOrphans();
  kill(child_, SIGKILL);
  waitpid(child_, nullptr, 0);
  EXPECT_TRUE(HasChildren());
  EndProcessesBelow();
  EXPECT_FALSE(HasChildren());
  EXPECT_EQ(kill(grandchild_, 0), -1);
}

// A process may end between the opening and the reading of what the kernel says of it.
TEST(ProcessTree, IsReadWhileProcessesComeAndGo) {
  const pid_t restless = fork();
  if (restless == 0) {
    while (true) {
      if (fork() == 0) _exit(0);
      waitpid(-1, nullptr, 0);
    }
  }
  for (int look = 0; look < 300; ++look) EXPECT_LE(ProcessesBelow(restless).size(), 2U);
  kill(restless, SIGKILL);
  waitpid(restless, nullptr, 0);
}

TEST(ProcessTree, OfAProcessThatIsNotThereIsEmpty) {
  EXPECT_THAT(ProcessesBelow(-5), testing::IsEmpty());
  EXPECT_EQ(ThreadsOf(-5), 0);
  EXPECT_FALSE(IsBelow(-5, getpid()));
}

}  // namespace
}  // namespace gauntlet
