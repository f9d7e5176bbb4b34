// An examination has the same answer for any number of workers, and goes on after its process was killed.
// Covers: cli/commands/examine_command.cc, cli/output/examination_output.cc
#include <gtest/gtest.h>

#include <csignal>
#include <filesystem>

#include "tests/integration/campaign_driver.h"
#include "tests/support/sanitizer.h"

namespace gauntlet::testing_support {
namespace {

std::vector<std::string> Examine(const std::string& dir, const std::string& workers) {
  return {"examine",     "flocking",  "--budget",
          "1400",        "--set",     kSanitized ? "scenario_parameters.time_limit=5" : "seed=3",
          "--dir",       dir,         "--out",
          dir + ".html", "--workers", workers,
          "--quiet",     "--json"};
}

// What is told, without the names of directories.
nlohmann::json Told(const ProcessResult& result) {
  EXPECT_EQ(result.exit_code, 0) << result.err;
  nlohmann::json told = nlohmann::json::parse(result.out, nullptr, /*allow_exceptions=*/false);
  for (const char* of_directory : {"directory", "report"}) told.erase(of_directory);
  for (nlohmann::json& one : told["distinct"]) one.erase("example");
  for (nlohmann::json& one : told["distinct"]) one.erase("smallest");
  for (nlohmann::json& one : told["smallest"]) one.erase("file");
  return told;
}

TEST(ExamineTest, IsAlikeForAnyNumberOfWorkersAndAfterAKill) {
  const TemporaryDirectory scratch;
  const nlohmann::json one = Told(Gauntlet(Examine(scratch / "one", "1")));
  EXPECT_EQ(one["baseline"]["random"]["n"], 55);
  EXPECT_FALSE(one["margins"].empty());
  EXPECT_EQ(Told(Gauntlet(Examine(scratch / "three", "3"))), one);
  const auto examining =
      StartGauntlet(Examine(scratch / "killed", "2"),
                    {"GAUNTLET_WORKER=" + WorkerPath() + "-slow", "GAUNTLET_TEST_RUN_MILLISECONDS=5"});
  EXPECT_TRUE(Eventually(
      [&] { return !examining->Running() || std::filesystem::exists(scratch / "killed/search/status.json"); },
      kPatience));
  EXPECT_TRUE(examining->Running()) << "there was nothing to kill";
  examining->Signal(SIGKILL);
  examining->Wait();
  EXPECT_EQ(Told(Gauntlet(Examine(scratch / "killed", "2"))), one);
  EXPECT_TRUE(std::filesystem::exists(scratch / "killed.html"));
}

}  // namespace
}  // namespace gauntlet::testing_support
