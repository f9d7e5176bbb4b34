// `gauntlet master --resume` with the settings of the command that began the campaign, and with others.
// Covers: master/campaign/stored_campaign.cc
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <csignal>

#include "tests/integration/campaign_driver.h"

namespace gauntlet::testing_support {
namespace {

TEST(MasterResumeTest, OnlyTheLengthMayBeOtherThanWhatTheCampaignWasBegunWith) {
  const TemporaryDirectory scratch;
  const std::string dir = scratch / "c";
  const std::vector<std::string> settings = {"--dir",         dir, "--set",  "search.population=6",
                                             "--generations", "2", "--quiet"};
  std::vector<std::string> evolve = {"evolve", "flocking"};
  evolve.insert(evolve.end(), settings.begin(), settings.end());
  ASSERT_EQ(Gauntlet(evolve).exit_code, 0);

  const auto resume = [&](const std::vector<std::string>& options) {
    std::vector<std::string> command = {"master", "flocking", "--bind",  "tcp://127.0.0.1:*",
                                        "--dir",  dir,        "--resume"};
    command.insert(command.end(), options.begin(), options.end());
    return command;
  };
  EXPECT_EQ(Gauntlet(resume({})).exit_code, 0);
  EXPECT_EQ(Gauntlet(resume({"--set", "search.population=6", "--generations", "2", "--seed", "1"})).exit_code,
            0);

  const auto refusal = [&](const std::vector<std::string>& options) {
    const ProcessResult result = Gauntlet(resume(options));
    EXPECT_EQ(result.exit_code, 2);
    return result.err;
  };
  EXPECT_EQ(refusal({"--population", "8"}), "gauntlet: --resume: " + (scratch / "c") +
                                                " was not begun with search.population=8; only its length "
                                                "may change: leave that out, or name another --dir\n");
  EXPECT_EQ(refusal({"--set", "controller=flocking-improved"}),
            "gauntlet: --resume: " + (scratch / "c") +
                " was not begun with controller=flocking-improved; only its length may change: leave that "
                "out, or name another --dir\n");
  EXPECT_EQ(refusal({"--seed", "2"}), "gauntlet: --resume: " + (scratch / "c") +
                                          " was not begun with --seed 2; only its length may change: leave "
                                          "that out, or name another --dir\n");
  EXPECT_EQ(
      refusal({"--generations", "1"}),
      "gauntlet: --generations 1: the campaign has search.generations = 2, and can be made longer only\n");

  const std::unique_ptr<Process> longer = StartGauntlet(resume({"--generations", "3"}));
  const auto is_longer = [&] {
    return ReadFile(dir + "/experiment.toml").find("generations = 3") != std::string::npos;
  };
  EXPECT_TRUE(Eventually(is_longer, std::chrono::seconds(30)));
  longer->Signal(SIGKILL);
  longer->Wait();
}

}  // namespace
}  // namespace gauntlet::testing_support
