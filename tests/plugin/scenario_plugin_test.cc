// Campaigns whose scenario is a plug-in's, as people run them, and what a scenario's faults cost.
// Covers: sdk/example/my_patrol.cc
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "proto/run_beginning.h"
#include "proto/run_codec.h"
#include "tests/plugin/plugin_files.h"

namespace gauntlet::testing_support {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

class ScenarioPlugin : public testing::Test {
 protected:
  void SetUp() override {
    fs::copy_file(PluginPath("of_patrol"), scratch_ / "libpatrol.so");
    std::ofstream(experiment_) << "scenario = 'my-patrol'\nplugins = ['libpatrol.so']\n"
                                  "[scenario_parameters]\ntime_limit = 60\nenough = 0.36\n"
                                  "[search]\npopulation = 6\ngenerations = 3\n";
  }

  ProcessResult Evolve(const std::string& dir, int workers, const std::vector<std::string>& more = {}) const {
    std::vector<std::string> arguments = {"evolve",    experiment_,
                                          "--dir",     dir,
                                          "--quiet",   "--even-if-it-fails-without-obstacles",
                                          "--workers", std::to_string(workers)};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return Gauntlet(arguments);
  }
  // `random` with two runs of a scenario of the other library.
  ProcessResult RandomFaulty(const std::string& scenario, const std::vector<std::string>& more = {}) const {
    std::ofstream(scratch_ / "faulty.toml") << "scenario = '" << scenario << "'\n";
    std::vector<std::string> arguments = {
        "random",   scratch_ / "faulty.toml",          "--cases", "2",         "--dir", dir_,
        "--plugin", PluginPath("of_faulty_scenarios"), "--quiet", "--workers", "2"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return Gauntlet(arguments);
  }

  TemporaryDirectory scratch_;
  std::string experiment_ = scratch_ / "patrol.toml";
  std::string dir_ = scratch_ / "c";
};

TEST_F(ScenarioPlugin, EndsTheSameForAnyNumberOfWorkersAndAuditsAlike) {
  ASSERT_EQ(Evolve(scratch_ / "1", 1).exit_code, 0);
  const ProcessResult three = Evolve(scratch_ / "3", 3, {"--audit", "1"});
  ASSERT_EQ(three.exit_code, 0) << three.err;
  EXPECT_EQ(StateHash(scratch_ / "1"), StateHash(scratch_ / "3"));
  EXPECT_EQ(Show(scratch_ / "3")["runs_failed"], 0);
}

TEST_F(ScenarioPlugin, IsWhatACampaignTakesAlongForEveryCommand) {
  ASSERT_EQ(Evolve(dir_, 2).exit_code, 0);
  fs::remove(scratch_ / "libpatrol.so");
  const std::string moved = scratch_ / "moved";
  fs::rename(dir_, moved);
  const std::vector<std::vector<std::string>> commands = {
      {"resume", moved, "--set", "search.generations=4", "--quiet"},
      {"replay", moved, "2", "--svg", scratch_ / "run.svg"},
      {"confirm", moved, "15", "--quiet"},
      {"minimise", moved, "15", "--quiet"},
      {"report", moved, "--out", scratch_ / "report.html"},
      {"export", moved, "--format", "csv", "--out", scratch_ / "runs.csv"},
      {"export", moved, "--format", "argos", "--out", scratch_ / "argos"},
      {"show", moved},
      {"compare", moved + ":all", moved + ":final"},
      {"evaluate", moved + "/experiment.toml", "--from", moved, "--dir", scratch_ / "again", "--quiet"}};
  for (const std::vector<std::string>& command : commands) {
    const ProcessResult result = Gauntlet(command);
    EXPECT_EQ(result.exit_code, 0) << command.front() << ": " << result.err << result.out;
  }
  EXPECT_THAT(ReadFile(scratch_ / "report.html"), HasSubstr("robots have to come to every patch"));
  EXPECT_THAT(ReadFile(moved + "/experiment.toml"), HasSubstr("scenario_plugin = \""));
}

// A campaign that is only looked at loads nothing: what the search needs of its scenario stands beside it.
TEST_F(ScenarioPlugin, IsLookedAtButNotReplayedWhenOthersMayWriteItsLibrary) {
  ASSERT_EQ(Evolve(dir_, 2).exit_code, 0);
  const std::string kept = dir_ + "/plugins/" + Sha256(ReadFile(PluginPath("of_patrol")));
  EXPECT_TRUE(fs::exists(kept + ".beginnings.json"));
  fs::permissions(kept + ".so", fs::perms::others_write, fs::perm_options::add);
  EXPECT_EQ(Gauntlet({"show", dir_}).exit_code, 0);
  const ProcessResult result = Gauntlet({"replay", dir_, "1"});
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_THAT(result.err, HasSubstr("other users may write it"));
}

TEST_F(ScenarioPlugin, IsAskedAgainWhenItsAnswersAreGoneOrDoNotReadBack) {
  ASSERT_EQ(Evolve(dir_, 2).exit_code, 0);
  const std::string hash = StateHash(dir_);
  const std::string answers =
      dir_ + "/plugins/" + Sha256(ReadFile(PluginPath("of_patrol"))) + ".beginnings.json";
  nlohmann::json damaged = nlohmann::json::parse(ReadFile(answers));
  for (nlohmann::json& answer : damaged) answer = "{}";
  std::ofstream(answers) << damaged;
  EXPECT_EQ(StateHash(dir_), hash);
  fs::remove(answers);
  EXPECT_EQ(StateHash(dir_), hash);
}

TEST_F(ScenarioPlugin, TakesControllersThatAreBuiltInAndOfOtherPlugins) {
  for (const std::string controller : {"light-flocking", "chatty"}) {
    SCOPED_TRACE(controller);
    const ProcessResult result = Evolve(
        scratch_ / controller, 2, {"--set", "controller=" + controller, "--plugin", PluginPath("of_faults")});
    ASSERT_EQ(result.exit_code, 0) << result.err;
    EXPECT_EQ(Show(scratch_ / controller)["runs_failed"], 0);
    const ProcessResult replay = Gauntlet({"replay", scratch_ / controller, "1"});
    EXPECT_THAT(replay.out, HasSubstr("run 1: reproduced")) << replay.err;
  }
}

TEST_F(ScenarioPlugin, IsSearchedByAllThatKnowItsMetrics) {
  const ProcessResult result =
      Evolve(dir_, 2, {"--set", "search.algorithm=archive", "--set", "search.runs=80"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_EQ(Show(dir_)["runs_done"], 80);
}

TEST_F(ScenarioPlugin, OfTwoLibrariesIsTwoScenarios) {
  ASSERT_EQ(Evolve(dir_, 2).exit_code, 0);
  fs::copy_file(PluginPath("of_patrol_again"), scratch_ / "libpatrol.so",
                fs::copy_options::overwrite_existing);
  ASSERT_EQ(Evolve(scratch_ / "again", 2).exit_code, 0);
  const ProcessResult result = Gauntlet({"compare", dir_, scratch_ / "again"});
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_THAT(result.err, HasSubstr("library of the scenario my-patrol"));
}

TEST_F(ScenarioPlugin, IsNamedWithItsNearestName) {
  const ProcessResult result = Evolve(dir_, 2, {"--set", "scenario=my-patrols"});
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_THAT(result.err, HasSubstr("unknown scenario 'my-patrols'; did you mean 'my-patrol'?"));
}

TEST_F(ScenarioPlugin, GivesItsFailingCasesToACorpus) {
  std::ofstream(experiment_, std::ios::app) << "[genome]\ngenes = 2\n";
  ASSERT_EQ(Evolve(dir_, 2, {"--set", "scenario_parameters.enough=1"}).exit_code, 0);
  ASSERT_EQ(Gauntlet({"confirm", dir_, "1", "--replicates", "5", "--quiet"}).exit_code, 0);
  const std::string corpus = scratch_ / "corpus";
  const ProcessResult added = Gauntlet({"corpus", "add", dir_, "1", "--to", corpus});
  ASSERT_EQ(added.exit_code, 0) << added.err;
  const ProcessResult checked = Gauntlet({"check", corpus, "--plugin", PluginPath("of_patrol"), "--quiet"});
  EXPECT_EQ(checked.exit_code, 0) << checked.err;
  EXPECT_EQ(Gauntlet({"check", corpus, "--quiet"}).exit_code, 2) << "without the library";
}

TEST_F(ScenarioPlugin, RefusesACaseThatBreaksARule) {
  std::ofstream(scratch_ / "walled.json")
      << R"({"obstacles": [{"x": 0, "y": -2, "length": 6, "width": 0.2}]})";
  const ProcessResult result =
      Gauntlet({"evaluate", experiment_, "--case", scratch_ / "walled.json", "--json"});
  EXPECT_THAT(result.out, HasSubstr("no-path")) << result.err;
}

// What goes wrong before there is a run is a refusal that names the library.
struct ScenarioRefusal {
  std::string scenario;
  std::string why;
};
void PrintTo(const ScenarioRefusal& refusal, std::ostream* os) {
  *os << refusal.scenario;
}

std::string NameOfTest(const testing::TestParamInfo<ScenarioRefusal>& parameter) {
  std::string name = parameter.param.scenario;
  std::ranges::replace(name, '-', '_');
  return name;
}

class RefusedScenario : public ScenarioPlugin, public testing::WithParamInterface<ScenarioRefusal> {};

TEST_P(RefusedScenario, BeginsNothing) {
  if (kSanitized) GTEST_SKIP() << "sanitizers end such processes in their own way";
  const ProcessResult result = RandomFaulty(GetParam().scenario);
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_THAT(result.err, HasSubstr(PluginPath("of_faulty_scenarios")));
  EXPECT_THAT(result.err, HasSubstr(GetParam().why));
  EXPECT_FALSE(fs::exists(dir_));
}

INSTANTIATE_TEST_SUITE_P(
    Scenarios, RefusedScenario,
    testing::Values(
        ScenarioRefusal{"crash-in-constructor", "crashed with signal 11 when it was asked how a run begins"},
        ScenarioRefusal{"exit-in-constructor", "called exit(0) when it was asked how a run begins"},
        ScenarioRefusal{"throw-in-requirements", "uncaught exception: not today"},
        // By its CPU time, or by the clock on a crowded machine.
        ScenarioRefusal{"spin-in-requirements", "when it was asked how a run begins"},
        ScenarioRefusal{"crash-in-swarm", "crashed with signal 11"},
        ScenarioRefusal{"throw-in-swarm", "uncaught exception: not today"},
        ScenarioRefusal{"without-robots", "its swarm has no robots"},
        ScenarioRefusal{"start-outside", "what it asks of an arena is wrong: its start is at"}),
    NameOfTest);

// What goes wrong later costs the run.
class FaultyScenario : public ScenarioPlugin, public testing::WithParamInterface<ScenarioRefusal> {};

TEST_P(FaultyScenario, CostsTheRun) {
  if (kSanitized) GTEST_SKIP() << "sanitizers end such processes in their own way";
  ASSERT_EQ(Gauntlet({"list", "--plugin", PluginPath("of_faulty_scenarios")}).exit_code, 0);
  sim::RunSpec spec;
  spec.scenario = GetParam().scenario;
  spec.scenario_plugin = Sha256(ReadFile(PluginPath("of_faulty_scenarios")));
  spec.controller = "light-flocking";
  std::ofstream(scratch_ / "spec", std::ios::binary) << proto::EncodeRunSpec(spec);
  const ProcessResult ended = RunProcess({WorkerPath(), "--run-spec", scratch_ / "spec", "--cpu-limit", "2",
                                          "--plugin", PluginPath("of_faulty_scenarios")});
  EXPECT_EQ(ended.exit_code, 0) << ended.err;
  const Result<sim::RunResult> result = proto::DecodeRunResult(ended.out);
  ASSERT_TRUE(result.ok());
  EXPECT_EQ(result->message, GetParam().why);
}

INSTANTIATE_TEST_SUITE_P(Scenarios, FaultyScenario,
                         testing::Values(ScenarioRefusal{"sound", ""},
                                         ScenarioRefusal{"throw-in-tick", "crashed with exit code 87"},
                                         ScenarioRefusal{"crash-in-evaluate", "crashed with signal 11"},
                                         ScenarioRefusal{"exit-in-evaluate", "crashed with exit code 89"},
                                         ScenarioRefusal{"spin-in-evaluate", "exceeded its CPU time"},
                                         ScenarioRefusal{"throw-in-evaluate", "crashed with exit code 87"}),
                         NameOfTest);

TEST_F(ScenarioPlugin, FaultyRunsAreResultsThatSaySo) {
  if (kSanitized) GTEST_SKIP() << "sanitizers end such processes in their own way";
  const ProcessResult result = RandomFaulty("throw-in-evaluate");
  EXPECT_EQ(result.exit_code, 1) << result.err;
  EXPECT_EQ(Show(dir_)["runs_failed"], 2);
  EXPECT_THAT(ReadFile(dir_ + "/bundles/run-1/stderr.txt"), HasSubstr("not today"));
  EXPECT_THAT(ReadFile(dir_ + "/bundles/run-1/README.txt"), HasSubstr("--plugin ../../plugins/"));
}

// Obstacles do not count for what a scenario demands, so that a run has the answer that its search had.
TEST_F(ScenarioPlugin, IsAskedForItsDemandsWithoutObstacles) {
  sim::RunSpec spec;
  spec.test_case.obstacles = {{2.0, 2.0, 0.5, 0.2, 0.0}, {-2.0, 2.0, 0.5, 0.2, 0.0}};
  spec.scenario = "sound";
  spec.scenario_plugin = Sha256(ReadFile(PluginPath("of_faulty_scenarios")));
  spec.controller = "light-flocking";
  std::ofstream(scratch_ / "spec", std::ios::binary) << proto::EncodeRunSpec(spec);
  const ProcessResult asked = RunProcess({WorkerPath(), "--describe-beginning", scratch_ / "spec", "--plugin",
                                          PluginPath("of_faulty_scenarios")});
  ASSERT_EQ(asked.exit_code, 0) << asked.err;
  const Result<sim::RunBeginning> beginning = proto::ReadBeginning(asked.out, "stdout");
  ASSERT_TRUE(beginning.ok()) << beginning.error().message;
  EXPECT_EQ(beginning->requirements.start, sim::Vec2(0.0, 0.0));
  ASSERT_TRUE(beginning->start.ok());
  EXPECT_EQ(beginning->start->robots.size(), 1u);
}

}  // namespace
}  // namespace gauntlet::testing_support
