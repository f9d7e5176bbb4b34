#include "study/sets/failure_groups.h"

#include <gtest/gtest.h>

#include <fmt/format.h>

#include <string>
#include <vector>

#include "controllers/registry.h"
#include "search/evolution/genome_generator.h"
#include "search/experiment/experiment_file.h"
#include "search/search_setup.h"
#include "search/search_table.h"
#include "sim/random/random_stream.h"
#include "study/sets/failure_mechanism.h"
#include "worker/run_executor.h"

namespace gauntlet {
namespace {

using Metrics = std::vector<std::pair<std::string, double>>;

controllers::ScenarioInfo ScenarioWithPlaces() {
  return {
      .name = "toy",
      .description = "",
      .default_controller = "",
      .metrics = {},
      .failures = {.place = {{"x", "y", 1.0}}, .passages = [](const sim::Parameters&, const sim::TestCase&) {
                     return std::vector<sim::Vec2>{{0.0, 0.0}, {2.0, 0.0}};
                   }}};
}

TEST(FailureGroupsTest, ARunFailsInTheSquareOfThePassageNearestToItsPlace) {
  const controllers::ScenarioInfo scenario = ScenarioWithPlaces();
  const FailurePlaces places(scenario, {}, {});
  EXPECT_EQ(places.Of(Metrics{{"x", 1.4}, {"y", 0.3}}), "near (2.0, 0.0)");
  EXPECT_EQ(places.Of(Metrics{{"x", controllers::kNowhere}, {"y", controllers::kNowhere}}), "");
  EXPECT_EQ(places.Of(Metrics{}), "");
  controllers::ScenarioInfo anywhere = scenario;
  anywhere.failures.passages = nullptr;
  EXPECT_EQ(FailurePlaces(anywhere, {}, {}).Of(Metrics{{"x", 1.4}, {"y", -0.3}}), "near (1.0, 0.0)");
  EXPECT_EQ(FailurePlaces(anywhere, {}, {}).Of(Metrics{{"x", 1.6}, {"y", -0.6}}), "near (2.0, -1.0)");
}

std::vector<std::string> Values(int a, int b, int unknown = 0) {
  std::vector<std::string> values(static_cast<std::size_t>(a), "a");
  values.insert(values.end(), static_cast<std::size_t>(b), "b");
  values.insert(values.end(), static_cast<std::size_t>(unknown), "");
  return values;
}

// Wilson's lower bound at 95 % is above a half from 9 of 10, 10 of 12, 15 of 20 on (R: prop.test, correct =
// F).
TEST(FailureGroupsTest, AFeatureLeadsWithTenRunsAndALowerBoundAboveAHalf) {
  EXPECT_FALSE(LeadingOf(Values(9, 0))->leads) << "nine runs are too few";
  EXPECT_FALSE(LeadingOf(Values(8, 2))->leads);
  EXPECT_TRUE(LeadingOf(Values(9, 1))->leads);
  EXPECT_FALSE(LeadingOf(Values(14, 6))->leads);
  const auto leading = LeadingOf(Values(5, 15, 4));
  EXPECT_TRUE(leading->leads);
  EXPECT_EQ(leading->value, "b");
  EXPECT_EQ(leading->runs, 15);
  EXPECT_EQ(leading->of, 20) << "what is not known does not count";
  EXPECT_EQ(LeadingOf(Values(0, 0, 12)), std::nullopt);
}

double Agreement(const std::vector<std::vector<std::string>>& cases) {
  return AgreementWithin(cases).value();
}

TEST(FailureGroupsTest, AgreementIsThatOfRunsOfOneCaseBeyondThatOfTwo) {
  EXPECT_DOUBLE_EQ(Agreement({Values(5, 0), Values(0, 4)}), 1.0);
  // Within: half of the pairs and all, so 3/4; of two cases: 3/4.
  EXPECT_DOUBLE_EQ(Agreement({Values(3, 1), Values(2, 0)}), 0.0);
  // Within: 3/4 again; of two cases: 1/4. (3/4 - 1/4) / (1 - 1/4).
  EXPECT_DOUBLE_EQ(Agreement({Values(2, 0), Values(1, 3)}), 2.0 / 3.0);
  EXPECT_EQ(AgreementWithin(std::vector{Values(5, 0), Values(3, 0)}), std::nullopt) << "nothing differs";
  EXPECT_EQ(AgreementWithin(std::vector{Values(6, 4), Values(0, 1)}), std::nullopt) << "one case";
}

// Random cases of flocking that fail in most of their runs, with the features of the failed ones.
struct FailingCase {
  std::vector<std::string> mechanisms, places, types;
};

std::vector<FailingCase> SimulateFailingCases(std::size_t count) {
  constexpr std::uint32_t kRuns = 20;
  const controllers::ScenarioInfo& scenario = *controllers::FindScenario("flocking");
  const Result<Experiment> experiment = LoadExperiment("flocking", {}, BuiltInCatalogue());
  EXPECT_TRUE(experiment.ok());
  const sim::TestCase empty = EmptyArena(experiment->arena);
  const GenomeGenerator generator(experiment->genome, empty,
                                  scenario.requirements(experiment->scenario_parameters, empty));
  std::vector<FailingCase> cases;
  // Not the cases on which MechanismOf's bounds were chosen.
  for (std::uint64_t seed = 1001; cases.size() < count; ++seed) {
    sim::RandomStream random(seed, sim::StreamPurpose::kSpawn);
    const Result<sim::TestCase> test_case = generator.RandomTestCase(random);
    EXPECT_TRUE(test_case.ok());
    const FailurePlaces places(scenario, experiment->scenario_parameters, *test_case);
    FailingCase failing;
    for (std::uint32_t i = 0; i < kRuns; ++i) {
      const sim::RunResult result = worker::Run(SpecOf(*experiment, *test_case, 1000 * seed + i));
      if (i == 0 && !result.failure.total) break;  // most cases do no harm
      if (!result.failure.total) continue;
      failing.mechanisms.push_back(MechanismOf(scenario, *test_case, result.metrics, result.robots));
      failing.places.push_back(places.Of(result.metrics));
      failing.types.push_back(std::to_string(result.failure.type));
    }
    if (failing.types.size() >= kRunsForGroup) cases.push_back(std::move(failing));
  }
  return cases;
}

// Of cases with a group the share that is in the same one when its failed runs are drawn again from
// themselves.
double Kept(const std::vector<std::vector<std::string>>& cases) {
  constexpr std::uint64_t kDraws = 100;
  sim::RandomStream random(7, sim::StreamPurpose::kSpawn);
  double kept = 0.0, drawn = 0.0;
  for (const std::vector<std::string>& values : cases) {
    const auto leading = LeadingOf(values);
    if (!leading || !leading->leads) continue;
    for (std::uint64_t draw = 0; draw < kDraws; ++draw) {
      std::vector<std::string> again;
      for (std::size_t i = 0; i < values.size(); ++i)
        again.push_back(
            values[static_cast<std::size_t>(random.Uniform() * static_cast<double>(values.size()))]);
      const auto led = LeadingOf(again);
      kept += led->leads && led->value == leading->value ? 1.0 : 0.0;
      ++drawn;
    }
  }
  return kept / drawn;
}

TEST(FailureGroupsTest, RunsOfOneFlockingCaseAgreeInWhatHappensAndWhereAndNotInTheType) {
  std::vector<std::vector<std::string>> mechanisms, places, types;
  for (FailingCase& one : SimulateFailingCases(40)) {
    mechanisms.push_back(std::move(one.mechanisms));
    places.push_back(std::move(one.places));
    types.push_back(std::move(one.types));
  }
  fmt::print("agreement: mechanism {:.2f}, place {:.2f}, type {:.2f}; kept: mechanism {:.3f}, place {:.3f}\n",
             Agreement(mechanisms), Agreement(places), Agreement(types), Kept(mechanisms), Kept(places));
  EXPECT_GE(Agreement(mechanisms), kLeastAgreement);
  EXPECT_GE(Agreement(places), 0.75);
  EXPECT_LT(Agreement(types), 0.25) << "types now tell failures apart: say so in `show`";
  EXPECT_GE(Kept(mechanisms), 0.95);
  EXPECT_GE(Kept(places), 0.95);
}

}  // namespace
}  // namespace gauntlet
