// Campaigns with plug-ins, as people run them.
// Covers: master/directory/campaign_plugins.cc, worker/plugin/plugin_files.cc
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "tests/plugin/plugin_files.h"

namespace gauntlet::testing_support {
namespace {

namespace fs = std::filesystem;
using testing::AllOf;
using testing::HasSubstr;

constexpr uid_t kStranger = 54321;

class PluginCampaign : public testing::Test {
 protected:
  // `random` with a few short runs.
  ProcessResult Random(const std::string& experiment, const std::vector<std::string>& more) const {
    std::vector<std::string> arguments = {
        "random",  experiment,  "--cases", "4", "--dir", dir_, "--set", "scenario_parameters.time_limit=3",
        "--quiet", "--workers", "2"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return Gauntlet(arguments);
  }
  ProcessResult RandomTwins(const std::vector<std::string>& more = {}) const {
    std::vector<std::string> arguments = {"--plugin", PluginPath("of_twins"), "--set", "controller=twin"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return Random(experiment_, arguments);
  }
  std::string KeptLibrary() const {
    return dir_ + "/plugins/" + Sha256(ReadFile(PluginPath("of_twins"))) + ".so";
  }

  void SetUp() override { std::ofstream(experiment_) << "scenario = 'light-flocking'\n"; }

  TemporaryDirectory scratch_;
  std::string experiment_ = scratch_ / "mine.toml";
  std::string dir_ = scratch_ / "c";
};

TEST_F(PluginCampaign, GivesTheFitnessOfTheBuiltInController) {
  ASSERT_EQ(RandomTwins().exit_code, 0);
  const nlohmann::json twins = Show(dir_);
  dir_ = scratch_ / "built_in";
  ASSERT_EQ(Random(experiment_, {}).exit_code, 0);
  const nlohmann::json built_in = Show(dir_);
  ASSERT_EQ(twins["population"].size(), 4u);
  for (std::size_t i = 0; i < 4; ++i)
    EXPECT_EQ(twins["population"][i]["fitness"], built_in["population"][i]["fitness"]);
}

// Also when a run and its repetition fall into one second.
TEST_F(PluginCampaign, NamesAControllerThatLooksAtTheClockWhenItIsAudited) {
  const ProcessResult audited = Random(
      experiment_, {"--plugin", PluginPath("of_faults"), "--set", "controller=clocked", "--audit", "1"});
  EXPECT_EQ(audited.exit_code, 1);
  EXPECT_THAT(audited.err, HasSubstr("'clocked' of the plug-in is not reproducible"));
  EXPECT_THAT(audited.out, HasSubstr("'clocked' of the plug-in is not reproducible"));
}

// The scenario takes controllers that are written for others.
TEST_F(PluginCampaign, RunsInAScenarioThatTheFileDefines) {
  const std::string defined =
      "scenario = 'generic'\n[generic]\nfitness = 'dispersion'\nfailure = 'clusters > 1'\n";
  std::ofstream(experiment_) << defined;
  const ProcessResult twins = RandomTwins();
  ASSERT_EQ(twins.exit_code, 0) << twins.err;
  const nlohmann::json with_plugin = Show(dir_);
  dir_ = scratch_ / "built_in";
  ASSERT_EQ(Random(experiment_, {"--set", "controller=light-flocking"}).exit_code, 0);
  const nlohmann::json built_in = Show(dir_);
  ASSERT_EQ(with_plugin["population"].size(), 4u);
  for (std::size_t i = 0; i < 4; ++i)
    EXPECT_EQ(with_plugin["population"][i]["fitness"], built_in["population"][i]["fitness"]);
}

TEST_F(PluginCampaign, TakesItsPluginFromAPathRelativeToTheExperimentFile) {
  fs::copy_file(PluginPath("of_twins"), scratch_ / "libtwin.so");
  std::ofstream(experiment_)
      << "scenario = 'light-flocking'\ncontroller = 'twin'\nplugins = ['libtwin.so']\n";
  const ProcessResult result = Random(experiment_, {"--set", "controller_parameters.max_speed=0.2"});
  EXPECT_EQ(result.exit_code, 0) << result.err;
}

TEST_F(PluginCampaign, ChecksParametersAsThoseOfBuiltInControllers) {
  const ProcessResult range = RandomTwins({"--set", "controller_parameters.max_speed=7"});
  EXPECT_EQ(range.exit_code, 2);
  EXPECT_THAT(range.err,
              HasSubstr("controller_parameters.max_speed = 7.0 is out of range, allowed 0.005 to 0.3 m/s"));
  const ProcessResult unknown = RandomTwins({"--set", "controller_parameters.max_sped=0.1"});
  EXPECT_EQ(unknown.exit_code, 2);
  EXPECT_THAT(unknown.err, HasSubstr("did you mean 'controller_parameters.max_speed'?"));
}

TEST_F(PluginCampaign, NamesTheNearestControllerOfAPlugin) {
  const ProcessResult result =
      Random(experiment_, {"--plugin", PluginPath("of_twins"), "--set", "controller=twim"});
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_THAT(result.err, HasSubstr("did you mean 'twin'?"));
}

TEST_F(PluginCampaign, CanBeMovedReplayedAndExtendedWithoutTheOriginalLibrary) {
  fs::copy_file(PluginPath("of_twins"), scratch_ / "libtwin.so");
  ASSERT_EQ(Random(experiment_, {"--plugin", scratch_ / "libtwin.so", "--set", "controller=twin"}).exit_code,
            0);
  fs::remove(scratch_ / "libtwin.so");
  fs::rename(dir_, scratch_ / "moved");
  const std::string moved = scratch_ / "moved";
  const ProcessResult replay = Gauntlet({"replay", moved, "2"});
  EXPECT_EQ(replay.exit_code, 0) << replay.err;
  EXPECT_THAT(replay.out, HasSubstr("run 2: reproduced"));
  const ProcessResult longer = Gauntlet({"resume", moved, "--set", "search.cases=6", "--quiet"});
  EXPECT_EQ(longer.exit_code, 0) << longer.err;
  EXPECT_EQ(Show(moved)["runs_done"], 6);
  const ProcessResult again = Gauntlet(
      {"evaluate", moved + "/experiment.toml", "--from", moved, "--dir", scratch_ / "again", "--quiet"});
  EXPECT_EQ(again.exit_code, 0) << again.err;
}

TEST_F(PluginCampaign, DoesNothingWithAReplacedLibrary) {
  ASSERT_EQ(RandomTwins().exit_code, 0);
  fs::copy_file(PluginPath("of_faults"), KeptLibrary(), fs::copy_options::overwrite_existing);
  for (const std::vector<std::string>& command :
       {std::vector<std::string>{"resume", dir_, "--set", "search.cases=6"},
        {"replay", dir_, "1"},
        {"confirm", dir_, "1"}}) {
    const ProcessResult result = Gauntlet(command);
    EXPECT_EQ(result.exit_code, 2) << command[0];
    EXPECT_THAT(result.err, HasSubstr("is another plug-in now: its SHA-256 is")) << command[0];
  }
  fs::rename(KeptLibrary(), scratch_ / "library");
  fs::create_symlink(scratch_ / "library", KeptLibrary());
  const ProcessResult linked = Gauntlet({"replay", dir_, "1"});
  EXPECT_EQ(linked.exit_code, 2);
  EXPECT_THAT(linked.err, HasSubstr("is a symbolic link"));
}

// A campaign that somebody else could have made is looked at, and nothing of it runs in our name or is made
// in it. `what` is wrong with `path`.
void ExpectOnlyLookedAt(const std::string& dir, const std::string& path, const std::string& what) {
  for (const char* command : {"show", "status"}) EXPECT_EQ(Gauntlet({command, dir}).exit_code, 0) << command;
  const std::string kept = dir + "/experiment.toml";
  for (const std::vector<std::string>& command : {std::vector<std::string>{"replay", dir, "1"},
                                                  {"report", dir, "-o", dir + ".html"},
                                                  {"confirm", dir, "1"},
                                                  {"minimise", dir, "1"},
                                                  {"blame", dir, "1"},
                                                  {"evaluate", kept, "--from", dir, "--dir", dir + ".new"},
                                                  {"random", kept, "--cases", "1", "--dir", dir + ".new"}}) {
    const ProcessResult result = Gauntlet(command);
    EXPECT_EQ(result.exit_code, 2) << command[0];
    EXPECT_THAT(result.err, AllOf(HasSubstr(path + " "), HasSubstr(what))) << command[0];
    EXPECT_FALSE(fs::exists(dir + "/" + command[0])) << command[0];
    EXPECT_FALSE(fs::exists(dir + ".new")) << command[0];
  }
}

TEST_F(PluginCampaign, OnlyLooksAtWhatOthersMayWrite) {
  ASSERT_EQ(RandomTwins().exit_code, 0);
  for (const std::string& path : {KeptLibrary(), dir_ + "/plugins", dir_}) {
    fs::permissions(path, fs::perms::group_write, fs::perm_options::add);
    ExpectOnlyLookedAt(dir_, path, "other users may write it");
    fs::permissions(path, fs::perms::group_write, fs::perm_options::remove);
  }
}

TEST_F(PluginCampaign, OnlyLooksAtWhatBelongsToOthers) {
  if (geteuid() != 0) GTEST_SKIP() << "only root can give files away";
  ASSERT_EQ(RandomTwins().exit_code, 0);
  for (const std::string& path : {KeptLibrary(), dir_ + "/plugins", dir_}) {
    ASSERT_EQ(chown(path.c_str(), kStranger, kStranger), 0);
    ExpectOnlyLookedAt(dir_, path, "belongs to user 54321, not to you (user 0)");
    ASSERT_EQ(chown(path.c_str(), 0, 0), 0);
  }
}

// Whatever the copy is called: what it holds says whose it is.
TEST_F(PluginCampaign, TakesNoCopyUnderAnotherNameThatOthersMayWrite) {
  ASSERT_EQ(RandomTwins().exit_code, 0);
  const std::string copy = dir_ + "/plugins/innocent.so";
  fs::copy_file(KeptLibrary(), copy);
  fs::permissions(copy, fs::perms::group_write, fs::perm_options::add);
  dir_ = scratch_ / "second";
  const ProcessResult result = Random(experiment_, {"--plugin", copy, "--set", "controller=twin"});
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_THAT(result.err, HasSubstr(copy + " has mode"));
}

TEST_F(PluginCampaign, TakesNoLibraryOfOthersThatTheirExperimentNames) {
  if (geteuid() != 0) GTEST_SKIP() << "only root can give files away";
  fs::copy_file(PluginPath("of_twins"), scratch_ / "theirs.so");
  std::ofstream(experiment_) << "controller = 'twin'\nplugins = ['theirs.so']\n";
  for (const std::string name : {"theirs.so", "mine.toml"})
    ASSERT_EQ(chown((scratch_ / name).c_str(), kStranger, kStranger), 0);
  const ProcessResult result = Random(experiment_, {});
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_THAT(result.err, HasSubstr((scratch_ / "theirs.so") + " belongs to user 54321"));
}

// A corpus outlives the library: the cases are asked of the one that is given.
TEST_F(PluginCampaign, GivesItsFailingCasesToACorpus) {
  const std::string corpus = scratch_ / "corpus";
  ASSERT_EQ(
      Random(experiment_, {"--plugin", PluginPath("of_faults"), "--set", "controller=counting"}).exit_code,
      0);
  const ProcessResult confirmed = Gauntlet({"confirm", dir_, "1", "--replicates", "5", "--quiet"});
  ASSERT_EQ(confirmed.exit_code, 0) << confirmed.err;
  const ProcessResult added = Gauntlet({"corpus", "add", dir_, "1", "--to", corpus});
  ASSERT_EQ(added.exit_code, 0) << added.err;
  const ProcessResult checked = Gauntlet({"check", corpus, "--plugin", PluginPath("of_faults"), "--quiet"});
  EXPECT_NE(checked.exit_code, 2) << checked.err;
  EXPECT_EQ(Gauntlet({"check", corpus, "--quiet"}).exit_code, 2) << "without the library";
}

constexpr const char* kSmallTuning = R"(name = "small"
[tune.small]
title = "a small tuning"
experiment = "flocking"
repeats = 1
sizes = "1, 5"
set.search.population = 4
set.search.generations = 1
candidates.genome.genes = "1, 8"
)";

// The whole study knows its plug-in from its own directory.
TEST_F(PluginCampaign, StudiesAndTuningsGoOnWithoutTheOriginalLibrary) {
  const std::string library = scratch_ / "libtwin.so";
  fs::copy_file(PluginPath("of_twins"), library);
  const std::string study = scratch_ / "small.toml";
  std::ofstream(study) << kSmallTuning << R"(set.scenario = "light-flocking"
set.controller = "twin"
set.scenario_parameters.time_limit = 3
)";
  for (const std::vector<std::string>& command :
       {std::vector<std::string>{"study", study},
        std::vector<std::string>{"tune", "flocking", "--candidates", study}}) {
    SCOPED_TRACE(command[0]);
    const std::string dir = scratch_ / command[0];
    std::vector<std::string> arguments = command;
    arguments.insert(arguments.end(), {"--dir", dir, "--workers", "2", "--quiet", "--json"});
    EXPECT_EQ(Gauntlet(arguments).exit_code, 2) << "without the library";
    arguments.insert(arguments.end(), {"--plugin", library});
    const ProcessResult whole = Gauntlet(arguments);
    ASSERT_EQ(whole.exit_code, 0) << whole.err;
    fs::rename(library, scratch_ / "away.so");
    fs::remove_all(dir + "/evaluations");
    const ProcessResult resumed = Gauntlet({"resume", dir, "--quiet", "--json"});
    ASSERT_EQ(resumed.exit_code, 0) << resumed.err;
    EXPECT_EQ(nlohmann::json::parse(resumed.out).at("tunings"),
              nlohmann::json::parse(whole.out).at("tunings"));
    EXPECT_EQ(Show(dir + "/evaluations")["runs_failed"], 0);
    fs::rename(scratch_ / "away.so", library);
  }
}

TEST_F(PluginCampaign, StudiesAndTuningsTakeThePluginsOfTheirExperiments) {
  const std::string library = scratch_ / "libtwin.so";
  fs::copy_file(PluginPath("of_twins"), library);
  std::ofstream(experiment_) << "scenario = 'light-flocking'\ncontroller = 'twin'\nplugins = ['libtwin.so']\n"
                             << "[scenario_parameters]\ntime_limit = 3\n";
  const std::string study = scratch_ / "small.toml";
  std::ofstream(study) << "name = 'small'\n[part.some]\nkind = 'random'\ncases = 2\nseeds = '1'\n"
                       << "experiment = '" << experiment_ << "'\n";
  const std::string candidates = scratch_ / "candidates.toml";
  std::ofstream(candidates) << kSmallTuning;
  for (const std::vector<std::string>& command :
       {std::vector<std::string>{"study", study},
        std::vector<std::string>{"tune", experiment_, "--candidates", candidates}}) {
    SCOPED_TRACE(command[0]);
    const std::string dir = scratch_ / command[0];
    std::vector<std::string> arguments = command;
    arguments.insert(arguments.end(), {"--dir", dir, "--workers", "1", "--quiet"});
    fs::rename(library, scratch_ / "away.so");
    const ProcessResult without = Gauntlet(arguments);
    EXPECT_EQ(without.exit_code, 2);
    EXPECT_THAT(without.err, HasSubstr("libtwin.so"));
    fs::rename(scratch_ / "away.so", library);
    const ProcessResult whole = Gauntlet(arguments);
    ASSERT_EQ(whole.exit_code, 0) << whole.err;
    EXPECT_EQ(Show(dir + "/searches")["runs_failed"], 0);
    fs::rename(library, scratch_ / "away.so");
    const ProcessResult resumed = Gauntlet({"resume", dir, "--quiet"});
    EXPECT_EQ(resumed.exit_code, 0) << resumed.err;
    fs::rename(scratch_ / "away.so", library);
  }
}

// Whichever were taken, the parts of the other would be simulated with the wrong controller.
TEST_F(PluginCampaign, StudiesAndTuningsRefuseTwoLibrariesThatBringOneName) {
  const std::string library = scratch_ / "libtwin.so";
  fs::copy_file(PluginPath("of_twins"), library);
  fs::copy_file(library, scratch_ / "libother.so");
  std::ofstream(scratch_ / "libother.so", std::ios::app) << "another one";
  const std::string other = scratch_ / "other.toml";
  const std::string settings = "scenario = 'light-flocking'\ncontroller = 'twin'\n";
  std::ofstream(experiment_) << settings << "plugins = ['libtwin.so']\n";
  std::ofstream(other) << settings << "plugins = ['libother.so']\n";
  const std::string study = scratch_ / "two.toml";
  std::ofstream(study) << "name = 'two'\n[part.one]\nkind = 'random'\ncases = 2\nseeds = '1'\nexperiment = '"
                       << experiment_
                       << "'\n[part.two]\nkind = 'random'\ncases = 2\nseeds = '1'\nexperiment = '" << other
                       << "'\n";
  for (const std::vector<std::string>& command :
       {std::vector<std::string>{"study", study},
        std::vector<std::string>{"tune", other, "--plugin", library}}) {
    SCOPED_TRACE(command[0]);
    const ProcessResult refused = Gauntlet(command);
    EXPECT_EQ(refused.exit_code, 2);
    EXPECT_THAT(refused.err, HasSubstr("libother.so both bring a controller 'twin'"));
  }
}

// They would otherwise be tried for ever, as what an operator has killed is.
TEST_F(PluginCampaign, RunsThatKillThemselvesEndWithAVerdict) {
  const ProcessResult result =
      Random("flocking", {"--plugin", PluginPath("of_faults"), "--set", "controller=kill-itself"});
  EXPECT_EQ(result.exit_code, 1) << result.err;
  EXPECT_THAT(result.out, AllOf(HasSubstr("4 of 4 killed: was ended from outside by signal 9"),
                                HasSubstr("elsewhere it may end otherwise")));
}

TEST_F(PluginCampaign, FaultyRunsAreResultsThatSaySo) {
  const ProcessResult result =
      Random("flocking", {"--plugin", PluginPath("of_faults"), "--set", "controller=throw"});
  EXPECT_EQ(result.exit_code, 1) << result.err;
  const nlohmann::json show = Show(dir_);
  EXPECT_EQ(show["runs_failed"], 4);
  EXPECT_THAT(ReadFile(dir_ + "/bundles/run-1/stderr.txt"), HasSubstr("tired of walking"));
  EXPECT_THAT(ReadFile(dir_ + "/bundles/run-1/README.txt"), HasSubstr("--plugin ../../plugins/"));
}

}  // namespace
}  // namespace gauntlet::testing_support
