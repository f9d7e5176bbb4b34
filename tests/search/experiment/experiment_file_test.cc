// Covers: search/experiment/disturbance_keys.cc

#include "search/experiment/experiment_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <set>

#include "base/nearest_name.h"
#include "tests/search/experiment/toy_catalogue.h"

namespace gauntlet {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::Pair;
using ::testing::StartsWith;

// All keys of the experiment's scenario and controller.
std::vector<Key> KeysOf(const Experiment& experiment) {
  const Catalogue catalogue = ToyCatalogue();
  std::vector<Key> keys = CommonKeys(catalogue);
  for (Key& key : ScenarioParameterKeys(*FindByName(catalogue.scenarios, experiment.scenario)))
    keys.push_back(key);
  for (Key& key : ControllerParameterKeys(*FindByName(catalogue.controllers, experiment.controller))) {
    keys.push_back(key);
  }
  return keys;
}

TEST(ExperimentFileTest, ScenarioAloneGivesAllDefaults) {
  const Result<Experiment> experiment = ParseToy("scenario = 'marching'");
  ASSERT_TRUE(experiment.ok()) << experiment.error().message;
  EXPECT_EQ(experiment->name, "toy");
  EXPECT_EQ(experiment->seed, 1U);
  EXPECT_EQ(experiment->controller, "walker");
  EXPECT_THAT(experiment->scenario_parameters,
              ElementsAre(Pair("camera_range", 1.6373), Pair("headwind", 0.0), Pair("robots", 10.0)));
  EXPECT_THAT(experiment->controller_parameters, ElementsAre(Pair("speed", 0.08)));
  // Thesis Table 4.1.
  EXPECT_EQ(experiment->genome.genes, 8);
  EXPECT_EQ(experiment->search.population, 20);
  EXPECT_EQ(experiment->search.generations, 50);
  EXPECT_EQ(experiment->search.parent_selection, ParentSelection::kTwoBestParentsTwoWorseAway);
  EXPECT_EQ(experiment->search.crossover, CrossoverKind::kSinglePoint);
  EXPECT_EQ(experiment->search.crossover_probability, 0.1);
  EXPECT_EQ(experiment->search.mutation_probability, 0.05);
}

TEST(ExperimentFileTest, ReadsEveryKindOfValue) {
  const Result<Experiment> experiment = ParseToy(R"(
name = "march-1"
description = "says \"hello\""
seed = "18446744073709551615"
scenario = "marching"
controller = "runner"
[scenario_parameters]
robots = 7
camera_range = 2
headwind = true
[controller_parameters]
gain = 3.5
[search]
algorithm = "random"
parent_selection = "AllParent-BestHalf"
crossover = "uniform"
reevaluation = "children"
fitness_aggregation = "last"
cases = 12000
[genome]
step = 0
)");
  ASSERT_TRUE(experiment.ok()) << experiment.error().message;
  EXPECT_EQ(experiment->name, "march-1");
  EXPECT_EQ(experiment->description, "says \"hello\"");
  EXPECT_EQ(experiment->seed, 18446744073709551615U);
  EXPECT_EQ(experiment->controller, "runner");
  EXPECT_EQ(experiment->scenario_parameters.at("robots"), 7.0);
  EXPECT_EQ(experiment->scenario_parameters.at("camera_range"), 2.0);
  EXPECT_EQ(experiment->scenario_parameters.at("headwind"), 1.0);
  EXPECT_THAT(experiment->controller_parameters, ElementsAre(Pair("gain", 3.5)));
  EXPECT_EQ(experiment->search.algorithm, "random");
  EXPECT_EQ(experiment->search.parent_selection, ParentSelection::kAllParentBestHalf);
  EXPECT_EQ(experiment->search.crossover, CrossoverKind::kUniform);
  EXPECT_EQ(experiment->search.reevaluation, Reevaluation::kChildren);
  EXPECT_EQ(experiment->search.aggregation, FitnessAggregation::kLast);
  EXPECT_EQ(experiment->search.parameters.at("cases"), 12000.0);
  EXPECT_EQ(experiment->genome.step, 0.0);
}

TEST(ExperimentFileTest, SetsWinOverTheFileAndTheLastOneWins) {
  const Result<Experiment> experiment =
      ParseToy("scenario = 'marching'\nseed = 3\n[search]\ngenerations = 5\n",
               {"search.generations=6", "search.generations=7", "controller=runner",
                "controller_parameters.gain=1.5", "seed=18446744073709551615", "name=123",
                "description=two words # and more", "scenario_parameters.headwind=true"});
  ASSERT_TRUE(experiment.ok()) << experiment.error().message;
  EXPECT_EQ(experiment->search.generations, 7);
  EXPECT_EQ(experiment->controller, "runner");
  EXPECT_EQ(experiment->controller_parameters.at("gain"), 1.5);
  EXPECT_EQ(experiment->seed, 18446744073709551615U);
  EXPECT_EQ(experiment->name, "123");
  EXPECT_EQ(experiment->description, "two words # and more");
  EXPECT_EQ(experiment->scenario_parameters.at("headwind"), 1.0);
}

TEST(ExperimentFileTest, DisturbancesAreKeysOfEveryExperiment) {
  const Experiment quiet = *ParseToy("scenario = 'marching'");
  EXPECT_TRUE(quiet.disturbances.None());
  const Result<Experiment> read =
      ParseToy("scenario = 'marching'\n[noise]\nproximity.gaussian = 0.02\nlight.uniform = 0.0\n",
               {"noise.range_and_bearing.drop=0.1", "faults=3:wheels@500 4:stopped@0",
                "random_faults.count=2", "random_faults.what=leds", "random_faults.role=all"});
  ASSERT_TRUE(read.ok()) << read.error().message;
  const sim::Disturbances expected = {
      .noise = {{sim::Device::kProximity, {.gaussian = 0.02}},
                {sim::Device::kRangeAndBearing, {.drop = 0.1}}},
      .faults = {{3, sim::Device::kWheels, 500}, {4, {}, 0}},
      .random_faults = {.count = 2, .device = sim::Device::kLeds, .role = sim::FaultyRole::kAll}};
  EXPECT_EQ(read->disturbances, expected);
  const std::string text = WriteExperiment(*read, {}, ToyCatalogue());
  EXPECT_THAT(text, HasSubstr("faults = \"3:wheels@500 4:stopped@0\""));
  EXPECT_THAT(text, HasSubstr("\n[noise]\n"));
  EXPECT_THAT(text, HasSubstr("\nrange_and_bearing.drop = 0.1 "));
  EXPECT_EQ(ParseToy(text)->disturbances, expected);
}

TEST(ExperimentFileTest, WritesEveryKeyWithItsMeaning) {
  const Experiment experiment = *ParseToy("scenario = 'marching'");
  const std::string text = WriteExperiment(experiment, {"made by a test", ""}, ToyCatalogue());
  EXPECT_THAT(text, StartsWith("# made by a test\n#\n"));
  for (const Key& key : KeysOf(experiment)) {
    if (key.rare) continue;
    const std::size_t dot = key.path.find('.');
    const std::string name = dot == std::string::npos ? key.path : key.path.substr(dot + 1);
    EXPECT_THAT(text, HasSubstr("\n" + name + " = ")) << key.path;
    EXPECT_THAT(text, HasSubstr(key.description)) << key.path;
  }
  EXPECT_THAT(text, HasSubstr("crossover_probability = 0.1 "));
  EXPECT_THAT(text, HasSubstr("headwind = false "));
  EXPECT_THAT(text, HasSubstr("length_max = 2.0 "));
}

TEST(ExperimentFileTest, PathsAreUniqueAndDefaultsAllowed) {
  std::set<std::string> paths;
  for (const Key& key : KeysOf(*ParseToy("scenario = 'marching'"))) {
    EXPECT_TRUE(paths.insert(key.path).second) << key.path;
    EXPECT_FALSE(key.description.empty()) << key.path;
    EXPECT_EQ(CheckValue(key, key.default_value), std::nullopt) << key.path;
  }
}

// A value that the key allows.
KeyValue AllowedValue(const Key& key) {
  switch (key.type) {
    case KeyType::kText:
      if (key.path == "faults")
        return *rc::gen::element<std::string>("", "3:wheels@500 0:stopped@7", "9:leds@1");
      return *rc::gen::container<std::string>(rc::gen::inRange<char>(1, 127));
    case KeyType::kChoice:
      return *rc::gen::elementOf(key.choices);
    case KeyType::kInteger:
      return *rc::gen::inRange<std::int64_t>(static_cast<std::int64_t>(key.min),
                                             static_cast<std::int64_t>(key.max) + 1);
    case KeyType::kNumber: {
      const double share = static_cast<double>(*rc::gen::inRange<std::int64_t>(0, 1LL << 53)) / 0x1p53;
      return key.min + (key.max - key.min) * share;
    }
    case KeyType::kFlag:
      return *rc::gen::arbitrary<bool>();
    case KeyType::kSeed:
      break;
  }
  return *rc::gen::arbitrary<std::uint64_t>();
}

TEST(ExperimentFileTest, APhysicsThatIsNotListedIsTakenAndWritten) {
  const Result<Experiment> experiment = ParseToy("scenario = 'marching'\nphysics = 'relaxation'");
  ASSERT_TRUE(experiment.ok()) << experiment.error().message;
  EXPECT_EQ(experiment->physics, sim::PhysicsKind::kRelaxation);
  const std::string written = WriteExperiment(*experiment, {}, ToyCatalogue());
  EXPECT_EQ(ParseToy(written)->physics, sim::PhysicsKind::kRelaxation);
  EXPECT_EQ(ErrorOf("scenario = 'marching'\nphysics = 'none'"),
            "toy.toml:2:1: physics = \"none\" is unknown, allowed box2d, impulse");
}

RC_GTEST_PROP(ExperimentFileTest, WhatIsWrittenReadsBackAsTheSame, ()) {
  Experiment experiment = *ParseToy("scenario = 'marching'");
  for (const Key& key : KeysOf(experiment)) {
    if (key.path == "name" || key.path == "scenario" || key.path == "controller") continue;
    key.set(experiment, AllowedValue(key));
  }
  // Rules that span keys.
  experiment.search.population &= ~1;
  double& lag = experiment.search.parameters["lag"];
  lag = std::min(lag, experiment.search.population - 1.0);
  if (experiment.search.algorithm == "steady-state" &&
      experiment.search.reevaluation == Reevaluation::kPopulation) {
    experiment.search.reevaluation = Reevaluation::kChildren;
  }
  experiment.requirements = *rc::gen::element<std::string>("a = speed > 1\n", "step = tick\na = time > 0 \n");
  experiment.search.cells = *rc::gen::element<std::string>("", "strides:0:10:4");
  if (const auto runs = experiment.search.parameters.find("runs"); runs != experiment.search.parameters.end())
    runs->second = 1e8;  // an archive refuses what cannot fill a cell
  if (experiment.search.algorithm == "archive") experiment.search.parameters.erase("objective");
  GenomeSpec& genome = experiment.genome;
  genome.genes = std::max(genome.genes, 1);
  genome.step = *rc::gen::element(0.0, 0.1, 0.05, 1.0 / 3.0);
  genome.position_min = -2.5;
  genome.position_max = 2.5;
  genome.length_max = genome.length_min + 1.0;
  genome.width_max = genome.width_min + 1.0;
  genome.speed_min = 0.005;
  genome.speed_max = std::max(genome.speed_max, 0.006);
  if (genome.length_max > 50.0 || genome.width_max > 50.0) RC_DISCARD("beyond the range");
  const double side = experiment.arena.side;
  experiment.arena = {.side = side, .wall_thickness = std::min(experiment.arena.wall_thickness, side / 2.0)};

  const std::string text = WriteExperiment(experiment, {"header"}, ToyCatalogue());
  const Result<Experiment> read = ParseToy(text);
  if (!read.ok()) RC_FAIL(read.error().message);
  for (const Key& key : KeysOf(experiment)) RC_ASSERT(key.get(*read) == key.get(experiment));
  RC_ASSERT(read->scenario_parameters == experiment.scenario_parameters);
  RC_ASSERT(read->controller_parameters == experiment.controller_parameters);
  RC_ASSERT(WriteExperiment(*read, {"header"}, ToyCatalogue()) == text);
}

// A plug-in as a master knows it.
std::string KnowPatrol() {
  controllers::PluginInfo plugin{
      .hash = std::string(64, 'd'), .file = "libpatrol.so", .description = "", .controllers = {}};
  plugin.controllers = {{"guard", "patrol", "guards", kFastControllerParameters, nullptr}};
  plugin.scenarios = {{.name = "patrol",
                       .description = "go everywhere",
                       .default_controller = "guard",
                       .parameters = {{"time_limit", "s", 10, 1, 60, false, "length of a run"}},
                       .metrics = {}}};
  EXPECT_TRUE(controllers::AddPlugin(plugin).ok());
  return plugin.hash;
}

TEST(ExperimentFileTest, FindsScenarioAndControllerInAPlugin) {
  Catalogue catalogue = ToyCatalogue();
  catalogue.plugins = {KnowPatrol()};
  const Result<Experiment> experiment = ParseExperiment(
      "scenario = 'patrol'\n[scenario_parameters]\ntime_limit = 5\n", "toy.toml", {}, catalogue);
  ASSERT_TRUE(experiment.ok()) << experiment.error().message;
  EXPECT_EQ(experiment->scenario_plugin, catalogue.plugins.front());
  EXPECT_EQ(experiment->controller, "guard");
  EXPECT_EQ(experiment->plugin, catalogue.plugins.front());
  EXPECT_THAT(experiment->scenario_parameters, ElementsAre(Pair("time_limit", 5.0)));

  const std::string text = WriteExperiment(*experiment, {}, catalogue);
  EXPECT_THAT(text, HasSubstr("\nscenario_plugin = \"dddd"));
  const Result<Experiment> read = ParseToy(text);  // the file says in which library they are
  ASSERT_TRUE(read.ok()) << read.error().message;
  EXPECT_EQ(WriteExperiment(*read, {}, catalogue), text);
}

TEST(ExperimentFileTest, NamesTheScenarioNearestToAPluginsAndTheLibraryThatIsNotHere) {
  Catalogue catalogue = ToyCatalogue();
  catalogue.plugins = {KnowPatrol()};
  EXPECT_EQ(ParseExperiment("scenario = 'patrols'", "toy.toml", {}, catalogue).error().message,
            "toy.toml:1:1: unknown scenario 'patrols'; did you mean 'patrol'?");
  EXPECT_EQ(ErrorOf("scenario = 'patrol'"),
            "toy.toml:1:1: unknown scenario 'patrol'; known: marching, waiting");
  const std::string elsewhere = "scenario = 'patrol'\nscenario_plugin = '" + std::string(64, 'e') + "'";
  EXPECT_THAT(ErrorOf(elsewhere), HasSubstr("toy.toml:2:1: scenario_plugin = \"eeee"));
  EXPECT_EQ(ErrorOf("scenario = 'patrol'\nscenario_plugin = 'libpatrol.so'"),
            "toy.toml:2:1: scenario_plugin = \"libpatrol.so\" is no SHA-256 of 64 hexadecimal digits; name "
            "files by plugins = [\"FILE\"]");
}

TEST(ExperimentFileTest, SaysNothingOfAPluginWhereTheScenarioIsBuiltIn) {
  EXPECT_THAT(WriteExperiment(ParseToy("scenario = 'marching'").value(), {}, ToyCatalogue()),
              testing::Not(HasSubstr("plugin")));
}

}  // namespace
}  // namespace gauntlet
