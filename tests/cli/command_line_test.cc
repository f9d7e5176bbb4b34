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

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::MatchesRegex;
using ::testing::Not;
using Json = nlohmann::json;

TEST_F(CommandLine, VersionAndHelpAreResults) {
  EXPECT_EQ(Run({"--version"}), kExitDone);
  EXPECT_THAT(out_.str(), MatchesRegex("gauntlet [0-9]+\\.[0-9]+\\.[0-9]+\n"));
  EXPECT_EQ(Run({"--help"}), kExitDone);
  for (const char* command : {"evolve", "random", "evaluate", "resume", "show", "replay", "compare", "list",
                              "master", "status", "watch", "stop", "submit"}) {
    EXPECT_THAT(out_.str(), HasSubstr(command));
    CommandLine::Run({command, "--help"});
    EXPECT_THAT(out_.str(), HasSubstr("gauntlet " + std::string(command))) << "an example";
    EXPECT_EQ(Run({"--help"}), kExitDone);
  }
  EXPECT_THAT(err_.str(), IsEmpty());
}

TEST_F(CommandLine, WrongCommandsAndOptionsAreRefusedWithTheNearestKnown) {
  ExpectUsageError({}, HasSubstr("which command? One of evolve, random, evaluate"));
  ExpectUsageError({"evlove", "flocking"}, HasSubstr("unknown command 'evlove'; did you mean 'evolve'?"));
  ExpectUsageError({"xyz"}, HasSubstr("unknown command 'xyz'; there are evolve, random"));
  ExpectUsageError({"evolve"},
                   AllOf(HasSubstr("evolve: EXPERIMENT is required"), HasSubstr("gauntlet evolve --help")));
  ExpectUsageError({"evolve", "flocking", "--wokers", "2"},
                   HasSubstr("evolve: unknown option --wokers; did you mean '--workers'?"));
  ExpectUsageError({"evolve", "flocking", "foraging"}, HasSubstr("unexpected argument 'foraging'"));
  ExpectUsageError({"replay", "dir"}, HasSubstr("RUN_ID is required"));
  ExpectUsageError({"list", "swarms"}, HasSubstr("swarms"));
}

TEST_F(CommandLine, UnknownExperimentNamesTheNearest) {
  ExpectUsageError({"evolve", "floking"}, HasSubstr("flocking"));
}

TEST_F(CommandLine, WorkersMustBeSensible) {
  for (const char* workers : {"0", "1025", "-1", "two", "1e3"}) {
    ExpectUsageError(
        {"evolve", "flocking", std::string("--workers=") + workers},
        AllOf(HasSubstr(std::string("--workers ") + workers + ": must be a whole number from 1 to 1024"),
              HasSubstr("this machine has")));
  }
  EXPECT_EQ(Run({"evolve", "flocking", "--workers", "1024", "--dir", Path("c")}), kExitDone);
  EXPECT_EQ(campaigns_.workers, 1024);
  EXPECT_THAT(err_.str(), HasSubstr("warning: 1024 workers on "));
  EXPECT_EQ(Run({"evolve", "flocking", "--dir", Path("c")}), kExitDone);
  EXPECT_GE(campaigns_.workers, 1) << "by default the machine's cores";
}

TEST_F(CommandLine, SeedIsA64BitNumberOrRandom) {
  for (const char* seed : {"-1", "18446744073709551616", "0x10", "abc", "1.5"}) {
    ExpectUsageError({"evolve", "flocking", std::string("--seed=") + seed},
                     HasSubstr(std::string("--seed ") + seed + ": must be a whole number from 0 to"));
  }
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
  EXPECT_THAT(err_.str(),
              HasSubstr("flocking: genetic search, 12 test cases x 7 generations, seed 1, 3 workers, in "));
  EXPECT_EQ(Run({"evolve", "flocking", "--generations", "1", "--dir", Path("d")}), kExitDone);
  EXPECT_THAT(err_.str(), HasSubstr("x 1 generation, seed"));
}

TEST_F(CommandLine, BadSettingsNameTheOptionThatWasTyped) {
  ExpectUsageError({"evolve", "flocking", "--set", "search.populaton=12"}, HasSubstr("search.population"));
  ExpectUsageError({"evolve", "flocking", "--set", "search.mutation_probability=1.5"},
                   AllOf(HasSubstr("--set search.mutation_probability=1.5"), HasSubstr("0 to 1")));
  ExpectUsageError({"evolve", "flocking", "--generations", "0"},
                   AllOf(HasSubstr("--generations 0"), Not(HasSubstr("--set"))));
  ExpectUsageError({"evolve", "flocking", "--population", "11"}, HasSubstr("even"));
  ExpectUsageError({"random", "flocking", "--cases", "none"}, HasSubstr("--cases none"));
}

TEST_F(CommandLine, EmptyValuesAreNotDefaults) {
  for (const std::string option :
       {"--generations", "--population", "--seed", "--workers", "--dir", "--set"}) {
    ExpectUsageError({"evolve", "flocking", option, ""}, HasSubstr(option));
    ExpectUsageError({"evolve", "flocking", option + "="}, HasSubstr(option));
  }
  ExpectUsageError({"random", "flocking", "--cases", ""}, HasSubstr("--cases"));
  ExpectUsageError({"evaluate", "flocking", "--case", ""}, HasSubstr("--case"));
  ExpectUsageError({"replay", "d", "1", "--svg", ""}, HasSubstr("--svg"));
  ExpectUsageError({"show", ""}, HasSubstr("DIR"));
}

TEST_F(CommandLine, OptionsOfAnotherSearchAreRefused) {
  ExpectUsageError({"random", "flocking", "--generations", "3"},
                   AllOf(HasSubstr("--generations 3"), HasSubstr("--cases")));
  ExpectUsageError({"random", "flocking", "--population", "4"},
                   AllOf(HasSubstr("--population 4"), HasSubstr("--cases")));
  ExpectUsageError({"evolve", "flocking", "--set", "search.algorithm=random", "--generations", "3"},
                   AllOf(HasSubstr("--generations 3"), HasSubstr("search.cases")));
  ExpectUsageError({"evolve", "flocking", "--generations", "1", "--set", "search.generations=1e3"},
                   HasSubstr("--set search.generations=1e3: "));
  ExpectUsageError({"random", "flocking", "--set", "search.crossover=uniform"},
                   AllOf(HasSubstr("--set search.crossover=uniform"), HasSubstr("search.cases")));
  ExpectUsageError({"evolve", "flocking", "--set", "search.lag=5"},
                   AllOf(HasSubstr("--set search.lag=5"), HasSubstr("'genetic' does not read search.lag")));
  ExpectUsageError({"evolve", "flocking", "--set", "search.mode=steady-state"},
                   AllOf(HasSubstr("search.mode"), HasSubstr("search.algorithm = \"steady-state\"")));
}

TEST_F(CommandLine, HelpOffersNoOptionThatTheCommandRefuses) {
  ExpectUsageError({"evaluate", "flocking", "--case", "a.json", "--population", "4"},
                   AllOf(HasSubstr("--population 4"), HasSubstr("--replicates")));
  for (const char* command : {"random", "evaluate"}) {
    ExpectUsageError({command, "flocking", "--case", "a.json", "--populatio", "4"},
                     AllOf(HasSubstr("unknown option --"), Not(HasSubstr("'--population'"))));
    EXPECT_EQ(Run({command, "--help"}), kExitDone);
    EXPECT_THAT(out_.str(), AllOf(Not(HasSubstr("--generations")), Not(HasSubstr("--population")),
                                  HasSubstr("--workers")));
  }
}

TEST_F(CommandLine, OptionsThatContradictEachOtherAreRefused) {
  ExpectUsageError({"evolve", "flocking", "--generations", "3", "--set", "search.generations=4"},
                   AllOf(HasSubstr("--set search.generations=4"), HasSubstr("--generations already says")));
}

TEST_F(CommandLine, HelpIsACommandToo) {
  EXPECT_EQ(Run({"help"}), kExitDone);
  const std::string help = out_.str();
  EXPECT_EQ(Run({"--help"}), kExitDone);
  EXPECT_EQ(help, out_.str());
  EXPECT_EQ(Run({"help", "evolve"}), kExitDone);
  EXPECT_THAT(out_.str(), HasSubstr("--generations"));
}

TEST_F(CommandLine, ControlCharactersOfNamesDoNotReachTheTerminal) {
  EXPECT_EQ(Run({"evaluate", "flocking", "--case", "a\nb\x1b[31m.json", "--dir", Path("c")}), kExitUsage);
  EXPECT_THAT(out_.str() + err_.str(), AllOf(HasSubstr("a\\nb\\x1b[31m.json"), Not(HasSubstr("\x1b"))));
}

TEST_F(CommandLine, SearchWithoutAnyResultExitsOne) {
  campaigns_.report.summary.runs_done = campaigns_.report.summary.runs_failed = 8;
  campaigns_.report.summary.runs_without_result = {
      {sim::Verdict::kRefused, "no-path", "no-path: walled in", 8}};
  EXPECT_EQ(Run({"evolve", "flocking", "--dir", Path("c")}), kExitNegative);
  EXPECT_THAT(err_.str(), HasSubstr("none of the 8 runs gave a result, most often: no-path: walled in"));
  EXPECT_THAT(out_.str(),
              AllOf(HasSubstr("NO RUN GAVE A RESULT"), HasSubstr("8 of 8 refused: no-path: walled in")));
  campaigns_.report.summary.runs_failed = 7;
  campaigns_.report.summary.runs_without_result[0].runs = 7;
  EXPECT_EQ(Run({"evolve", "flocking", "--dir", Path("d")}), kExitDone);
  EXPECT_THAT(out_.str(), HasSubstr("7 of 8 refused: no-path: walled in"));
}

TEST_F(CommandLine, RandomSearchesAtRandom) {
  EXPECT_EQ(Run({"random", "flocking", "--cases", "33", "--dir", Path("c")}), kExitDone);
  EXPECT_EQ(campaigns_.experiment.search.algorithm, "random");
  EXPECT_EQ(campaigns_.experiment.search.parameters.at("cases"), 33.0);
}

TEST_F(CommandLine, DirectoryThatHoldsSomethingIsRefusedNamingResume) {
  Write("campaign.db", "precious");
  ExpectUsageError(
      {"evolve", "flocking", "--dir", directory_.string()},
      HasSubstr("holds a campaign already; go on with it by `gauntlet resume " + directory_.string()));
  ExpectUsageError({"evolve", "flocking", "--dir", Path("campaign.db")}, HasSubstr("is a file"));
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
  EXPECT_THAT(err_.str(), AllOf(HasSubstr("runs 7"), HasSubstr("100 runs in 4.0 s (25.0/s")));
  EXPECT_THAT(out_.str(), Not(HasSubstr("runs 7")));
  EXPECT_EQ(Run({"evolve", "flocking", "--no-progress", "--dir", Path("c")}), kExitDone);
  EXPECT_THAT(err_.str(), AllOf(Not(HasSubstr("runs 7")), HasSubstr("100 runs in")));
  EXPECT_EQ(Run({"evolve", "flocking", "--quiet", "--dir", Path("c")}), kExitDone);
  EXPECT_THAT(err_.str(), IsEmpty());
}

TEST_F(CommandLine, StoppedCampaignExitsThreeAndSaysHowToGoOn) {
  campaigns_.report.end = CampaignEnd::kStopped;
  campaigns_.report.summary.finished = false;
  campaigns_.report.summary.runs_done = 1234;
  EXPECT_EQ(Run({"evolve", "flocking", "--dir", Path("c")}), kExitStopped);
  EXPECT_THAT(
      err_.str(),
      HasSubstr("stopped after 1,234 runs, all of them stored. Go on with: gauntlet resume " + Path("c")));
  EXPECT_THAT(out_.str(), HasSubstr("not finished"));
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
  EXPECT_THAT(err_.str(), HasSubstr("host node7, process 4711"));
  EXPECT_EQ(Run({"show", "d"}), kExitUsage);
  EXPECT_THAT(err_.str(), HasSubstr("host node7, process 4711"));
}

TEST_F(CommandLine, ResumeOfAFinishedCampaignSaysSo) {
  campaigns_.report.runs_this_session = 0;
  EXPECT_EQ(Run({"resume", "d", "--workers", "5"}), kExitDone);
  EXPECT_EQ(campaigns_.workers, 5);
  EXPECT_EQ(campaigns_.directory, "d");
  EXPECT_THAT(err_.str(), HasSubstr("d is finished, nothing was left to do"));
}

TEST(DefaultDirectory, NamesExperimentAndUtcTime) {
  EXPECT_EQ(DefaultDirectory("flocking", 1769903999), "campaigns/flocking-20260131T235959Z");
}

}  // namespace
}  // namespace gauntlet
