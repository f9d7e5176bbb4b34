// Covers: controllers/examples/light_flocking_registry.cc, controllers/flocking/flocking_registry.cc,
// controllers/foraging/foraging_registry.cc, controllers/generic/generic_registry.cc,
// controllers/partitioning/partitioning_registry.cc
#include "controllers/registry.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include "controllers/flocking/flocking_registry.h"
#include "gmock/gmock.h"
#include "gtest/gtest.h"
#include "worker/run_executor.h"

namespace gauntlet::controllers {
namespace {

using ::testing::StartsWith;

std::string ErrorOf(const sim::RunSpec& spec) {
  const auto scenario = CreateScenario(spec);
  return scenario.ok() ? "" : scenario.error().message;
}

sim::RunSpec FlockingSpec() {
  sim::RunSpec spec;
  spec.scenario = "flocking";
  spec.controller = "flocking";
  return spec;
}

void ExpectSane(std::span<const ParameterInfo> infos) {
  std::set<std::string_view> names;
  for (const ParameterInfo& info : infos) {
    SCOPED_TRACE(info.name);
    EXPECT_TRUE(names.insert(info.name).second) << "twice";
    EXPECT_LT(info.min, info.max);
    EXPECT_GE(info.default_value, info.min);
    EXPECT_LE(info.default_value, info.max);
    EXPECT_FALSE(info.description.empty());
    EXPECT_TRUE(!info.integer || info.default_value == std::floor(info.default_value));
  }
  EXPECT_TRUE(ResolveParameters(infos, {}).ok());
}

TEST(Registry, EveryDefaultLiesInItsRangeAndEveryNameIsUnique) {
  std::set<std::string_view> names;
  for (const ScenarioInfo& scenario : Scenarios()) {
    SCOPED_TRACE(scenario.name);
    EXPECT_TRUE(names.insert(scenario.name).second);
    ExpectSane(scenario.parameters);
    const ControllerInfo* controller = FindController(scenario.default_controller);
    ASSERT_NE(controller, nullptr);
    EXPECT_TRUE(scenario.Takes(*controller));
  }
  names.clear();
  for (const ControllerInfo& controller : Controllers()) {
    SCOPED_TRACE(controller.name);
    EXPECT_TRUE(names.insert(controller.name).second);
    ExpectSane(controller.parameters);
    EXPECT_NE(FindScenario(controller.scenario), nullptr);
  }
}

TEST(Registry, EveryControllerRunsInItsScenarioOnAnEmptyArena) {
  for (const ControllerInfo& controller : Controllers()) {
    sim::RunSpec spec;
    spec.scenario = controller.scenario;
    spec.controller = controller.name;
    EXPECT_EQ(ErrorOf(spec), "") << controller.name;
  }
}

TEST(Registry, KnowsTheFlockingBehaviour) {
  ASSERT_NE(FindScenario("flocking"), nullptr);
  ASSERT_NE(FindController("flocking"), nullptr);
  ASSERT_NE(FindController("flocking-improved"), nullptr);
  EXPECT_EQ(FindScenario("flock"), nullptr);
  EXPECT_EQ(FindController(""), nullptr);
}

TEST(ResolveParameters, FillsInDefaultsAndKeepsWhatWasGiven) {
  const auto resolved = ResolveParameters(FindController("flocking")->parameters, {{"bird_speed", 0.1}});
  ASSERT_TRUE(resolved.ok());
  EXPECT_EQ(resolved->at("bird_speed"), 0.1);
  EXPECT_EQ(resolved->at("separation_distance"), 0.25);
  EXPECT_EQ(resolved->size(), FindController("flocking")->parameters.size());
}

TEST(ResolveParameters, NamesTheNearestKnownParameter) {
  const auto resolved = ResolveParameters(FindController("flocking")->parameters, {{"bird_sped", 0.1}});
  ASSERT_FALSE(resolved.ok());
  EXPECT_EQ(resolved.error().message, "unknown parameter 'bird_sped'; did you mean 'bird_speed'?");
}

TEST(ResolveParameters, ListsWhatThereIsWhenNothingIsNear) {
  const auto resolved = ResolveParameters(FindController("flocking")->parameters, {{"catch_up_gain", 2.0}});
  ASSERT_FALSE(resolved.ok());
  EXPECT_EQ(
      resolved.error().message,
      "unknown parameter 'catch_up_gain'; known: bird_speed, turn_rate, straight_within, "
      "turning_speed_factor, turn_angle, obstacle_distance, obstacle_speed_factor, separation_distance, "
      "wander_turn_probability, wander_turn_limit");
}

TEST(ResolveParameters, RefusesValuesOutOfRange) {
  const auto infos = FindScenario("flocking")->parameters;
  const auto too_fast = ResolveParameters(infos, {{"prey_speed", 0.5}});
  ASSERT_FALSE(too_fast.ok());
  EXPECT_EQ(too_fast.error().message,
            "parameter 'prey_speed' = 0.5 m/s is out of range: from 0.005 to 0.3 m/s");
  EXPECT_FALSE(ResolveParameters(infos, {{"prey_speed", std::nan("")}}).ok());
  EXPECT_FALSE(ResolveParameters(infos, {{"prey_speed", std::numeric_limits<double>::infinity()}}).ok());
  EXPECT_TRUE(ResolveParameters(infos, {{"prey_speed", 0.3}}).ok());
}

TEST(ResolveParameters, RefusesFractionsWhereOnlyWholeNumbersMakeSense) {
  const auto resolved = ResolveParameters(FindScenario("flocking")->parameters, {{"birds", 9.5}});
  ASSERT_FALSE(resolved.ok());
  EXPECT_EQ(resolved.error().message, "parameter 'birds' = 9.5 is not a whole number");
}

TEST(CreateScenario, RefusesUnknownNames) {
  sim::RunSpec spec = FlockingSpec();
  spec.controller = "flocking-improve";
  EXPECT_EQ(ErrorOf(spec), "unknown controller 'flocking-improve'; did you mean 'flocking-improved'?");
  spec = FlockingSpec();
  spec.scenario = "folcking";
  EXPECT_EQ(ErrorOf(spec), "unknown scenario 'folcking'; did you mean 'flocking'?");
}

TEST(CreateScenario, RefusesParametersOfAnotherController) {
  sim::RunSpec spec = FlockingSpec();
  spec.controller_parameters = {{"catch_up_distance", 0.4}};
  EXPECT_THAT(ErrorOf(spec), StartsWith("unknown parameter 'catch_up_distance'"));
  spec.controller = "flocking-improved";
  EXPECT_EQ(ErrorOf(spec), "");
}

TEST(CreateScenario, BeginsWithTheRuleThatTheTestCaseBreaks) {
  sim::RunSpec spec = FlockingSpec();
  spec.test_case.obstacles = {{0.0, 0.0, 7.0, 0.2, 0.0}};
  EXPECT_THAT(ErrorOf(spec), StartsWith("no-path: "));
  spec.test_case.obstacles = {{2.5, 2.5, 0.4, 0.4, 0.0}};
  EXPECT_THAT(ErrorOf(spec), StartsWith("start-blocked: "));
}

TEST(CreateScenario, RefusesADefinitionOfAScenarioThatHasNone) {
  sim::RunSpec spec = FlockingSpec();
  spec.definition = "fitness = \"1\"\n";
  EXPECT_EQ(ErrorOf(spec), "the scenario 'flocking' takes no definition");
}

TEST(FlockingParameters, TurnSecondsIntoTicks) {
  const FlockingSettings settings =
      FlockingParameters().Read(*ResolveParameters(FlockingParameters().infos(), {}));
  EXPECT_EQ(settings.tick_limit, 9000);
  EXPECT_EQ(settings.split.link.memory, 20);
  EXPECT_EQ(settings.split.rejoin, 50);
  EXPECT_EQ(settings.split.half_window, 5);
}

TEST(BirdParameters, OnlyTheImprovedBirdCatchesUp) {
  const auto original = BirdParameters().Read(*ResolveParameters(BirdParameters().infos(), {}));
  EXPECT_EQ(original.catch_up_gain, 1.0);
  const auto improved = ImprovedBirdParameters().Read(
      *ResolveParameters(ImprovedBirdParameters().infos(), {{"catch_up_gain", 1.5}}));
  EXPECT_EQ(improved.catch_up_gain, 1.5);
  EXPECT_EQ(improved.catch_up_distance, 0.3);
}

TEST(Registry, EveryScenarioSaysHowLongItsRunsMayBe) {
  for (const ScenarioInfo& scenario : Scenarios()) {
    SCOPED_TRACE(scenario.name);
    const auto resolved = ResolveParameters(scenario.parameters, {{std::string(scenario.time_limit), 7.0}});
    ASSERT_TRUE(resolved.ok()) << resolved.error().message;
    EXPECT_EQ(scenario.TimeLimit(*resolved), 7.0);
    EXPECT_EQ(scenario.TimeLimit({}),
              ResolveParameters(scenario.parameters, {})->at(std::string(scenario.time_limit)));
  }
}

TEST(Registry, EveryFailureTypeHasItsOwnNumberAndName) {
  for (const ScenarioInfo& scenario : Scenarios()) {
    SCOPED_TRACE(scenario.name);
    std::set<int> numbers;
    std::set<std::string> labels;
    for (const FailureType& failure : scenario.failure_types.types) {
      EXPECT_GE(failure.type, 0);
      EXPECT_FALSE(failure.name.empty());
      EXPECT_TRUE(numbers.insert(failure.type).second) << failure.type;
      EXPECT_TRUE(labels.insert(failure.name).second) << failure.name;
    }
  }
  EXPECT_EQ(FindScenario("flocking")->failure_types.types.size(), 20U);
  EXPECT_EQ(FindScenario("foraging")->failure_types.types.size(), 3U);
  EXPECT_EQ(FindScenario("task-partitioning")->failure_types.types.size(), 1U);
  EXPECT_TRUE(FindScenario("light-flocking")->failure_types.types.empty());
}

TEST(Registry, EveryScenarioHasMetricsThatDescribeBehaviour) {
  for (const ScenarioInfo& scenario : Scenarios()) {
    EXPECT_TRUE(std::ranges::any_of(scenario.metrics, &MetricInfo::descriptor)) << scenario.name;
  }
}

TEST(Registry, ThePlaceOfAFailureIsMeasuredInMetres) {
  for (const ScenarioInfo& scenario : Scenarios()) {
    if (!scenario.failures.place) continue;
    EXPECT_GT(scenario.failures.place->same_within, 0.0) << scenario.name;
    for (const std::string_view name : {scenario.failures.place->x, scenario.failures.place->y}) {
      const MetricInfo* metric = FindMetric(scenario, name);
      ASSERT_NE(metric, nullptr) << scenario.name << " " << name;
      EXPECT_EQ(metric->unit, "m") << name;
      EXPECT_TRUE(metric->descriptor) << name;
    }
  }
  EXPECT_TRUE(FindScenario("flocking")->failures.place.has_value());
}

TEST(Registry, EveryMetricAScenarioReportsIsDescribed) {
  for (const ScenarioInfo& info : Scenarios()) {
    sim::RunSpec spec;
    spec.scenario = info.name;
    spec.controller = info.default_controller;
    spec.scenario_parameters[std::string(info.time_limit)] = 2.0;
    if (info.check_definition) spec.definition = "fitness = 1\nfailure = 0\n";
    const sim::RunResult result = worker::Run(spec);
    ASSERT_EQ(result.verdict, sim::Verdict::kCompleted) << result.message;
    EXPECT_FALSE(result.metrics.empty());
    for (const auto& [name, value] : result.metrics) {
      EXPECT_NE(FindMetric(info, name), nullptr) << info.name << " " << name;
    }
    EXPECT_EQ(FindMetric(info, "no_such_metric"), nullptr);
  }
}

}  // namespace
}  // namespace gauntlet::controllers
