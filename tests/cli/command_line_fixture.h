// Runs command lines against a campaign that only notes what it is asked.
#pragma once

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "cli/command_line.h"
#include "tests/support/fake_campaigns.h"
#include "tests/support/golden.h"

namespace gauntlet {

class CommandLine : public ::testing::Test {
 protected:
  void SetUp() override {
    directory_ =
        std::filesystem::path(::testing::TempDir()) /
        (std::string("gauntlet-cli-") + ::testing::UnitTest::GetInstance()->current_test_info()->name());
    std::filesystem::remove_all(directory_);
    std::filesystem::create_directories(directory_);
    campaigns_.report.summary.experiment = "flocking";
    campaigns_.report.summary.searches.resize(1);
    campaigns_.report.summary.searches[0].search = "genetic";
    campaigns_.report.summary.finished = campaigns_.report.summary.searches[0].finished = true;
    campaigns_.report.runs_this_session = 100;
    campaigns_.report.wall_seconds = 4.0;
  }
  void TearDown() override { std::filesystem::remove_all(directory_); }

  ExitCode Run(const std::vector<std::string>& arguments) {
    out_.str("");
    err_.str("");
    CommandContext context{
        .out = out_, .err = err_, .err_is_terminal = err_is_terminal_, .campaigns = campaigns_};
    return RunCommandLine(arguments, context);
  }
  std::string Path(const std::string& name) const { return (directory_ / name).string(); }
  std::string Write(const std::string& name, const std::string& text) const {
    std::ofstream(directory_ / name, std::ios::binary) << text;
    return Path(name);
  }
  static std::string Read(const std::string& path) {
    std::ifstream stream(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
  }
  // Standard error behind its first line, which tells of the campaign that begins, and of this machine's
  // cores.
  std::string Messages() const { return err_.str().substr(err_.str().find('\n') + 1); }
  // Holds a text of several lines against tests/cli/texts/NAME.txt; the test's directory is <here> there.
  void ExpectText(const std::string& name, std::string text) const {
    const std::string here = directory_.string();
    for (std::size_t at = text.find(here); at != std::string::npos; at = text.find(here))
      text.replace(at, here.size(), "<here>");
    testing_support::ExpectGolden("tests/cli/texts/" + name + ".txt", text);
  }
  // Exit 2, one line on standard error, nothing on standard output, nothing started.
  void ExpectUsageError(const std::vector<std::string>& arguments,
                        const ::testing::Matcher<std::string>& message) {
    EXPECT_EQ(Run(arguments), kExitUsage);
    const std::string text = err_.str();
    EXPECT_THAT(text, ::testing::StartsWith("gauntlet: "));
    EXPECT_EQ(std::count(text.begin(), text.end(), '\n'), 1) << text;
    EXPECT_THAT(text, message);
    EXPECT_THAT(out_.str(), ::testing::IsEmpty());
    EXPECT_EQ(campaigns_.starts, 0);
  }

  std::filesystem::path directory_;
  std::ostringstream out_;
  std::ostringstream err_;
  bool err_is_terminal_ = false;
  testing_support::FakeCampaigns campaigns_;
};

}  // namespace gauntlet
