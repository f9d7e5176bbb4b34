#include "study/sets/failure_groups.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>

#include "controllers/registry.h"
#include "search/evolution/genome_generator.h"
#include "search/experiment/experiment_file.h"
#include "search/search_setup.h"
#include "search/search_table.h"
#include "sim/random/random_stream.h"
#include "worker/run_executor.h"

namespace gauntlet {
namespace {

using testing::ElementsAre;
using Metrics = std::vector<std::pair<std::string, double>>;

const std::vector<controllers::FailureKind> kKinds = {{"taken", 0.0, "no item was taken"},
                                                      {"taken", 1e9, "none came home"}};

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

TEST(FailureGroupsTest, ARunFailsAtThePassageNearestToItsPlace) {
  const controllers::ScenarioInfo scenario = ScenarioWithPlaces();
  const FailureWays ways(scenario, {}, {});
  EXPECT_EQ(ways.Of(Metrics{{"x", 1.4}, {"y", 0.3}}).place, sim::Vec2(2.0, 0.0));
  EXPECT_EQ(ways.Of(Metrics{{"x", controllers::kNowhere}, {"y", controllers::kNowhere}}).place, std::nullopt);
  EXPECT_EQ(ways.Of(Metrics{}).place, std::nullopt);
  controllers::ScenarioInfo anywhere = scenario;
  anywhere.failures.passages = nullptr;
  EXPECT_EQ(FailureWays(anywhere, {}, {}).Of(Metrics{{"x", 1.4}, {"y", 0.3}}).place, sim::Vec2(1.4, 0.3));
  EXPECT_EQ(DescribeWay(scenario, {0, sim::Vec2(-0.04, 1.26)}), "near (0.0, 1.3)");
}

TEST(FailureGroupsTest, KindsArePartedAndNamed) {
  controllers::ScenarioInfo scenario = ScenarioWithPlaces();
  scenario.failures.place.reset();
  scenario.failures.kinds = kKinds;
  const FailureWays ways(scenario, {}, {});
  const std::vector<FailureWay> all = {ways.Of(Metrics{{"taken", 3.0}}), ways.Of(Metrics{{"taken", 0.0}}),
                                       ways.Of(Metrics{{"taken", 1.0}})};
  EXPECT_THAT(GroupWays(scenario, all), ElementsAre(0, 1, 0));
  EXPECT_EQ(DescribeWay(scenario, all[1]), "no item was taken");
  EXPECT_EQ(TypicalWay(all), 0U);
}

TEST(FailureGroupsTest, MostRunsSpeakForACase) {
  const std::vector<FailureWay> ways = {{0, sim::Vec2(2.0, 0.0)},
                                        {0, sim::Vec2(0.0, 0.1)},
                                        {1, std::nullopt},
                                        {0, sim::Vec2(0.0, 0.0)},
                                        {0, sim::Vec2(0.0, 0.0)}};
  EXPECT_EQ(TypicalWay(ways), 3U);
}

// Random cases of flocking that fail in most of their runs, with the ways of the failed ones.
struct FailingCase {
  std::vector<FailureWay> ways;
  std::vector<int> types;
};

std::vector<FailingCase> SimulateFailingCases(const controllers::ScenarioInfo& scenario, std::size_t count) {
  constexpr std::uint32_t kRuns = 10;
  const Result<Experiment> experiment = LoadExperiment("flocking", {}, BuiltInCatalogue());
  EXPECT_TRUE(experiment.ok());
  const sim::TestCase empty = EmptyArena(experiment->arena);
  const GenomeGenerator generator(experiment->genome, empty,
                                  scenario.requirements(experiment->scenario_parameters, empty));
  std::vector<FailingCase> cases;
  for (std::uint64_t seed = 1; cases.size() < count; ++seed) {
    sim::RandomStream random(seed, sim::StreamPurpose::kSpawn);
    const Result<sim::TestCase> test_case = generator.RandomTestCase(random);
    EXPECT_TRUE(test_case.ok());
    const FailureWays ways(scenario, experiment->scenario_parameters, *test_case);
    FailingCase failing;
    for (std::uint32_t i = 0; i < kRuns; ++i) {
      const sim::RunResult result = worker::Run(SpecOf(*experiment, *test_case, 1000 * seed + i));
      if (i == 0 && !result.failure.total) break;  // most cases do no harm
      if (!result.failure.total) continue;
      failing.ways.push_back(ways.Of(result.metrics));
      failing.types.push_back(result.failure.type);
    }
    if (2 * failing.ways.size() >= kRuns) cases.push_back(std::move(failing));
  }
  return cases;
}

// The shares of pairs of failed runs that are alike: of one case, and of two different ones.
struct Agreement {
  int alike = 0;
  int pairs = 0;
  void Add(bool same) {
    alike += same ? 1 : 0;
    ++pairs;
  }
  double share() const { return static_cast<double>(alike) / pairs; }
};

// Runs of the second halves are put where the first halves' groups stand, as new runs of a known failure are.
TEST(FailureGroupsTest, RunsOfOneFlockingCaseFallIntoOneGroup) {
  const controllers::ScenarioInfo& scenario = *controllers::FindScenario("flocking");
  const std::vector<FailingCase> cases = SimulateFailingCases(scenario, 40);
  std::vector<FailureWay> known;
  for (const FailingCase& one : cases) {
    const std::span first(one.ways.data(), one.ways.size() / 2);
    known.push_back(first[TypicalWay(first)]);
  }
  const std::vector<std::size_t> groups = GroupWays(scenario, known);
  struct Run {
    std::size_t of_case;
    std::size_t group;
    int type;
  };
  std::vector<Run> runs;
  for (std::size_t i = 0; i < cases.size(); ++i) {
    for (std::size_t j = cases[i].ways.size() / 2; j < cases[i].ways.size(); ++j) {
      const auto distance = [&](const FailureWay& way) {
        return (*way.place - *cases[i].ways[j].place).norm();
      };
      const auto nearest = std::ranges::min_element(known, {}, distance) - known.begin();
      runs.push_back({i, groups[static_cast<std::size_t>(nearest)], cases[i].types[j]});
    }
  }
  Agreement of_one_case, of_two, type_of_one_case, type_of_two;
  for (const Run& a : runs) {
    for (const Run& b : runs) {
      if (&a >= &b) continue;
      (a.of_case == b.of_case ? of_one_case : of_two).Add(a.group == b.group);
      (a.of_case == b.of_case ? type_of_one_case : type_of_two).Add(a.type == b.type);
    }
  }
  const std::size_t count = *std::ranges::max_element(groups) + 1;
  fmt::print(
      "{} cases, {} groups; pairs in one group: {:.2f} of one case, {:.2f} of two; of one type: {:.2f}, "
      "{:.2f}\n",
      cases.size(), count, of_one_case.share(), of_two.share(), type_of_one_case.share(),
      type_of_two.share());
  EXPECT_GE(of_one_case.share(), 0.80);
  EXPECT_LE(of_two.share(), 0.15) << "groups so wide that they say nothing";
  EXPECT_LE(type_of_one_case.share(), 0.25) << "types now tell failures apart: say so in `show`";
}

}  // namespace
}  // namespace gauntlet
