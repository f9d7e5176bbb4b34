// A margin has the same answer for any number of workers, and after its processes were killed.
#include <gtest/gtest.h>

#include <csignal>
#include <filesystem>

#include "tests/integration/campaign_driver.h"
#include "tests/support/sanitizer.h"

namespace gauntlet::testing_support {
namespace {

std::vector<std::string> Margin(const std::string& dir, const std::string& workers) {
  return {"margin",    "flocking",
          "--vary",    "noise.omnidirectional_camera.drop=0..0.5",
          "--on",      "random:30",
          "--budget",  "400",
          "--set",     kSanitized ? "scenario_parameters.time_limit=5" : "seed=3",
          "--dir",     dir,
          "--workers", workers,
          "--quiet"};
}

// What is told, without the name of the directory.
nlohmann::json Told(const std::string& dir) {
  const ProcessResult result = Gauntlet({"margin", dir, "--json"});
  EXPECT_EQ(result.exit_code, 0) << result.err;
  nlohmann::json told = nlohmann::json::parse(result.out, nullptr, /*allow_exceptions=*/false);
  told.erase("directory");
  return told;
}

TEST(MarginTest, IsAlikeForAnyNumberOfWorkersAndAfterAKill) {
  const TemporaryDirectory scratch;
  EXPECT_EQ(Gauntlet(Margin(scratch / "one", "1")).exit_code, 0);
  EXPECT_EQ(Gauntlet(Margin(scratch / "three", "3")).exit_code, 0);
  const auto master =
      StartGauntlet(Margin(scratch / "killed", "2"),
                    {"GAUNTLET_WORKER=" + WorkerPath() + "-slow", "GAUNTLET_TEST_RUN_MILLISECONDS=5"});
  EXPECT_TRUE(Eventually(
      [&] { return !master->Running() || std::filesystem::exists(scratch / "killed/status.json"); },
      kPatience));
  EXPECT_TRUE(master->Running()) << "there was nothing to kill";
  master->Signal(SIGKILL);
  master->Wait();
  EXPECT_EQ(Gauntlet({"resume", scratch / "killed", "--quiet"}).exit_code, 0);
  const nlohmann::json one = Told(scratch / "one");
  EXPECT_EQ(Told(scratch / "three"), one);
  EXPECT_EQ(Told(scratch / "killed"), one);
  EXPECT_EQ(StateHash(scratch / "killed"), StateHash(scratch / "one"));
}

}  // namespace
}  // namespace gauntlet::testing_support
