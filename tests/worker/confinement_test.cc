// What a run tries to do to others, and what it still may do.
#include "worker/runner/confinement.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <sched.h>
#include <sys/ptrace.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <sys/uio.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <functional>
#include <string>
#include <thread>
#include <vector>

#include "base/system/process_identity.h"
#include "base/system/process_tree.h"
#include "tests/support/process.h"
#include "tests/support/sanitizer.h"
#include "worker/runner/prepared_process.h"

namespace gauntlet::worker {
namespace {

namespace fs = std::filesystem;

// Whether this machine's kernel has what it takes.
bool Offered() {
  const pid_t child = fork();
  if (child == 0) _exit(ConfineToTree().valid() ? 0 : 1);
  int status = 0;
  waitpid(child, &status, 0);
  return status == 0;
}

class ConfinementTest : public testing::Test {
 protected:
  void SetUp() override {
    if (testing_support::kSanitized) GTEST_SKIP() << "sanitizers have threads and processes of their own";
    if (!Offered()) GTEST_SKIP() << "this kernel offers no filter of system calls that asks";
  }

  // What `work` returns in a confined process.
  static std::string Confined(const std::function<std::string()>& work, const SeparateOptions& options = {}) {
    PreparedProcess process([] {}, [&](const std::string&) { return work(); });
    const Result<SeparateOutcome> outcome = process.Call("", options);
    if (!outcome) return outcome.error().message;
    return outcome->bytes.value_or(
        fmt::format("ended as {}: {}", outcome->wait_status, outcome->output_tail));
  }
};

std::string Name(int result) {
  return result == 0 ? "done" : strerrorname_np(errno);
}

TEST_F(ConfinementTest, DoesNothingToProcessesAboveIt) {
  const std::string tried = Confined([] {
    std::string said;
    for (pid_t above = getppid(); above > 1; above = ParentOf(above)) {
      const rlimit none{.rlim_cur = 0, .rlim_max = 0};
      cpu_set_t processors;
      CPU_ZERO(&processors);
      CPU_SET(0, &processors);
      char byte = 0;
      const iovec here{.iov_base = &byte, .iov_len = 1};
      for (const std::string& end :
           {Name(kill(above, SIGKILL)), Name(kill(-above, SIGKILL)),
            Name(prlimit(above, RLIMIT_CPU, &none, nullptr)),
            Name(setpriority(PRIO_PROCESS, static_cast<id_t>(above), 19)),
            Name(sched_setaffinity(above, sizeof processors, &processors)),
            Name(ptrace(PTRACE_ATTACH, above, nullptr, nullptr) == 0 ? 0 : -1),
            Name(process_vm_readv(above, &here, 1, &here, 1, 0) == 1 ? 0 : -1), Name(setpgid(0, above))}) {
        if (end != "EPERM") said += fmt::format("{} above is {}; ", above, end);
      }
    }
    return said + Name(kill(-1, SIGKILL));
  });
  EXPECT_EQ(tried, "EPERM");
}

TEST_F(ConfinementTest, ReadsNeitherMemoryNorDescriptorsOfThoseThatMadeIt) {
  HideFromOthers();  // as the fork server is, and what it starts
  const std::string tried = Confined([] {
    std::string said;
    for (const pid_t above : {getppid(), ParentOf(getppid())}) {
      for (const char* what : {"mem", "environ", "maps", "fd/0", "fd/1"}) {
        const std::string path = fmt::format("/proc/{}/{}", above, what);
        const UniqueFd opened(open(path.c_str(), O_RDONLY));
        char byte = 0;
        if (opened.valid() && (std::string(what) == "fd" || read(opened.get(), &byte, 1) == 1))
          said += path + " ";
      }
    }
    return said + "nothing";
  });
  ShowToOthers();
  EXPECT_EQ(tried, "nothing");
}

TEST_F(ConfinementTest, HasNoDescriptorsOfThoseThatMadeIt) {
  const UniqueFd secret(open("/dev/null", O_RDONLY));
  EXPECT_EQ(Confined([&] { return Name(fcntl(secret.get(), F_GETFD)); }), "EBADF");
}

TEST_F(ConfinementTest, HasNoTerminal) {
  EXPECT_EQ(Confined([] { return Name(open("/dev/tty", O_RDWR) >= 0 ? 0 : -1); }), "ENXIO");
}

TEST_F(ConfinementTest, RaisesNoLimit) {
  const SeparateOptions limits = {.cpu_limit_seconds = 7.0, .memory_limit_bytes = std::uint64_t{1} << 30};
  const std::string tried = Confined(
      [] {
        std::string said;
        for (const auto resource : {RLIMIT_AS, RLIMIT_CPU, RLIMIT_FSIZE, RLIMIT_CORE}) {
          rlimit limit{};
          getrlimit(resource, &limit);
          limit.rlim_cur = limit.rlim_max = limit.rlim_max + 1;
          said += Name(setrlimit(resource, &limit)) + " ";
        }
        return said;
      },
      limits);
  EXPECT_EQ(tried, "EPERM EPERM EPERM EPERM ");
}

TEST_F(ConfinementTest, WhoIgnoresTheCpuLimitIsEndedByIt) {
  PreparedProcess process([] {},
                          [](const std::string&) -> std::string {
                            std::signal(SIGXCPU, SIG_IGN);
                            for (volatile bool on = true; on;) continue;
                            return "";
                          });
  const Result<SeparateOutcome> outcome = process.Call("", {.cpu_limit_seconds = 0.1});
  ASSERT_TRUE(outcome.ok());
  EXPECT_EQ(WTERMSIG(outcome->wait_status), SIGXCPU);
}

TEST_F(ConfinementTest, TheCpuLimitIsForAllThatItStartsTogether) {
  PreparedProcess process([] {},
                          [](const std::string&) -> std::string {
                            for (int child = 0; child < 3; ++child) (void)fork();
                            for (volatile bool on = true; on;) continue;
                            return "";
                          });
  const Result<SeparateOutcome> outcome = process.Call("", {.cpu_limit_seconds = 4.0});
  ASSERT_TRUE(outcome.ok());
  EXPECT_EQ(WTERMSIG(outcome->wait_status), SIGXCPU);
  EXPECT_LT(process.cpu_seconds(), 8 * 4.0);
}

TEST_F(ConfinementTest, StartsOnlySoManyProcessesAndLeavesNone) {
  const testing_support::TemporaryDirectory shared;
  const std::string started = Confined([&] {
    int count = 0;
    while (true) {
      const pid_t child = fork();
      if (child < 0) return fmt::format("{} after {}", strerrorname_np(errno), count);
      if (child == 0) {
        setsid();
        std::ofstream(shared / std::to_string(getpid())) << "";
        while (true) pause();
      }
      ++count;
    }
  });
  // The first two are the prepared process and that of the call.
  EXPECT_EQ(started, fmt::format("EAGAIN after {}", kMostTasksOfTree - 2));
  for (const fs::directory_entry& entry : fs::directory_iterator(shared.path()))
    EXPECT_EQ(kill(std::stoi(entry.path().filename()), 0), -1) << "a process is left";
}

TEST_F(ConfinementTest, ThreadsAreCountedToo) {
  EXPECT_EQ(Confined([] {
              std::vector<std::thread> threads;
              try {
                while (true) threads.emplace_back([] { pause(); });
              } catch (const std::system_error& error) {
                const std::string said = fmt::format("{} threads", threads.size());
                for (std::thread& thread : threads) thread.detach();
                return said;
              }
            }),
            fmt::format("{} threads", kMostTasksOfTree - 2));
}

TEST_F(ConfinementTest, WhatHasEndedMakesRoom) {
  EXPECT_EQ(Confined([] {
              for (int i = 0; i < 2 * kMostTasksOfTree; ++i) std::thread([] {}).join();
              return std::string("all");
            }),
            "all");
}

TEST_F(ConfinementTest, MaySignalItselfAndWhatItStarts) {
  EXPECT_EQ(Confined([] {
              std::signal(SIGUSR1, SIG_IGN);
              const pid_t child = fork();
              if (child == 0) {
                while (true) pause();
              }
              int status = 0;
              std::string said = Name(raise(SIGUSR1)) + " " + Name(kill(getpid(), SIGUSR1)) + " ";
              said += Name(kill(child, SIGTERM)) + " ";
              waitpid(child, &status, 0);
              return said + strsignal(WTERMSIG(status));
            }),
            "done done done Terminated");
}

TEST_F(ConfinementTest, MayUseSocketsOfThisMachineAndPrograms) {
  EXPECT_EQ(Confined([] {
              const UniqueFd server(socket(AF_INET, SOCK_STREAM, 0));
              const UniqueFd client(socket(AF_INET, SOCK_STREAM, 0));
              sockaddr_in address{
                  .sin_family = AF_INET, .sin_port = 0, .sin_addr = {htonl(INADDR_LOOPBACK)}, .sin_zero = {}};
              socklen_t size = sizeof address;
              auto* const any = reinterpret_cast<sockaddr*>(&address);
              const bool connected = bind(server.get(), any, size) == 0 && listen(server.get(), 1) == 0 &&
                                     getsockname(server.get(), any, &size) == 0 &&
                                     connect(client.get(), any, size) == 0;
              return std::string(connected ? "connected" : "cut off") + ", " +
                     (std::system("true") == 0 ? "ran" : "failed");
            }),
            "connected, ran");
}

TEST_F(ConfinementTest, ItsTemporaryFilesGoWithIt) {
  std::string made = Confined([] {
    std::string path = fs::temp_directory_path() / "mine-XXXXXX";
    close(mkstemp(path.data()));
    return path;
  });
  EXPECT_FALSE(fs::exists(made)) << made;
}

}  // namespace
}  // namespace gauntlet::worker
