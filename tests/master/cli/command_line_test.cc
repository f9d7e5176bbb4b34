#include "master/cli/command_line.h"

#include <algorithm>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <pugixml.hpp>

#include "master/cli/common_options.h"
#include "master/cli/stop_signal.h"
#include "master/dispatch/run_codec.h"

namespace gauntlet::master {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::MatchesRegex;
using ::testing::Not;
using ::testing::StartsWith;
using Json = nlohmann::json;

// Runs command lines against a campaign that only notes what it is asked.
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
        .out = out_, .err = err_, .err_is_terminal = false, .program = "gauntlet", .service = {}};
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
    EXPECT_THAT(text, StartsWith("gauntlet: "));
    EXPECT_EQ(std::count(text.begin(), text.end(), '\n'), 1) << text;
    EXPECT_THAT(text, message);
    EXPECT_THAT(out_.str(), IsEmpty());
    EXPECT_EQ(starts_, 0);
  }

  std::filesystem::path directory_;
  std::ostringstream out_;
  std::ostringstream err_;
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

TEST_F(CommandLine, VersionAndHelpAreResults) {
  EXPECT_EQ(Run({"--version"}), kExitDone);
  EXPECT_THAT(out_.str(), MatchesRegex("gauntlet [0-9]+\\.[0-9]+\\.[0-9]+\n"));
  EXPECT_EQ(Run({"--help"}), kExitDone);
  for (const char* command : {"evolve", "random", "evaluate", "resume", "show", "replay", "list", "master",
                              "status", "watch", "stop", "submit"}) {
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
  EXPECT_EQ(workers_, 1024);
  EXPECT_EQ(Run({"evolve", "flocking", "--dir", Path("c")}), kExitDone);
  EXPECT_GE(workers_, 1) << "by default the machine's cores";
}

TEST_F(CommandLine, SeedIsA64BitNumberOrRandom) {
  for (const char* seed : {"-1", "18446744073709551616", "0x10", "abc", "1.5"}) {
    ExpectUsageError({"evolve", "flocking", std::string("--seed=") + seed},
                     HasSubstr(std::string("--seed ") + seed + ": must be a whole number from 0 to"));
  }
  EXPECT_EQ(Run({"evolve", "flocking", "--seed", "18446744073709551615", "--dir", Path("c")}), kExitDone);
  EXPECT_EQ(started_.seed, 18446744073709551615U);
  EXPECT_EQ(Run({"evolve", "flocking", "--dir", Path("c")}), kExitDone);
  EXPECT_EQ(started_.seed, 1U);
}

TEST_F(CommandLine, RandomSeedIsDrawnAndPrinted) {
  EXPECT_EQ(Run({"evolve", "flocking", "--seed", "random", "--dir", Path("c")}), kExitDone);
  const std::uint64_t first = started_.seed;
  EXPECT_THAT(err_.str(), HasSubstr("seed " + std::to_string(first)));
  EXPECT_EQ(Run({"evolve", "flocking", "--seed", "random", "--dir", Path("c")}), kExitDone);
  EXPECT_NE(started_.seed, first);
}

TEST_F(CommandLine, SettingsReachTheExperiment) {
  EXPECT_EQ(Run({"evolve", "flocking", "--set", "search.crossover=uniform", "--set",
                 "search.mutation_probability=0.2", "--generations", "7", "--population", "12", "--workers",
                 "3", "--dir", Path("c")}),
            kExitDone);
  EXPECT_EQ(started_.search.crossover, CrossoverKind::kUniform);
  EXPECT_EQ(started_.search.mutation_probability, 0.2);
  EXPECT_EQ(started_.search.generations, 7);
  EXPECT_EQ(started_.search.population, 12);
  EXPECT_EQ(started_directory_, Path("c"));
  EXPECT_THAT(err_.str(),
              HasSubstr("flocking: genetic search, 12 test cases x 7 generations, seed 1, 3 workers, in "));
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
  report_.summary.runs_done = report_.summary.runs_failed = 8;
  report_.summary.runs_without_result = {{sim::Verdict::kRefused, "no-path", "no-path: walled in", 8}};
  EXPECT_EQ(Run({"evolve", "flocking", "--dir", Path("c")}), kExitNegative);
  EXPECT_THAT(err_.str(), HasSubstr("none of the 8 runs gave a result, most often: no-path: walled in"));
  EXPECT_THAT(out_.str(),
              AllOf(HasSubstr("NO RUN GAVE A RESULT"), HasSubstr("8 of 8 refused: no-path: walled in")));
  report_.summary.runs_failed = 7;
  report_.summary.runs_without_result[0].runs = 7;
  EXPECT_EQ(Run({"evolve", "flocking", "--dir", Path("d")}), kExitDone);
  EXPECT_THAT(out_.str(), HasSubstr("7 of 8 refused: no-path: walled in"));
}

TEST_F(CommandLine, RandomSearchesAtRandom) {
  EXPECT_EQ(Run({"random", "flocking", "--cases", "33", "--dir", Path("c")}), kExitDone);
  EXPECT_EQ(started_.search.kind, SearchKind::kRandom);
  EXPECT_EQ(started_.search.cases, 33);
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
  during_ = [](const SessionOptions& options) {
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
  report_.end = CampaignEnd::kStopped;
  report_.summary.finished = false;
  report_.summary.runs_done = 1234;
  EXPECT_EQ(Run({"evolve", "flocking", "--dir", Path("c")}), kExitStopped);
  EXPECT_THAT(
      err_.str(),
      HasSubstr("stopped after 1,234 runs, all of them stored. Go on with: gauntlet resume " + Path("c")));
  EXPECT_THAT(out_.str(), HasSubstr("not finished"));
}

TEST_F(CommandLine, FirstSignalAsksTheCampaignToStop) {
  bool before = true;
  bool after = false;
  during_ = [&](const SessionOptions& options) {
    before = options.stop_requested();
    std::raise(SIGTERM);
    after = options.stop_requested();
  };
  EXPECT_EQ(Run({"evolve", "flocking", "--dir", Path("c")}), kExitDone);
  EXPECT_FALSE(before);
  EXPECT_TRUE(after);
}

TEST_F(CommandLine, MasterStartsNoWorkersAndSaysWhereTheyConnect) {
  std::string bind;
  bool insecure = true;
  during_ = [&](const SessionOptions& options) {
    bind = options.bind;
    insecure = options.insecure;
    options.on_serving({{"tcp://10.0.0.7:5555"}, true});
  };
  EXPECT_EQ(Run({"master", "flocking", "--bind", "tcp://0.0.0.0:5555", "--dir", Path("c")}), kExitDone);
  EXPECT_EQ(workers_, 0);
  EXPECT_EQ(bind, "tcp://0.0.0.0:5555");
  EXPECT_FALSE(insecure);
  EXPECT_THAT(err_.str(), HasSubstr("workers connect to tcp://10.0.0.7:5555, encrypted; start them with: "
                                    "gauntlet-worker --dir " +
                                    Path("c")));
  EXPECT_THAT(err_.str(), Not(HasSubstr("INSECURE")));
}

TEST_F(CommandLine, PlaintextToTheOutsideIsSaidEvenWhenQuiet) {
  during_ = [](const SessionOptions& options) { options.on_serving({{"tcp://10.0.0.7:5555"}, false}); };
  EXPECT_EQ(
      Run({"master", "flocking", "--bind", "tcp://0.0.0.0:*", "--insecure", "--quiet", "--dir", Path("c")}),
      kExitDone);
  EXPECT_THAT(err_.str(), HasSubstr("INSECURE: whoever reaches tcp://10.0.0.7:5555"));
  EXPECT_EQ(Run({"master", "flocking", "--bind", "tcp://127.0.0.1:*", "--quiet", "--dir", Path("c")}),
            kExitDone);
  EXPECT_THAT(err_.str(), IsEmpty());
}

TEST_F(CommandLine, MasterResumesOnlyWhenThereIsACampaignAndItIsAskedTo) {
  const std::vector<std::string> arguments = {"master", "flocking",          "--bind",  "tcp://127.0.0.1:*",
                                              "--dir",  directory_.string(), "--resume"};
  EXPECT_EQ(Run(arguments), kExitDone);
  EXPECT_EQ(std::pair(starts_, resumes_), std::pair(1, 0));
  Write("campaign.db", "");
  EXPECT_EQ(Run(arguments), kExitDone);
  EXPECT_EQ(std::pair(starts_, resumes_), std::pair(1, 1));
  EXPECT_EQ(Run({arguments.begin(), arguments.end() - 1}), kExitUsage);
  EXPECT_THAT(err_.str(), HasSubstr("gauntlet resume"));
  EXPECT_EQ(Run({"resume", "c", "--bind", "tcp://127.0.0.1:*"}), kExitDone);
  EXPECT_EQ(workers_, 0);
  EXPECT_EQ(Run({"resume", "c", "--bind", "tcp://127.0.0.1:*", "--workers", "3"}), kExitDone);
  EXPECT_EQ(workers_, 3);
}

TEST_F(CommandLine, MasterNeedsAnEndpoint) {
  ExpectUsageError({"master", "flocking"}, HasSubstr("--bind"));
  ExpectUsageError({"master", "flocking", "--bind", "tcp://127.0.0.1:*", "--resume"}, HasSubstr("--dir"));
}

TEST_F(CommandLine, StatusShowsWhatRunsWhereAndWhyNothingDoes) {
  status_ = R"({"state": "running", "master": {"host": "n1", "pid": 7, "epoch": 2, "encrypted": true},
                "generation": 3, "generations": 50, "runs_done": 1234, "runs_running": 1, "runs_queued": 5,
                "runs_per_second": 12.5, "why_nothing_runs": null, "worker_list": [
                 {"worker": "ab@n2", "state": "running", "silent_seconds": 0.2,
                  "runs": [{"run": 812, "lease": 2, "seconds": 1.5}]},
                 {"worker": "cd@n3", "state": "idle", "silent_seconds": 0.4, "runs": []}]})";
  EXPECT_EQ(Run({"status", "c"}), kExitDone);
  EXPECT_THAT(out_.str(), AllOf(HasSubstr("master 7 on n1 (start number 2), encrypted"),
                                HasSubstr("generation 3/50, 1,234 runs done, 1 running, 5 waiting"),
                                HasSubstr("812 (1.5 s, lease 2)"), HasSubstr("idle")));
  EXPECT_EQ(Run({"status", "c", "--json"}), kExitDone);
  EXPECT_EQ(out_.str(), status_);
  status_ = R"({"state": "stopped", "master": null, "why_nothing_runs": "no master serves the campaign",
                "worker_list": []})";
  EXPECT_EQ(Run({"watch", "c"}), kExitDone) << "without a master it ends at once";
  EXPECT_THAT(out_.str(), AllOf(HasSubstr("c: stopped"), HasSubstr("nothing runs: no master serves")));
}

TEST_F(CommandLine, StopAsksAndWaitsForTheMasterToEnd) {
  EXPECT_EQ(Run({"stop", "c"}), kExitDone);
  EXPECT_THAT(err_.str(), HasSubstr("nothing to stop"));
  EXPECT_EQ(stopped_, "");
  lives_ = 3;
  EXPECT_EQ(Run({"stop", "c"}), kExitDone);
  EXPECT_EQ(stopped_, "c");
  EXPECT_THAT(err_.str(), HasSubstr("stopped"));
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
    error_ = Error{expected.kind, "what went wrong"};
    during_ = [&](const SessionOptions& options) {
      if (expected.began) options.on_progress({});
    };
    EXPECT_EQ(Run({"evolve", "flocking", "--dir", Path("c")}), expected.code)
        << static_cast<int>(expected.kind);
    EXPECT_THAT(err_.str(), HasSubstr("gauntlet: what went wrong\n"));
    const bool resumable = expected.code == kExitStopped;
    EXPECT_EQ(err_.str().find("gauntlet resume") != std::string::npos, resumable);
    EXPECT_THAT(out_.str(), IsEmpty());
  }
}

TEST_F(CommandLine, ResumeAndShowPassErrorsOn) {
  error_ = Error{ErrorKind::kInUse, "d is in use by gauntlet on host node7, process 4711"};
  EXPECT_EQ(Run({"resume", "d"}), kExitUsage);
  EXPECT_THAT(err_.str(), HasSubstr("host node7, process 4711"));
  EXPECT_EQ(Run({"show", "d"}), kExitUsage);
  EXPECT_THAT(err_.str(), HasSubstr("host node7, process 4711"));
}

TEST_F(CommandLine, ResumeOfAFinishedCampaignSaysSo) {
  report_.runs_this_session = 0;
  EXPECT_EQ(Run({"resume", "d", "--workers", "5"}), kExitDone);
  EXPECT_EQ(workers_, 5);
  EXPECT_EQ(started_directory_, "d");
  EXPECT_THAT(err_.str(), HasSubstr("d is finished, nothing was left to do"));
}

TEST_F(CommandLine, EvaluateRefusesByRuleAndSimulatesTheRest) {
  const std::string good =
      Write("good.json", R"({"obstacles": [{"x": 0, "y": 1.5, "length": 1, "width": 0.2}]})");
  const std::string blocked =
      Write("blocked.json", R"({"obstacles": [{"x": 2.5, "y": 2.5, "length": 1, "width": 0.4}]})");
  const std::string broken = Write("broken.json", "{\"obstacles\": [}");
  sim::RunResult result;
  result.fitness = 0.75;
  result.hash = HashOf(result);
  stored_.resize(2);
  for (std::size_t i = 0; i < 2; ++i) {
    stored_[i].id = i + 1;
    stored_[i].individual = 1;
    stored_[i].seed = 40 + i;
    stored_[i].result = EncodeRunResult(result);
  }
  EXPECT_EQ(Run({"evaluate", "flocking", "--case", blocked, good, broken, "--replicates", "2", "--json",
                 "--dir", Path("c")}),
            kExitDone);
  EXPECT_EQ(started_.search.kind, SearchKind::kCases);
  EXPECT_EQ(started_.search.replicates, 2);
  ASSERT_EQ(cases_.size(), 1U);
  EXPECT_EQ(cases_[0].name, "good.json");
  const Json cases = Json::parse(out_.str()).at("cases");
  ASSERT_EQ(cases.size(), 3U);
  EXPECT_EQ(cases[0].at("file"), blocked);
  EXPECT_EQ(cases[0].at("refused"), "start-blocked");
  EXPECT_TRUE(cases[0].at("fitness").is_null());
  EXPECT_EQ(cases[1].at("file"), good);
  EXPECT_EQ(cases[1].at("fitness"), 0.75);
  EXPECT_EQ(cases[1].at("runs").at(1).at("seed"), "41");
  EXPECT_TRUE(cases[2].at("refused").is_null());
  EXPECT_THAT(cases[2].at("error").get<std::string>(), HasSubstr("broken.json:1:"));
  EXPECT_THAT(err_.str(),
              AllOf(HasSubstr("blocked.json: refused, start-blocked: "), HasSubstr("broken.json:1:")));
}

TEST_F(CommandLine, NoticesOfManyFilesAreGivenOnce) {
  const std::string argos = R"(<argos-configuration><framework/><arena size="6,6,1"/></argos-configuration>)";
  const std::vector<std::string> files = {Write("a.argos", argos), Write("b.argos", argos),
                                          Write("c.argos", argos)};
  EXPECT_EQ(Run({"evaluate", "flocking", "--case", files[0], files[1], files[2], "--dir", Path("c")}),
            kExitUsage)
      << "the campaign of this test simulates nothing";
  const std::string text = err_.str();
  EXPECT_THAT(text, HasSubstr(files[0] + " and 2 more: 0 of 4 walls are in the file"));
  EXPECT_EQ(text.find("0 of 4 walls"), text.rfind("0 of 4 walls"));
}

TEST_F(CommandLine, EvaluateExitsTwoWhenNothingCouldBeSimulated) {
  const std::string blocked =
      Write("blocked.json", R"({"obstacles": [{"x": 2.5, "y": 2.5, "length": 1, "width": 0.4}]})");
  EXPECT_EQ(Run({"evaluate", "flocking", "--case", blocked, "none.json", "--json", "--dir", Path("c")}),
            kExitUsage);
  EXPECT_EQ(starts_, 0);
  const Json cases = Json::parse(out_.str()).at("cases");
  EXPECT_EQ(cases[0].at("refused"), "start-blocked");
  EXPECT_THAT(cases[1].at("error").get<std::string>(), HasSubstr("none.json: no such file"));
  EXPECT_FALSE(std::filesystem::exists(Path("c")));
}

class Replay : public CommandLine {
 protected:
  void SetUp() override {
    CommandLine::SetUp();
    replay_.experiment.name = "flocking";
    ReplayReport& report = replay_.report;
    report.stored.id = 12;
    report.stored.individual = 3;
    report.spec.scenario = "flocking";
    report.stored_result.fitness = report.replayed.fitness = 0.5;
    report.stored_result.hash = report.replayed.hash = 0x1234;
    report.replayed.trajectory = {{{0, 0, 0, 0}}, {{0.1, 0, 0, 1.0}}};
    report.replayed.robots.resize(1);
  }
};

TEST_F(Replay, ReproducedRunExitsZeroAndWritesItsFiles) {
  EXPECT_EQ(Run({"replay", "d", "12", "--svg", Path("r.svg"), "--csv", Path("r.csv")}), kExitDone);
  EXPECT_EQ(replayed_run_, 12U);
  EXPECT_THAT(out_.str(), AllOf(HasSubstr("run 12: reproduced"), HasSubstr("0000000000001234  (the same)")));
  pugi::xml_document svg;
  EXPECT_TRUE(svg.load_file(Path("r.svg").c_str()));
  EXPECT_THAT(Read(Path("r.csv")),
              StartsWith("tick,time_s,robot,x,y,heading,speed\n0,0.0,0,0,0,0,0\n1,0.1,0,0.1,"));
}

TEST_F(Replay, DifferenceExitsOneAndSaysWhatDiffers) {
  replay_.report.replayed.hash = 0x9999;
  replay_.report.differences = {"hash differs: stored 1234, replayed 9999", "fitness differs"};
  EXPECT_EQ(Run({"replay", "d", "12", "--svg", Path("r.svg")}), kExitNegative);
  EXPECT_THAT(out_.str(),
              AllOf(HasSubstr("NOT REPRODUCED"), HasSubstr("(DIFFERENT)"), HasSubstr("  fitness differs\n")));
  EXPECT_THAT(err_.str(), HasSubstr("run 12 of d was not reproduced: hash differs"));
  EXPECT_TRUE(std::filesystem::exists(Path("r.svg"))) << "the picture helps to see why";
}

TEST_F(Replay, DamagedRunExitsOne) {
  replay_.report.damage = "the stored spec of run 12 is damaged";
  EXPECT_EQ(Run({"replay", "d", "12"}), kExitNegative);
  EXPECT_THAT(err_.str(), HasSubstr("the stored spec of run 12 is damaged"));
  EXPECT_THAT(out_.str(), IsEmpty());
}

TEST_F(Replay, DamagedDatabaseExitsTwoBecauseNothingWasCompared) {
  error_ = Error{ErrorKind::kCorrupt, "campaign.db is damaged"};
  EXPECT_EQ(Run({"replay", "d", "12"}), kExitUsage);
}

TEST_F(Replay, RefusedRunIsReproducedWithItsRule) {
  replay_.report.stored_result.verdict = replay_.report.replayed.verdict = sim::Verdict::kRefused;
  replay_.report.replayed.message = "no-room-to-spawn: 3 of 100 robots placed";
  replay_.report.replayed.trajectory.clear();
  replay_.report.replayed.robots.clear();
  EXPECT_EQ(Run({"replay", "d", "12", "--svg", Path("r.svg")}), kExitDone);
  EXPECT_THAT(out_.str(), HasSubstr("no-room-to-spawn: 3 of 100 robots placed"));
  pugi::xml_document svg;
  EXPECT_TRUE(svg.load_file(Path("r.svg").c_str()));
}

TEST_F(Replay, OneFileForTwoOutputsIsRefused) {
  ExpectUsageError({"replay", "d", "12", "--svg", Path("a"), "--csv", Path("./a")},
                   AllOf(HasSubstr("--svg"), HasSubstr("--csv")));
  EXPECT_FALSE(std::filesystem::exists(Path("a")));
}

TEST_F(Replay, BadRunIdsAndFilesAreUsageErrors) {
  ExpectUsageError({"replay", "d", "twelve"}, HasSubstr("twelve is no run"));
  ExpectUsageError({"replay", "d", "0"}, HasSubstr("0 is no run"));
  EXPECT_EQ(Run({"replay", "d", "12", "--svg", Path("none/r.svg")}), kExitUsage);
  EXPECT_THAT(err_.str(), HasSubstr("none/r.svg: cannot be written: No such file or directory"));
}

TEST_F(CommandLine, ListNamesEverythingWithUnitsDefaultsAndRanges) {
  EXPECT_EQ(Run({"list", "--json"}), kExitDone);
  const Json json = Json::parse(out_.str());
  ASSERT_FALSE(json.at("experiments").empty());
  EXPECT_TRUE(std::any_of(json.at("experiments").begin(), json.at("experiments").end(),
                          [](const Json& e) { return e.at("name") == "flocking"; }));
  for (const char* section : {"scenarios", "controllers"}) {
    for (const Json& entry : json.at(section)) {
      for (const Json& parameter : entry.at("parameters")) {
        EXPECT_LE(parameter.at("min"), parameter.at("default")) << parameter;
        EXPECT_GE(parameter.at("max"), parameter.at("default")) << parameter;
        EXPECT_TRUE(parameter.contains("unit"));
      }
    }
  }
  const Json& genetic = json.at("searches").at(0);
  EXPECT_EQ(genetic.at("name"), "genetic");
  const Json& population = genetic.at("parameters").at(0);
  EXPECT_EQ(population.at("name"), "search.population");
  EXPECT_EQ(population.at("default"), 20);
}

TEST_F(CommandLine, ListOneSectionAsText) {
  EXPECT_EQ(Run({"list", "controllers"}), kExitDone);
  EXPECT_THAT(out_.str(),
              AllOf(HasSubstr("bird_speed"), HasSubstr("m/s"), Not(HasSubstr("search.population"))));
  EXPECT_EQ(Run({"list", "searches"}), kExitDone);
  EXPECT_THAT(out_.str(),
              HasSubstr("AllParent-BestHalf | 2BestParents-2WorseAway | 2RandomParents-2WorseAway"));
}

TEST(DefaultDirectory, NamesExperimentAndUtcTime) {
  EXPECT_EQ(DefaultDirectory("flocking", 1769903999), "campaigns/flocking-20260131T235959Z");
}

}  // namespace
}  // namespace gauntlet::master
