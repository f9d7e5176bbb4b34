// A search over settings has the same answer for any number of workers, and after its processes were killed.
// Covers: cli/commands/margin_command.cc, cli/commands/repair_command.cc,
// cli/commands/probability_command.cc
#include <gtest/gtest.h>

#include <csignal>
#include <filesystem>

#include "tests/integration/campaign_driver.h"
#include "tests/support/sanitizer.h"

namespace gauntlet::testing_support {
namespace {

struct SettingsCommand {
  std::string name;
  std::vector<std::string> options;  // "FAILING" stands for a campaign with failing cases
};

class SettingsSearchTest : public testing::TestWithParam<SettingsCommand> {
 protected:
  void SetUp() override {
    std::vector<std::string> random = {"random", "flocking",           "--cases", "40",
                                       "--dir",  scratch_ / "failing", "--quiet"};
    if (kSanitized) random.insert(random.end(), {"--set", kShort});
    ASSERT_EQ(Gauntlet(random).exit_code, 0);
  }

  std::vector<std::string> Command(const std::string& dir, const std::string& workers) const {
    std::vector<std::string> command = {GetParam().name, "flocking", "--set", kSanitized ? kShort : "seed=3"};
    for (const std::string& option : GetParam().options)
      command.push_back(option == "FAILING" ? scratch_ / "failing" : option);
    command.insert(command.end(), {"--dir", scratch_ / dir, "--workers", workers, "--quiet"});
    return command;
  }
  // What is told, without the name of the directory.
  nlohmann::json Told(const std::string& dir) const {
    const ProcessResult result = Gauntlet({GetParam().name, scratch_ / dir, "--json"});
    EXPECT_LE(result.exit_code, 1) << result.err;
    nlohmann::json told = nlohmann::json::parse(result.out, nullptr, /*allow_exceptions=*/false);
    told.erase("directory");
    return told;
  }

  static constexpr const char* kShort = "scenario_parameters.time_limit=5";
  TemporaryDirectory scratch_;
};

TEST_P(SettingsSearchTest, IsAlikeForAnyNumberOfWorkersAndAfterAKill) {
  EXPECT_LE(Gauntlet(Command("one", "1")).exit_code, 1);
  EXPECT_LE(Gauntlet(Command("three", "3")).exit_code, 1);
  const auto master = StartGauntlet(Command("killed", "2"), {"GAUNTLET_WORKER=" + WorkerPath() + "-slow",
                                                             "GAUNTLET_TEST_RUN_MILLISECONDS=5"});
  EXPECT_TRUE(Eventually(
      [&] { return !master->Running() || std::filesystem::exists(scratch_ / "killed/status.json"); },
      kPatience));
  EXPECT_TRUE(master->Running()) << "there was nothing to kill";
  master->Signal(SIGKILL);
  master->Wait();
  EXPECT_EQ(Gauntlet({"resume", scratch_ / "killed", "--quiet"}).exit_code, 0);
  const nlohmann::json one = Told("one");
  EXPECT_TRUE(one["finished"].get<bool>());
  EXPECT_EQ(Told("three"), one);
  EXPECT_EQ(Gauntlet({"repair", "flocking", "--from", scratch_ / "one"}).exit_code, 2)
      << "its runs are of many settings";
  EXPECT_EQ(Told("killed"), one);
  EXPECT_EQ(StateHash(scratch_ / "killed"), StateHash(scratch_ / "one"));
}

INSTANTIATE_TEST_SUITE_P(
    All, SettingsSearchTest,
    testing::Values(SettingsCommand{"margin",
                                    {"--vary", "noise.omnidirectional_camera.drop=0..0.5", "--on",
                                     "random:30", "--budget", "400"}},
                    SettingsCommand{"repair",
                                    {"--from", "FAILING", "--parameters", "turning_speed_factor,turn_rate",
                                     "--budget", "150", "--random", "20", "--fresh", "40"}},
                    SettingsCommand{"probability",
                                    {"--vary", "noise.omnidirectional_camera.drop=0..0.5", "--budget", "400",
                                     "--within", "0"}}),
    [](const auto& info) { return info.param.name; });

}  // namespace
}  // namespace gauntlet::testing_support
