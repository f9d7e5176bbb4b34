// Runs command lines against a campaign that only notes what it is asked.
#pragma once

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <functional>
#include <optional>
#include <sstream>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "master/cli/command_line.h"

namespace gauntlet::master {

class CommandLine : public ::testing::Test {
 protected:
  void SetUp() override {
    directory_ =
        std::filesystem::path(::testing::TempDir()) /
        (std::string("gauntlet-cli-") + ::testing::UnitTest::GetInstance()->current_test_info()->name());
    std::filesystem::remove_all(directory_);
    std::filesystem::create_directories(directory_);
    report_.summary.experiment = "flocking";
    report_.summary.search = "genetic";
    report_.summary.finished = true;
    report_.runs_this_session = 100;
    report_.wall_seconds = 4.0;
  }
  void TearDown() override { std::filesystem::remove_all(directory_); }

  ExitCode Run(const std::vector<std::string>& arguments) {
    out_.str("");
    err_.str("");
    CommandContext context{
        .out = out_, .err = err_, .err_is_terminal = err_is_terminal_, .program = "gauntlet", .service = {}};
    context.service.start = [this](const std::string& directory, const Experiment& experiment,
                                   const std::vector<sim::TestCase>& cases,
                                   const SessionOptions& options) -> Result<SessionReport> {
      ++starts_;
      started_directory_ = directory;
      started_ = experiment;
      cases_ = cases;
      workers_ = options.workers;
      if (during_) during_(options);
      if (error_) return *error_;
      return report_;
    };
    context.service.resume = [this](const std::string& directory,
                                    const SessionOptions& options) -> Result<SessionReport> {
      ++resumes_;
      started_directory_ = directory;
      workers_ = options.workers;
      if (during_) during_(options);
      if (error_) return *error_;
      return report_;
    };
    context.service.status = [this](const std::string&) -> Result<std::string> {
      if (error_) return *error_;
      return status_;
    };
    context.service.lives = [this](const std::string&) -> Result<bool> { return lives_-- > 0; };
    context.service.stop = [this](const std::string& directory) -> Status {
      stopped_ = directory;
      return Ok{};
    };
    context.service.read = [this](const std::string&) -> Result<CampaignSummary> {
      if (error_) return *error_;
      return report_.summary;
    };
    context.service.for_each_run = [this](const std::string&,
                                          const std::function<void(const StoredRun&)>& visit) -> Status {
      std::for_each(stored_.begin(), stored_.end(), visit);
      return Ok{};
    };
    context.service.replay = [this](const std::string&, RunId run) -> Result<CampaignReplay> {
      if (error_) return *error_;
      replayed_run_ = run;
      return replay_;
    };
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
  // Exit 2, one line on standard error, nothing on standard output, nothing started.
  void ExpectUsageError(const std::vector<std::string>& arguments,
                        const ::testing::Matcher<std::string>& message) {
    EXPECT_EQ(Run(arguments), kExitUsage);
    const std::string text = err_.str();
    EXPECT_THAT(text, ::testing::StartsWith("gauntlet: "));
    EXPECT_EQ(std::count(text.begin(), text.end(), '\n'), 1) << text;
    EXPECT_THAT(text, message);
    EXPECT_THAT(out_.str(), ::testing::IsEmpty());
    EXPECT_EQ(starts_, 0);
  }

  std::filesystem::path directory_;
  std::ostringstream out_;
  std::ostringstream err_;
  bool err_is_terminal_ = false;
  int starts_ = 0;
  int resumes_ = 0;
  int lives_ = 0;  // how often a master is found alive
  std::string status_;
  std::string stopped_;
  std::string started_directory_;
  Experiment started_;
  std::vector<sim::TestCase> cases_;
  int workers_ = 0;
  std::function<void(const SessionOptions&)> during_;
  SessionReport report_;
  std::vector<StoredRun> stored_;
  CampaignReplay replay_;
  RunId replayed_run_ = 0;
  std::optional<Error> error_;
};

}  // namespace gauntlet::master
