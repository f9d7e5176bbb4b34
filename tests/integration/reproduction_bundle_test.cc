// A run that crashes in every attempt is a finding: what is needed to see it again is kept.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <signal.h>

#include <filesystem>
#include <fstream>

#include "tests/integration/campaign_driver.h"

namespace gauntlet::testing_support {
namespace {

using testing::HasSubstr;
using testing::StartsWith;

// Master, worker, fork server, runner: 0 when there is none now.
pid_t RunnerOf(pid_t master) {
  for (const pid_t worker : ChildrenOf(master)) {
    for (const pid_t fork_server : ChildrenOf(worker)) {
      for (const pid_t runner : ChildrenOf(fork_server)) return runner;
    }
  }
  return 0;
}

TEST(ReproductionBundle, IsLeftByARunThatCrashesInEveryAttempt) {
  const TemporaryDirectory scratch;
  const std::string dir = scratch / "c";
  std::ofstream(scratch / "empty.json") << R"({"obstacles": []})";
  // Long enough to be hit three times.
  const std::unique_ptr<Process> master =
      StartGauntlet({"evaluate", "foraging", "--case", scratch / "empty.json", "--set",
                     "scenario_parameters.time_limit=3600", "--workers", "1", "--dir", dir, "--quiet"},
                    // Sanitizers would make exits of the signals.
                    {"ASAN_OPTIONS=handle_segv=0", "TSAN_OPTIONS=handle_segv=0"});
  pid_t hit = 0;
  ASSERT_TRUE(Eventually(
      [&] {
        const pid_t runner = RunnerOf(master->pid());
        if (runner != 0 && runner != hit && kill(runner, SIGSEGV) == 0) hit = runner;
        return !master->Running();
      },
      kPatience));

  const nlohmann::json shown = Show(dir)["runs_without_result"];
  ASSERT_EQ(shown.size(), 1U) << shown;
  EXPECT_EQ(shown[0]["verdict"], "crashed");
  ASSERT_EQ(shown[0]["bundle"], "bundles/run-1");
  EXPECT_THAT(Gauntlet({"show", dir}).out, HasSubstr("again: " + dir + "/bundles/run-1/README.txt"));

  const std::string bundle = dir + "/bundles/run-1";
  const std::string readme = ReadFile(bundle + "/README.txt");
  EXPECT_THAT(readme, HasSubstr("crashed with signal 11"));
  EXPECT_THAT(readme, HasSubstr("golden hash   "));
  EXPECT_THAT(ReadFile(bundle + "/experiment.toml"), HasSubstr("time_limit = 3600"));
  EXPECT_EQ(ReadFile(bundle + "/case.json"),
            "{\n"
            "  \"name\": \"empty.json\",\n"
            "  \"side_x\": 6.0,\n"
            "  \"side_y\": 6.0,\n"
            "  \"wall_thickness\": 0.1,\n"
            "  \"obstacles\": []\n"
            "}\n");
  EXPECT_TRUE(std::filesystem::exists(bundle + "/stderr.txt"));

  // The logs of both sides name the run and the lease alike.
  const std::string log = ReadFile(dir + "/log/master.log");
  const std::string beginning = "runner-failure: run 1 crashed with signal 11 on worker ";
  const std::size_t failure = log.find(beginning);
  ASSERT_NE(failure, std::string::npos) << log;
  const std::size_t lease = log.find("(lease ", failure) + 7;
  const std::string fence = log.substr(lease, log.find(')', lease) - lease);
  EXPECT_THAT(fence, StartsWith("1000000"))
      << "a lease of the first master; the first one, unless a worker was lost";
  EXPECT_THAT(ReadFile(dir + "/log/worker-1.log"), HasSubstr("(run 1, lease " + fence + ")"));

  // Its command simulates the run: here it does not crash, because nobody hits it.
  const std::size_t begin = readme.find("gauntlet-worker --run-spec");
  ASSERT_NE(begin, std::string::npos);
  const std::string command = readme.substr(begin, readme.find('\n', begin) - begin);
  const std::string worker_folder = std::filesystem::path(WorkerPath()).parent_path();
  const ProcessResult again =
      RunProcess({"/bin/sh", "-c", "cd '" + bundle + "' && PATH='" + worker_folder + "':$PATH " + command});
  EXPECT_EQ(again.exit_code, 0) << again.err;
  EXPECT_GT(std::filesystem::file_size(bundle + "/result"), 100U);

  // A replay has every pose of this hour: 17 MB.
  const ProcessResult replay = Gauntlet({"replay", dir, "1"});
  EXPECT_EQ(replay.exit_code, 1) << replay.err << "what is stored is a crash, and this one does not crash";
}

}  // namespace
}  // namespace gauntlet::testing_support
