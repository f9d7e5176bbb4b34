// Control groups: where they may stand, and real ones where this user may make them.
#include "worker/runner/control_group.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <cstring>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <functional>
#include <iterator>
#include <set>
#include <string>
#include <vector>

#include "tests/support/process.h"
#include "tests/support/sanitizer.h"

namespace gauntlet::worker {
namespace {

namespace fs = std::filesystem;
using testing::ElementsAre;
using testing::IsEmpty;

TEST(GroupPlacesTest, OfVersion1AreAHierarchyEach) {
  const auto places = GroupPlaces(
      "31 23 0:28 / /sys/fs/cgroup rw - tmpfs tmpfs rw,mode=755\n"
      "32 31 0:29 / /sys/fs/cgroup/cpu,cpuacct rw,relatime shared:9 - cgroup cgroup rw,cpu,cpuacct\n"
      "35 31 0:32 / /sys/fs/cgroup/memory rw,relatime - cgroup cgroup rw,memory\n"
      "41 31 0:38 / /sys/fs/cgroup/unified rw,relatime - cgroup2 cgroup2 rw\n",
      "5:cpu,cpuacct:/\n4:memory:/slurm/job_7\n0::/\n");
  EXPECT_THAT(places[kGroupMemory].parents,
              ElementsAre("/sys/fs/cgroup/memory/slurm/job_7", "/sys/fs/cgroup/memory/slurm"));
  EXPECT_FALSE(places[kGroupMemory].version_2);
  EXPECT_THAT(places[kGroupTime].parents, ElementsAre("/sys/fs/cgroup/cpu,cpuacct"));
  EXPECT_THAT(places[kGroupProcesses].parents, ElementsAre("/sys/fs/cgroup/unified"));
  EXPECT_TRUE(places[kGroupProcesses].version_2);
}

TEST(GroupPlacesTest, OfVersion2AreOneHierarchy) {
  const auto places = GroupPlaces("29 22 0:26 / /sys/fs/cgroup rw,nosuid - cgroup2 cgroup2 rw,nsdelegate\n",
                                  "0::/user.slice/app.slice/run-1.scope\n");
  for (const GroupPlace& place : places) {
    EXPECT_TRUE(place.version_2);
    EXPECT_THAT(place.parents, ElementsAre("/sys/fs/cgroup/user.slice/app.slice/run-1.scope",
                                           "/sys/fs/cgroup/user.slice/app.slice"));
  }
}

TEST(GroupPlacesTest, OfAContainerAreBelowWhatIsMountedThere) {
  const auto places = GroupPlaces(
      "35 31 0:32 /docker/1a2b /sys/fs/cgroup/memory ro - cgroup cgroup rw,memory\n"
      "36 31 0:33 /docker/other /sys/fs/cgroup/pids ro - cgroup cgroup rw,pids\n",
      "4:memory:/docker/1a2b\n5:pids:/docker/1a2b\n");
  EXPECT_THAT(places[kGroupMemory].parents, ElementsAre("/sys/fs/cgroup/memory"));
  EXPECT_THAT(places[kGroupProcesses].parents, ElementsAre("/sys/fs/cgroup/pids"));
}

TEST(GroupPlacesTest, WithoutControlGroupsThereAreNone) {
  for (const char* mounts :
       {"", "31 23 0:28 / /sys/fs/cgroup rw - tmpfs tmpfs rw\n", "cgroup", "a - cgroup"}) {
    for (const GroupPlace& place : GroupPlaces(mounts, "0::/\n")) EXPECT_THAT(place.parents, IsEmpty());
  }
}

constexpr std::uint64_t kMegabyte = std::uint64_t{1} << 20;

class ControlGroupTest : public testing::Test {
 protected:
  void SetUp() override {
    if (testing_support::kSanitized) GTEST_SKIP() << "the sanitizers' threads and memory";
    group_.Limit({.memory_bytes = 64 * kMegabyte, .processes = 3});
    if (!group_.IsWhole()) GTEST_SKIP() << "this user may make no control groups here";
  }

  // The wait status of a child that does the work.
  static int Fork(const std::function<void()>& work) {
    const pid_t child = fork();
    if (child == 0) {
      ControlGroup::EndThisFirst();
      work();
      _exit(0);
    }
    int status = 0;
    waitpid(child, &status, 0);
    return status;
  }

  ControlGroup group_;
};

void Touch(std::size_t bytes) {
  std::vector<char> memory(bytes);
  std::memset(memory.data(), 1, bytes);
  asm volatile("" ::"r"(memory.data()) : "memory");
}

TEST_F(ControlGroupTest, TheKernelLimitsMemory) {
  EXPECT_EQ(Fork([] { Touch(16 * kMegabyte); }), 0);
  EXPECT_FALSE(group_.OutOfMemory());
  const int status = Fork([] { Touch(128 * kMegabyte); });
  EXPECT_TRUE(WIFSIGNALED(status));
  EXPECT_EQ(WTERMSIG(status), SIGKILL);
  EXPECT_TRUE(group_.OutOfMemory());
  group_.Limit({.memory_bytes = 256 * kMegabyte});
  EXPECT_EQ(Fork([] { Touch(128 * kMegabyte); }), 0);
  EXPECT_FALSE(group_.OutOfMemory());
  group_.Limit({});
  EXPECT_EQ(Fork([] { Touch(512 * kMegabyte); }), 0);
}

TEST_F(ControlGroupTest, AFileInMemoryThatWasLeftIsNotThatOfTheNext) {
  const std::string left = "/dev/shm/gauntlet-test-" + std::to_string(getpid());
  const auto leave_a_file = [&] {
    std::ofstream file(left);
    for (int i = 0; i < 40; ++i) file << std::string(kMegabyte, 'a');
  };
  EXPECT_EQ(Fork(leave_a_file), 0);
  group_.Limit({.memory_bytes = 64 * kMegabyte});
  EXPECT_EQ(Fork([] { Touch(40 * kMegabyte); }), 0);
  EXPECT_FALSE(group_.OutOfMemory());
  fs::remove(left);
}

TEST_F(ControlGroupTest, TheKernelLimitsProcesses) {
  // The first one, in a process group of its own, and its children.
  const auto start = [](int number) {
    return Fork([&] {
      setpgid(0, 0);
      for (int child = 1; child < number; ++child) {
        if (fork() == 0) pause();
      }
      kill(0, SIGKILL);
    });
  };
  start(3);
  EXPECT_FALSE(group_.OutOfProcesses());
  start(4);
  EXPECT_TRUE(group_.OutOfProcesses());
}

void Work(double seconds) {
  while (static_cast<double>(std::clock()) < seconds * CLOCKS_PER_SEC) {
  }
}

TEST_F(ControlGroupTest, ItsTimeIsThatOfAllThatWereInItButOurs) {
  constexpr double kSeconds = 0.2;
  group_.Limit({.processes = 3});
  Fork([] {
    signal(SIGCHLD, SIG_IGN);  // so that nobody waits for its child
    if (fork() == 0) {
      Work(kSeconds);
      _exit(0);
    }
    waitpid(-1, nullptr, 0);
  });
  EXPECT_GE(group_.CpuSeconds().value_or(0.0), kSeconds);
  group_.Limit({.processes = 3});
  Work(static_cast<double>(std::clock()) / CLOCKS_PER_SEC + kSeconds);
  EXPECT_LT(group_.CpuSeconds().value_or(kSeconds), kSeconds / 2);
}

TEST_F(ControlGroupTest, ItIsRemovedAndSoAreThoseOfTheDeadWithAllInThem) {
  const auto contents = [](const char* path) {
    std::ifstream in(path);
    return std::string(std::istreambuf_iterator<char>(in), {});
  };
  const auto left = [&](pid_t process) {
    int folders = 0;
    // Where they were before anybody was in a group.
    std::set<std::string> parents;
    for (const GroupPlace& place :
         GroupPlaces(contents("/proc/self/mountinfo"), contents("/proc/self/cgroup")))
      parents.insert(place.parents.begin(), place.parents.end());
    for (const std::string& parent : parents) {
      for (const auto& entry : fs::directory_iterator(parent)) {
        const std::string name = entry.path().filename();
        folders += name.starts_with("gauntlet-") && name.ends_with("-" + std::to_string(process)) ? 1 : 0;
      }
    }
    return folders;
  };
  const pid_t killed = fork();
  if (killed == 0) {
    ControlGroup group;
    group.Limit({.memory_bytes = 64 * kMegabyte, .processes = 8});
    if (fork() == 0) pause();
    kill(getpid(), SIGKILL);
  }
  waitpid(killed, nullptr, 0);
  EXPECT_GT(left(killed), 0);
  EXPECT_TRUE(testing_support::Eventually(
      [&] {
        ControlGroup::RemoveAbandoned();
        return left(killed) == 0;
      },
      testing_support::kPatience));
  EXPECT_GT(left(getpid()), 0) << "not abandoned";
}

}  // namespace
}  // namespace gauntlet::worker
