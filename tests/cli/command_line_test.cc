// Covers: cli/main.cc, cli/options/options.cc
#include "cli/command_line.h"

#include <csignal>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "cli/options/options.h"
#include "cli/options/stop_signal.h"
#include "tests/cli/command_line_fixture.h"

namespace gauntlet {
namespace {

using ::testing::HasSubstr;
using ::testing::IsEmpty;
using Json = nlohmann::json;

TEST_F(CommandLine, WorkersMustBeSensible) {
  EXPECT_EQ(Run({"evolve", "flocking", "--workers", "1024", "--dir", Path("c")}), kExitDone);
  EXPECT_EQ(campaigns_.workers, 1024);
  EXPECT_THAT(err_.str(), HasSubstr("warning: 1024 workers on "));
  EXPECT_EQ(Run({"evolve", "flocking", "--dir", Path("c")}), kExitDone);
  EXPECT_GE(campaigns_.workers, 1) << "by default the machine's cores";
}

TEST_F(CommandLine, SeedIsA64BitNumberOrRandom) {
  EXPECT_EQ(Run({"evolve", "flocking", "--seed", "18446744073709551615", "--dir", Path("c")}), kExitDone);
  EXPECT_EQ(campaigns_.experiment.seed, 18446744073709551615U);
  EXPECT_EQ(Run({"evolve", "flocking", "--dir", Path("c")}), kExitDone);
  EXPECT_EQ(campaigns_.experiment.seed, 1U);
}

TEST_F(CommandLine, RandomSeedIsDrawnAndPrinted) {
  EXPECT_EQ(Run({"evolve", "flocking", "--seed", "random", "--dir", Path("c")}), kExitDone);
  const std::uint64_t first = campaigns_.experiment.seed;
  EXPECT_THAT(err_.str(), HasSubstr("seed " + std::to_string(first)));
  EXPECT_EQ(Run({"evolve", "flocking", "--seed", "random", "--dir", Path("c")}), kExitDone);
  EXPECT_NE(campaigns_.experiment.seed, first);
}

TEST_F(CommandLine, SettingsReachTheExperiment) {
  EXPECT_EQ(Run({"evolve", "flocking", "--set", "search.crossover=uniform", "--set",
                 "search.mutation_probability=0.2", "--generations", "7", "--population", "12", "--workers",
                 "3", "--dir", Path("c")}),
            kExitDone);
  EXPECT_EQ(campaigns_.experiment.search.crossover, CrossoverKind::kUniform);
  EXPECT_EQ(campaigns_.experiment.search.mutation_probability, 0.2);
  EXPECT_EQ(campaigns_.experiment.search.generations, 7);
  EXPECT_EQ(campaigns_.experiment.search.population, 12);
  EXPECT_EQ(campaigns_.directory, Path("c"));
}

TEST_F(CommandLine, SearchWithoutAnyResultExitsOne) {
  SearchSummary& search = campaigns_.report.summary.searches[0];
  search.runs_done = search.runs_failed = 8;
  static_cast<SearchTally&>(campaigns_.report.summary) = search;
  search.runs_without_result = {{sim::Verdict::kRefused, "no-path", "no-path: walled in", 8}};
  EXPECT_EQ(Run({"evolve", "flocking", "--dir", Path("c")}), kExitNegative);
  EXPECT_EQ(Messages(),
            "gauntlet: 100 runs in 4.0 s (25.0/s; master 0 us of CPU per run)\n"
            "gauntlet: none of the 8 runs gave a result, most often: no-path: walled in\n");
  ExpectText("command_line_search_without_any_result_exits_one", out_.str());
  campaigns_.report.summary.runs_failed = search.runs_failed = 7;
  search.runs_without_result[0].runs = 7;
  EXPECT_EQ(Run({"evolve", "flocking", "--dir", Path("d")}), kExitDone);
  ExpectText("command_line_search_without_any_result_exits_one_2", out_.str());
}

TEST_F(CommandLine, RandomSearchesAtRandom) {
  EXPECT_EQ(Run({"random", "flocking", "--cases", "33", "--dir", Path("c")}), kExitDone);
  EXPECT_EQ(campaigns_.experiment.search.algorithm, "random");
  EXPECT_EQ(campaigns_.experiment.search.parameters.at("cases"), 33.0);
}

TEST_F(CommandLine, DirectoryThatHoldsSomethingIsRefusedNamingResume) {
  Write("campaign.db", "precious");
  ExpectUsageError({"evolve", "flocking", "--dir", directory_.string()},
                   "gauntlet: " + directory_.string() +
                       " holds a campaign already; go on with it by `gauntlet resume " + directory_.string() +
                       "`, or choose another directory\n");
  ExpectUsageError({"evolve", "flocking", "--dir", Path("campaign.db")},
                   "gauntlet: " + Path("campaign.db") + " is a file; a campaign needs a directory\n");
  EXPECT_EQ(Read(Path("campaign.db")), "precious");
}

TEST_F(CommandLine, JsonIsExactlyOneDocument) {
  EXPECT_EQ(Run({"evolve", "flocking", "--json", "--dir", Path("c")}), kExitDone);
  EXPECT_EQ(Json::parse(out_.str()).at("experiment"), "flocking");
  EXPECT_EQ(Run({"show", "c", "--json"}), kExitDone);
  EXPECT_EQ(Json::parse(out_.str()).at("directory"), "c");
}

TEST_F(CommandLine, ProgressGoesToStandardErrorAndCanBeSilenced) {
  campaigns_.during = [](const SessionOptions& options) {
    CampaignProgress progress;
    progress.runs_done = 7;
    options.on_progress(progress);
  };
  EXPECT_EQ(Run({"evolve", "flocking", "--dir", Path("c")}), kExitDone);
  EXPECT_EQ(Messages(),
            "runs 7 (0.0/s), best 0.000, mean 0.000, total failures 0, workers 0 (0 busy)\n"
            "gauntlet: 100 runs in 4.0 s (25.0/s; master 0 us of CPU per run)\n");
  ExpectText("command_line_progress_goes_to_standard_error_and_can_be_silenced", out_.str());
  EXPECT_EQ(Run({"evolve", "flocking", "--no-progress", "--dir", Path("c")}), kExitDone);
  EXPECT_EQ(Messages(), "gauntlet: 100 runs in 4.0 s (25.0/s; master 0 us of CPU per run)\n");
  EXPECT_EQ(Run({"evolve", "flocking", "--quiet", "--dir", Path("c")}), kExitDone);
  EXPECT_THAT(err_.str(), IsEmpty());
}

TEST_F(CommandLine, StoppedCampaignExitsThreeAndSaysHowToGoOn) {
  campaigns_.report.end = CampaignEnd::kStopped;
  campaigns_.report.summary.finished = false;
  campaigns_.report.summary.runs_done = campaigns_.report.summary.searches[0].runs_done = 1234;
  EXPECT_EQ(Run({"evolve", "flocking", "--dir", Path("c")}), kExitStopped);
  EXPECT_EQ(Messages(),
            "gauntlet: 100 runs in 4.0 s (25.0/s; master 0 us of CPU per run)\n"
            "gauntlet: stopped after 1,234 runs, all of them stored. Go on with: gauntlet resume " +
                Path("c") + "\n");
  ExpectText("command_line_stopped_campaign_exits_three_and_says_how_to_go_on", out_.str());
}

TEST_F(CommandLine, FirstSignalAsksTheCampaignToStop) {
  bool before = true;
  bool after = false;
  campaigns_.during = [&](const SessionOptions& options) {
    before = options.stop_requested();
    std::raise(SIGTERM);
    after = options.stop_requested();
  };
  EXPECT_EQ(Run({"evolve", "flocking", "--dir", Path("c")}), kExitDone);
  EXPECT_FALSE(before);
  EXPECT_TRUE(after);
}

TEST(StopSignalDeathTest, SecondSignalEndsAtOnce) {
  EXPECT_EXIT(
      {
        const StopSignal handlers;
        std::raise(SIGINT);
        std::raise(SIGINT);
      },
      ::testing::ExitedWithCode(3), "stopping cleanly");
}

TEST_F(CommandLine, ErrorsExitByTheirKind) {
  struct Expectation {
    ErrorKind kind;
    bool began;
    ExitCode code;
  };
  for (const Expectation& expected : {Expectation{ErrorKind::kInvalidInput, false, kExitUsage},
                                      {ErrorKind::kVersion, false, kExitUsage},
                                      {ErrorKind::kCorrupt, false, kExitUsage},
                                      {ErrorKind::kInUse, false, kExitUsage},
                                      {ErrorKind::kInUse, true, kExitStopped},
                                      {ErrorKind::kIo, true, kExitStopped},
                                      {ErrorKind::kNoSpace, false, kExitStopped},
                                      {ErrorKind::kInternal, true, kExitInternal}}) {
    campaigns_.error = Error{expected.kind, "what went wrong"};
    campaigns_.during = [&](const SessionOptions& options) {
      if (!expected.began) return;
      std::filesystem::create_directories(Path("c"));
      std::ofstream(Path("c") + "/campaign.db") << "made";
      options.on_progress({});
    };
    EXPECT_EQ(Run({"evolve", "flocking", "--dir", Path("c")}), expected.code)
        << static_cast<int>(expected.kind);
    EXPECT_THAT(err_.str(), HasSubstr("gauntlet: what went wrong\n"));
    const bool stopped = expected.code == kExitStopped;
    EXPECT_EQ(err_.str().find("gauntlet resume " + Path("c")) != std::string::npos,
              stopped && expected.began);
    EXPECT_EQ(err_.str().find("the same command with --dir " + Path("c")) != std::string::npos,
              stopped && !expected.began);
    std::filesystem::remove_all(Path("c"));
    EXPECT_THAT(out_.str(), IsEmpty());
  }
}

TEST_F(CommandLine, ResumeAndShowPassErrorsOn) {
  campaigns_.error = Error{ErrorKind::kInUse, "d is in use by gauntlet on host node7, process 4711"};
  EXPECT_EQ(Run({"resume", "d"}), kExitUsage);
  EXPECT_EQ(err_.str(), "gauntlet: d is in use by gauntlet on host node7, process 4711\n");
  EXPECT_EQ(Run({"show", "d"}), kExitUsage);
  EXPECT_EQ(err_.str(), "gauntlet: d is in use by gauntlet on host node7, process 4711\n");
}

TEST_F(CommandLine, ResumeOfAFinishedCampaignSaysSo) {
  campaigns_.report.runs_this_session = 0;
  EXPECT_EQ(Run({"resume", "d", "--workers", "5"}), kExitDone);
  EXPECT_EQ(campaigns_.workers, 5);
  EXPECT_EQ(campaigns_.directory, "d");
  EXPECT_EQ(err_.str(), "gauntlet: d is finished, nothing was left to do\n");
}

TEST(DefaultDirectory, NamesExperimentAndUtcTime) {
  EXPECT_EQ(DefaultDirectory("flocking", 1769903999), "campaigns/flocking-20260131T235959Z");
}

}  // namespace
}  // namespace gauntlet
