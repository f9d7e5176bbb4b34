// Limits of the operating system (ulimit) that leave a program too little: it ends at once, by itself, with
// the reason, and never by an abort.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <filesystem>

#include "tests/integration/campaign_driver.h"
#include "tests/support/sanitizer.h"

namespace gauntlet::testing_support {
namespace {

constexpr std::chrono::seconds kStarvedSoon{20};

struct Famine {
  std::string limit;               // an option of prlimit(1)
  std::vector<std::string> words;  // one of them is said
};
void PrintTo(const Famine& famine, std::ostream* os) {
  *os << famine.limit;
}

class StarvedProcessTest : public testing::TestWithParam<Famine> {
 protected:
  // What the program does under the limit. Limits of processes are another user's: root has none.
  ProcessResult Starve(std::vector<std::string> command) {
    std::vector<std::string> whole = {"/usr/bin/prlimit", GetParam().limit};
    if (ForProcesses()) {
      const std::string user = std::to_string(User());
      whole = {"/usr/bin/setpriv", "--reuid=" + user,  "--regid=" + user,
               "--clear-groups",   "/usr/bin/prlimit", GetParam().limit};
    }
    whole.insert(whole.end(), command.begin(), command.end());
    Process process(whole, {"TMPDIR=/tmp"});
    return process.Wait(kStarvedSoon);
  }
  // Nobody else's, so that nobody else's processes count.
  static uid_t User() { return 60000 + static_cast<uid_t>(getpid()) % 5000; }
  static bool ForProcesses() { return GetParam().limit.starts_with("--nproc"); }
  void SetUp() override {
    if (kSanitized && GetParam().limit.starts_with("--as")) GTEST_SKIP() << "sanitizers want all addresses";
    if (kSanitized && (GetParam().limit == "--nofile=5" || GetParam().limit == "--nproc=1"))
      GTEST_SKIP() << "sanitizers want descriptors and processes of their own";
    if (!ForProcesses()) return;
    if (geteuid() != 0) GTEST_SKIP() << "only root can become another user";
    if (access("/usr/bin/setpriv", X_OK) != 0) GTEST_SKIP() << "there is no setpriv";
    // The other user has to reach the programs, and a folder of its own.
    const std::string user = std::to_string(User());
    if (RunProcess(
            {"/usr/bin/setpriv", "--reuid=" + user, "--clear-groups", "/usr/bin/test", "-x", WorkerPath()})
            .exit_code != 0)
      GTEST_SKIP() << "another user cannot reach " << WorkerPath();
    ASSERT_EQ(chown(scratch_.path().c_str(), User(), 0), 0);
  }
  static void ExpectReason(const ProcessResult& result, const std::string& what) {
    EXPECT_EQ(result.signal, 0) << what << ": " << result.err;
    EXPECT_THAT(result.exit_code, testing::AnyOf(2, 3)) << what << ": " << result.err;
    EXPECT_TRUE(std::ranges::any_of(
        GetParam().words,
        [&](const std::string& words) { return result.err.find(words) != std::string::npos; }))
        << what << ": " << result.err;
  }

  TemporaryDirectory scratch_;
};

TEST_P(StarvedProcessTest, ACampaignEndsAtOnceWithTheReason) {
  ExpectReason(Starve(GauntletCommand({"evolve", "flocking", "--dir", scratch_ / "c", "--workers", "2",
                                       "--population", "20", "--generations", "50", "--no-progress"})),
               "evolve");
}

TEST_P(StarvedProcessTest, AWorkerEndsAtOnceWithTheReason) {
  if (GetParam().limit.starts_with("--fsize")) GTEST_SKIP() << "it writes nothing but its log";
  const std::string access = scratch_ / "access.json";
  ASSERT_EQ(RunProcess({"/bin/sh", "-c",
                        "echo '{\"format\": 1, \"campaign\": \"c\", \"epoch\": 1, \"endpoints\": "
                        "[\"tcp://127.0.0.1:1\"]}' > " +
                            access + "; chmod 600 " + access})
                .exit_code,
            0);
  if (ForProcesses()) {
    ASSERT_EQ(chown(access.c_str(), User(), 0), 0);
  }
  ExpectReason(Starve({WorkerPath(), "--access", access, "--orphan-timeout", "1"}), "worker");
}

INSTANTIATE_TEST_SUITE_P(
    Limits, StarvedProcessTest,
    testing::Values(Famine{"--nofile=5", {"ulimit -Hn"}}, Famine{"--nofile=8", {"ulimit -Hn"}},
                    Famine{"--nofile=12", {"ulimit -Hn"}}, Famine{"--nofile=16", {"ulimit -Hn"}},
                    Famine{"--nofile=24", {"ulimit -Hn"}}, Famine{"--nofile=32", {"ulimit -Hn"}},
                    Famine{"--nofile=64", {"ulimit -Hn"}}, Famine{"--nproc=1", {"ulimit -u"}},
                    Famine{"--nproc=2", {"ulimit -u"}}, Famine{"--nproc=3", {"ulimit -u"}},
                    // Enough for a worker, which finds no master then.
                    Famine{"--as=36700160", {"ulimit -v", "shared libraries", "no word from a master"}},
                    Famine{"--as=51200000", {"ulimit -v", "shared libraries", "no word from a master"}},
                    Famine{"--fsize=8192", {"ulimit -f"}}, Famine{"--fsize=200000", {"ulimit -f"}}),
    [](const auto& test) {
      std::string name = test.param.limit.substr(2);
      std::ranges::replace(name, '=', '_');
      return name;
    });

}  // namespace
}  // namespace gauntlet::testing_support
