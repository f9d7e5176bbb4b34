// Covers: search/search_setup.cc, search/search_table.cc

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "controllers/registry.h"
#include "search/experiment/experiment_file.h"
#include "search/search_table.h"
#include "tests/search/toy_search.h"

namespace gauntlet {
namespace {

TEST(MakeSearchTest, MakesTheSearchOfTheExperiment) {
  SearchSetup setup = ToySetup();
  SearchSpec& spec = setup.experiment.search;
  const auto genetic = RowOf(setup.experiment).make(setup);
  ASSERT_TRUE(genetic.ok());
  EXPECT_EQ((*genetic)->Progress().evaluations_planned, 1000U);
  EXPECT_GE(StatisticOf(**genetic, "clone_rate"), 0.0);

  SetAlgorithm(setup, "random");
  spec.parameters["cases"] = 12;
  const auto random = RowOf(setup.experiment).make(setup);
  ASSERT_TRUE(random.ok());
  EXPECT_EQ((*random)->Progress().evaluations_planned, 12U);
}

TEST(SpecOfRun, HasTheExperimentsSettingsTheCaseAndTheSeedOfTheReplicate) {
  Experiment experiment = ToySetup().experiment;
  experiment.controller_parameters = {{"max_speed", 0.07}};
  experiment.physics = sim::PhysicsKind::kBox2d;
  experiment.disturbances.faults = {{.robot = 1, .tick = 50}};
  EvaluationRequest evaluation{.individual = 3, .evaluation = 2};
  evaluation.test_case.side_x = 7.5;
  const sim::RunSpec spec = SpecOfRun(experiment, evaluation, 4);
  EXPECT_EQ(spec.scenario, experiment.scenario);
  EXPECT_EQ(spec.controller_parameters, experiment.controller_parameters);
  EXPECT_EQ(spec.physics, sim::PhysicsKind::kBox2d);
  EXPECT_EQ(spec.disturbances.faults.size(), 1U);
  EXPECT_EQ(spec.test_case.side_x, 7.5);
  EXPECT_EQ(spec.seed, RunSeed(experiment, evaluation, 4));
  EXPECT_NE(spec.seed, SpecOfRun(experiment, evaluation, 5).seed);
}

TEST(MakeSearchTest, AListOfCasesCannotBeMadeFromAnExperimentAlone) {
  Experiment experiment = ToySetup().experiment;
  experiment.search.algorithm = "cases";
  const auto search = MakeSearch(experiment);
  ASSERT_FALSE(search.ok());
  EXPECT_EQ(search.error().message,
            "search.algorithm = \"cases\" needs a list of test cases: use `gauntlet evaluate`");
}

TEST(MakeSearchTest, AFaultOfARobotThatTheSwarmDoesNotHaveIsRefused) {
  Experiment experiment = ToySetup().experiment;
  experiment.scenario = "foraging";
  experiment.controller = "foraging";
  experiment.controller_parameters.clear();
  const auto parameters =
      controllers::ResolveParameters(controllers::FindScenario("foraging")->parameters, {{"robots", 10.0}});
  ASSERT_TRUE(parameters.ok());
  experiment.scenario_parameters = *parameters;
  experiment.disturbances.faults = {{.robot = 10, .device = sim::Device::kWheels, .tick = 500}};
  const auto search = MakeSearch(experiment);
  ASSERT_FALSE(search.ok());
  EXPECT_EQ(search.error().message,
            "no run can begin, even without obstacles: bad-fault: 10:wheels@500: robot 10, tick 500; this "
            "swarm has robots 0 to 9, ticks count from 0");
  experiment.disturbances.faults[0].robot = 9;
  EXPECT_TRUE(MakeSearch(experiment).ok());
}

TEST(MakeSearchTest, MoreRandomFaultsThanRobotsOfTheRoleAreRefused) {
  const auto made = [](const std::vector<std::string>& settings) {
    const auto search = MakeSearch(*LoadExperiment("flocking", settings, BuiltInCatalogue()));
    return search.ok() ? "" : search.error().message;
  };
  EXPECT_EQ(made({"random_faults.count=10"}), "");
  EXPECT_EQ(
      made({"random_faults.count=11"}),
      "no run can begin, even without obstacles: bad-fault: random_faults.count = 11; this swarm has 10 "
      "robots under test, so 0 to 10 of them may be faulty");
  EXPECT_EQ(made({"random_faults.count=11", "random_faults.role=all"}), "");
  EXPECT_THAT(made({"random_faults.count=12", "random_faults.role=all"}),
              testing::EndsWith("this swarm has 11 robots, so 0 to 11 of them may be faulty"));
}

TEST(SearchIdentity, KnowsRandomFaultsOnlyWhereARobotIsDrawn) {
  const auto identity = [](const std::vector<std::string>& settings) {
    return SearchIdentity(SetupOf(*LoadExperiment("flocking", settings, BuiltInCatalogue()), {}));
  };
  EXPECT_EQ(identity({"random_faults.what=wheels", "random_faults.tick=9"}), identity({}));
  EXPECT_THAT(identity({}), testing::Not(testing::HasSubstr("random_faults")));
  EXPECT_THAT(identity({"random_faults.count=2", "random_faults.what=wheels"}),
              testing::AllOf(testing::HasSubstr("random_faults.count = 2\nrandom_faults.what = \"wheels\"\n"),
                             testing::Not(testing::HasSubstr("random_faults.role"))));
}

TEST(MakeSearchTest, UnknownScenarioIsNamed) {
  Experiment experiment = ToySetup().experiment;
  experiment.scenario = "juggling";
  const auto search = MakeSearch(experiment);
  ASSERT_FALSE(search.ok());
  EXPECT_EQ(search.error().kind, ErrorKind::kNotFound);
  EXPECT_EQ(search.error().message, "there is no scenario 'juggling'");
}

TEST(MakeSearchTest, ASwarmThatDoesNotFitIntoTheEmptyArenaIsRefused) {
  Experiment experiment = ToySetup().experiment;
  experiment.scenario = "foraging";
  experiment.controller = "foraging";
  experiment.controller_parameters.clear();
  const auto defaults = controllers::ResolveParameters(controllers::FindScenario("foraging")->parameters,
                                                       {{"robots", 100.0}, {"spawn_radius", 0.4}});
  ASSERT_TRUE(defaults.ok());
  experiment.scenario_parameters = *defaults;
  auto search = MakeSearch(experiment);
  ASSERT_FALSE(search.ok());
  EXPECT_EQ(search.error().kind, ErrorKind::kInvalidInput);
  EXPECT_THAT(search.error().message, testing::HasSubstr("no-room-to-spawn: only "));
  experiment.scenario_parameters["robots"] = 10.0;
  search = MakeSearch(experiment);
  EXPECT_TRUE(search.ok()) << search.error().message;
}

TEST(CaseHash, KnowsWhereAnArenaLies) {
  sim::TestCase test_case;
  const std::uint64_t around_origin = CaseHash(test_case);
  test_case.center = {0.0, 1.0};
  EXPECT_NE(CaseHash(test_case), around_origin);
  test_case.center = {1.0, 0.0};
  EXPECT_NE(CaseHash(test_case), around_origin);
  test_case.center = {0.0, 0.0};
  EXPECT_EQ(CaseHash(test_case), around_origin);
}

}  // namespace
}  // namespace gauntlet
