#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <optional>
#include <sstream>

#include "search/experiment/experiment_file.h"
#include "search/search_table.h"
#include "tests/support/paths.h"

namespace gauntlet {
namespace {

using ::testing::HasSubstr;
using ::testing::StartsWith;

namespace fs = std::filesystem;

// A folder of its own for $GAUNTLET_EXPERIMENTS_DIR, or the shipped one.
class ShippedExperimentsTest : public ::testing::Test {
 protected:
  void SetUp() override {
    const auto* info = ::testing::UnitTest::GetInstance()->current_test_info();
    folder_ = fs::path(::testing::TempDir()) / (std::string("gauntlet-") + info->name());
    fs::remove_all(folder_);
    fs::create_directories(folder_);
    unsetenv("GAUNTLET_EXPERIMENTS_DIR");
  }
  void TearDown() override {
    unsetenv("GAUNTLET_EXPERIMENTS_DIR");
    fs::remove_all(folder_);
  }
  fs::path Write(const std::string& name, const std::string& text) {
    std::ofstream(folder_ / name) << text;
    return folder_ / name;
  }

  fs::path folder_;
};

TEST_F(ShippedExperimentsTest, AllAreReadableNamedAsTheirFileAndSearchable) {
  const std::vector<ShippedExperiment> list = ListExperiments(BuiltInCatalogue());
  std::vector<std::string> names;
  for (const ShippedExperiment& shipped : list) {
    names.push_back(shipped.name);
    EXPECT_EQ(shipped.error, "") << shipped.path;
    EXPECT_FALSE(shipped.description.empty()) << shipped.path;
    const Result<Experiment> experiment = LoadExperiment(shipped.name, {}, BuiltInCatalogue());
    ASSERT_TRUE(experiment.ok()) << experiment.error().message;
    EXPECT_EQ(experiment->name, shipped.name);
    const auto search = MakeSearch(*experiment);
    ASSERT_TRUE(search.ok()) << search.error().message;
  }
  EXPECT_THAT(names, ::testing::IsSupersetOf({"flocking", "flocking-improved"}));
}

TEST_F(ShippedExperimentsTest, FlockingHasTheParametersOfTable41) {
  const Result<Experiment> experiment = LoadExperiment("flocking", {}, BuiltInCatalogue());
  ASSERT_TRUE(experiment.ok()) << experiment.error().message;
  EXPECT_EQ(experiment->genome.genes, 8);
  EXPECT_EQ(experiment->search.population * experiment->search.generations, 1000);
  EXPECT_EQ(experiment->search.parent_selection, ParentSelection::kTwoBestParentsTwoWorseAway);
  EXPECT_EQ(experiment->search.crossover, CrossoverKind::kSinglePoint);
  EXPECT_EQ(experiment->search.crossover_probability, 0.1);
  EXPECT_EQ(experiment->search.mutation_probability, 0.05);
  EXPECT_EQ(LoadExperiment("flocking-improved", {}, BuiltInCatalogue())->controller, "flocking-improved");
}

TEST_F(ShippedExperimentsTest, ForagingHasTheParametersOfTable51AndSelectableVariants) {
  const Result<Experiment> experiment = LoadExperiment("foraging", {}, BuiltInCatalogue());
  ASSERT_TRUE(experiment.ok()) << experiment.error().message;
  EXPECT_EQ(experiment->genome.genes, 8);
  EXPECT_EQ(experiment->search.population, 20);
  EXPECT_EQ(experiment->search.generations, 30);
  EXPECT_EQ(experiment->search.parent_selection, ParentSelection::kAllParentBestHalf);
  EXPECT_EQ(experiment->search.crossover, CrossoverKind::kDoublePoint);
  EXPECT_EQ(experiment->search.crossover_probability, 0.2);
  EXPECT_EQ(experiment->search.mutation_probability, 0.05);
  for (const char* variant : {"foraging-improved", "foraging-random-side", "foraging-basic"}) {
    const auto chosen =
        LoadExperiment("foraging", {std::string("controller=") + variant}, BuiltInCatalogue());
    ASSERT_TRUE(chosen.ok()) << chosen.error().message;
    EXPECT_EQ(chosen->controller, variant);
  }
  EXPECT_EQ(LoadExperiment("foraging", {"controller=foraging-improve"}, BuiltInCatalogue()).error().message,
            "--set controller=foraging-improve: unknown controller 'foraging-improve'; did you mean "
            "'foraging-improved'?");
}

TEST_F(ShippedExperimentsTest, TaskPartitioningReusesTheParametersOfTable51) {
  const Result<Experiment> experiment = LoadExperiment("task-partitioning", {}, BuiltInCatalogue());
  ASSERT_TRUE(experiment.ok()) << experiment.error().message;
  const Result<Experiment> foraging = LoadExperiment("foraging", {}, BuiltInCatalogue());
  EXPECT_EQ(experiment->genome.genes, 8);
  EXPECT_EQ(experiment->search.population, foraging->search.population);
  EXPECT_EQ(experiment->search.generations, foraging->search.generations);
  EXPECT_EQ(experiment->search.parent_selection, foraging->search.parent_selection);
  EXPECT_EQ(experiment->search.crossover, foraging->search.crossover);
  EXPECT_EQ(experiment->search.crossover_probability, foraging->search.crossover_probability);
  EXPECT_EQ(experiment->search.mutation_probability, foraging->search.mutation_probability);
  for (const char* variant : {"task-partitioning-improved", "task-partitioning-dynamic"}) {
    const auto chosen =
        LoadExperiment("task-partitioning", {std::string("controller=") + variant}, BuiltInCatalogue());
    ASSERT_TRUE(chosen.ok()) << chosen.error().message;
    EXPECT_EQ(chosen->controller, variant);
  }
  const Result<Experiment> convergence =
      LoadExperiment("task-partitioning-convergence", {}, BuiltInCatalogue());
  ASSERT_TRUE(convergence.ok()) << convergence.error().message;
  EXPECT_EQ(convergence->scenario_parameters.at("time_limit"), 3600.0);
  EXPECT_EQ(convergence->scenario_parameters.at("start_mode"), 1.0);
}

// They are held against published figures: no later default may change them.
TEST_F(ShippedExperimentsTest, FittedExperimentsWriteEveryValueOutAndAreOneSwarmWithTheirImprovedOnes) {
  for (const std::string name : {"flocking", "foraging", "task-partitioning"}) {
    std::vector<Experiment> pair;
    for (const std::string suffix : {"-fitted", "-fitted-improved"}) {
      const std::string path = GAUNTLET_SOURCE_DIR "/experiments/" + name + suffix + ".toml";
      const std::string text = (std::ostringstream() << std::ifstream(path).rdbuf()).str();
      pair.push_back(LoadExperiment(name + suffix, {}, BuiltInCatalogue()).value());
      for (const sim::Parameters& parameters :
           {pair.back().scenario_parameters, pair.back().controller_parameters}) {
        for (const auto& [key, value] : parameters)
          EXPECT_NE(text.find("\n" + key + " = "), std::string::npos) << path << ": " << key;
      }
    }
    EXPECT_EQ(pair[0].scenario_parameters, pair[1].scenario_parameters);
    EXPECT_EQ(pair[1].controller, name + "-improved");
    for (const auto& [key, value] : pair[0].controller_parameters)
      EXPECT_EQ(pair[1].controller_parameters.at(key), value) << key;
    EXPECT_EQ(pair[0].genome.length_max, 0.9) << "one generator of obstacles for all three behaviours";
  }
}

TEST_F(ShippedExperimentsTest, WrittenResolvedFlockingReadsBackEqual) {
  const Experiment experiment =
      *LoadExperiment("flocking", {"seed=5", "search.generations=3"}, BuiltInCatalogue());
  const std::string text = WriteExperiment(experiment, {"resolved"}, BuiltInCatalogue());
  const Result<Experiment> read = ParseExperiment(text, "experiment.toml", {}, BuiltInCatalogue());
  ASSERT_TRUE(read.ok()) << read.error().message;
  EXPECT_EQ(WriteExperiment(*read, {"resolved"}, BuiltInCatalogue()), text);
  EXPECT_EQ(read->controller_parameters, experiment.controller_parameters);
  EXPECT_EQ(read->scenario_parameters, experiment.scenario_parameters);
}

// Campaigns that were stored before there was a parameter go on: theirs are the same settings as its default.
TEST_F(ShippedExperimentsTest, AParameterThatCameLaterStandsNowhereAtItsDefault) {
  const std::string key = "controller_parameters.turn_angle=";
  for (const auto& [value, stands] : {std::pair("0", false), std::pair("0.5", true)}) {
    const Experiment experiment = *LoadExperiment("flocking", {key + value}, BuiltInCatalogue());
    EXPECT_EQ(experiment.controller_parameters.contains("turn_angle"), stands);
    const std::string text = WriteExperiment(experiment, {}, BuiltInCatalogue());
    EXPECT_EQ(text.find("turn_angle") != std::string::npos, stands);
    const Result<Experiment> read = ParseExperiment(text, "experiment.toml", {}, BuiltInCatalogue());
    ASSERT_TRUE(read.ok()) << read.error().message;
    EXPECT_EQ(read->controller_parameters, experiment.controller_parameters);
  }
  const Experiment unset = *LoadExperiment("flocking", {key + "0.5", key + "0"}, BuiltInCatalogue());
  EXPECT_FALSE(unset.controller_parameters.contains("turn_angle"));
}

TEST_F(ShippedExperimentsTest, UnknownNameSuggestsTheNearest) {
  const Result<Experiment> experiment = LoadExperiment("floking", {}, BuiltInCatalogue());
  ASSERT_FALSE(experiment.ok());
  EXPECT_EQ(experiment.error().kind, ErrorKind::kNotFound);
  EXPECT_THAT(experiment.error().message,
              StartsWith("unknown experiment 'floking'; did you mean 'flocking'?"));
  EXPECT_EQ(
      LoadExperiment("quux", {}, BuiltInCatalogue()).error().message,
      "unknown experiment 'quux'; shipped: aggregation, aggregation-improved, coverage, coverage-improved, "
      "flocking, flocking-fitted, flocking-fitted-improved, "
      "flocking-improved, flocking-required, foraging, foraging-fitted, foraging-fitted-improved, gathering, "
      "site-selection, site-selection-improved, "
      "task-partitioning, task-partitioning-convergence, task-partitioning-fitted, "
      "task-partitioning-fitted-improved (a file is named by a path ending in .toml)");
  setenv("GAUNTLET_EXPERIMENTS_DIR", "no-such-folder", 1);
  EXPECT_THAT(LoadExperiment("flocking", {}, BuiltInCatalogue()).error().message,
              StartsWith("there is no experiment 'flocking', because none can be read in no-such-folder"));
}

TEST_F(ShippedExperimentsTest, FilesAreReadByPathAndMessagesCarryIt) {
  const fs::path good = Write("mine.toml", "scenario = 'flocking'\n");
  const Result<Experiment> experiment = LoadExperiment(good.string(), {}, BuiltInCatalogue());
  ASSERT_TRUE(experiment.ok()) << experiment.error().message;
  EXPECT_EQ(experiment->name, "mine");

  const fs::path bad = Write("bad.toml", "scenario = 'flocking'\nsed = 3\n");
  EXPECT_EQ(LoadExperiment(bad.string(), {}, BuiltInCatalogue()).error().message,
            bad.string() + ":2:1: unknown key 'sed'; did you mean 'seed'?");
}

TEST_F(ShippedExperimentsTest, MissingFilesFoldersAndEndlessFilesAreRefused) {
  const std::string missing = (folder_ / "none.toml").string();
  EXPECT_EQ(LoadExperiment(missing, {}, BuiltInCatalogue()).error().message,
            "there is no experiment file '" + missing + "'");
  EXPECT_THAT(LoadExperiment(folder_.string() + "/", {}, BuiltInCatalogue()).error().message,
              HasSubstr("is a folder"));
  EXPECT_EQ(LoadExperiment("/dev/zero", {}, BuiltInCatalogue()).error().message,
            "'/dev/zero' is larger than 1048576 bytes: no experiment file");
}

TEST_F(ShippedExperimentsTest, TheEnvironmentNamesTheOnlyFolder) {
  Write("mine.toml", "scenario = 'flocking'\ndescription = 'my own'\n");
  Write("broken.toml", "scenario = \n");
  Write("notes.txt", "no experiment");
  setenv("GAUNTLET_EXPERIMENTS_DIR", folder_.c_str(), 1);
  const std::vector<ShippedExperiment> list = ListExperiments(BuiltInCatalogue());
  ASSERT_EQ(list.size(), 2U);
  EXPECT_EQ(list[0].name, "broken");
  EXPECT_THAT(list[0].error, HasSubstr("broken.toml:1:"));
  EXPECT_EQ(list[1].name, "mine");
  EXPECT_EQ(list[1].description, "my own");
  EXPECT_EQ(list[1].error, "");
  EXPECT_TRUE(LoadExperiment("mine", {}, BuiltInCatalogue()).ok());
  EXPECT_FALSE(LoadExperiment("flocking", {}, BuiltInCatalogue()).ok());
}

}  // namespace
}  // namespace gauntlet
