// Covers: controllers/site_selection/site_selection_metrics.cc,
// controllers/site_selection/site_selection_registry.cc
#include "controllers/site_selection/site_selection_scenario.h"

#include <gtest/gtest.h>

#include <set>

#include "controllers/site_selection/site_selection_metrics.h"
#include "tests/controllers/run_support.h"
#include "worker/run_executor.h"

namespace gauntlet::controllers::site_selection {
namespace {

using testing_support::Metric;
using testing_support::SpecOf;
using enum SiteState;

// Two robots, one state each per tick.
StateLog LogOf(std::initializer_list<std::pair<std::uint8_t, std::uint8_t>> ticks) {
  StateLog log(kLoggedStates);
  log.Begin(2, static_cast<sim::Tick>(ticks.size()), 0);
  for (const auto& [first, second] : ticks) {
    log.Add(first);
    log.Add(second);
  }
  return log;
}

TEST(SiteSelectionMetrics, CountTripsAndChanges) {
  const std::uint8_t go_a = Logged(kGo, Site::kA);
  const std::uint8_t at_a = Logged(kSurvey, Site::kA);
  const std::uint8_t go_b = Logged(kGo, Site::kB);
  const StateLog log = LogOf({{go_a, go_b},
                              {go_a, go_b},
                              {at_a, go_b},
                              {Logged(kBack, Site::kA), go_b},
                              {Logged(kTell, Site::kA), go_b},
                              {go_a, go_b},
                              {at_a, go_a}});
  const Trips to_a = TripsTo(log, 2, Site::kA);
  EXPECT_EQ(to_a.visited, 0.5);
  EXPECT_EQ(to_a.trips, 1.0);
  EXPECT_DOUBLE_EQ(to_a.travel, 0.15) << "two ticks and one";
  EXPECT_EQ(TripsTo(log, 2, Site::kB).travel, -1.0);
  EXPECT_EQ(to_a.turned, 1) << "saying the first opinion is no change";
  EXPECT_EQ(to_a.travelling, 0.5);
  EXPECT_EQ(ShareFor(log, 2, Site::kA, 0), 0.0) << "nobody has said anything";
  EXPECT_EQ(ShareFor(log, 2, Site::kA, 1), 0.5);
  EXPECT_EQ(ShareFor(log, 2, Site::kA, 7), 1.0);
}

TEST(SiteSelectionMetrics, ADecisionIsHeldForAMinute) {
  StateLog log(kLoggedStates);
  log.Begin(1, 2000, 0);
  for (int tick = 1; tick <= 1200; ++tick) log.Add(Logged(kTell, tick <= 605 ? Site::kA : Site::kB));
  EXPECT_EQ(DecisionTick(log, 1, 0.9), -1) << "59 s for A, then 59 s for B";
  for (int tick = 0; tick < 10; ++tick) log.Add(Logged(kTell, Site::kB));
  EXPECT_EQ(DecisionTick(log, 1, 0.9), 610);
}

TEST(SiteSelectionFailureTypes, HaveTheirNumbersAndDifferInName) {
  std::set<std::string> names;
  for (const FailureType& type : SiteSelectionFailureTypes().types) {
    EXPECT_EQ(type.type, std::ssize(names));
    names.insert(type.name);
  }
  EXPECT_EQ(names.size(), 36U);
  EXPECT_EQ(SiteSelectionFailureTypes().Find(21)->name,
            "majority for A: few came to the better site, robots stuck");
}

sim::RunSpec SpecWith(double better_side, std::uint64_t seed) {
  sim::RunSpec spec = SpecOf("site-selection", "site-selection", seed);
  spec.scenario_parameters = {{"better_side", better_side}};
  return spec;
}

TEST(SiteSelectionScenario, TheFloorTellsNestAndSitesAndHolds) {
  const SiteSelectionScenarioSettings settings = {.tick_limit = 10,
                                                  .nest_half_width = 0.8,
                                                  .site_depth = 1.0,
                                                  .light_distance = 1.0,
                                                  .worse_quality = 0.5,
                                                  .better_side = 2};
  const SiteSelectionScenario scenario({}, settings, {}, 1);
  EXPECT_EQ(scenario.FloorGrey({0.0, 2.0}), kNestGrey);
  EXPECT_EQ(scenario.FloorGrey({1.4, 0.0}), 1.0);
  EXPECT_EQ(scenario.FloorGrey({2.5, 0.0}), 0.25);
  EXPECT_EQ(scenario.FloorGrey({-2.5, 0.0}), 0.0);
  EXPECT_NEAR(scenario.FloorHolds({-1.8, 1.0}), 0.2, 1e-12);
  EXPECT_EQ(scenario.ground_areas().size(), 3U);
  EXPECT_EQ(scenario.lights()[0].position, sim::Vec2(4.0, 0.0));
}

TEST(SiteSelectionScenario, TheSwarmFindsTheBetterSiteOnEitherSide) {
  for (const double side : {1.0, 2.0}) {
    double fitness = 0.0;
    double travel = 0.0;
    for (std::uint64_t seed = 1; seed <= 10; ++seed) {
      const sim::RunResult result = worker::Run(SpecWith(side, seed));
      ASSERT_EQ(result.verdict, sim::Verdict::kCompleted) << result.message;
      EXPECT_EQ(Metric(result, "better_side"), side);
      fitness += result.fitness / 10.0;
      travel += Metric(result, "travel_better") / 10.0;
    }
    EXPECT_GT(fitness, 0.8) << side;
    EXPECT_NEAR(travel, 24.5, 2.0) << side;
  }
}

TEST(SiteSelectionScenario, TheSeedDrawsTheSideAndARunRepeats) {
  std::set<double> sides;
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    sim::RunSpec spec = SpecWith(0.0, seed);
    spec.scenario_parameters["time_limit"] = 40.0;
    const sim::RunResult result = worker::Run(spec);
    EXPECT_EQ(result.hash, worker::Run(spec).hash);
    sides.insert(Metric(result, "better_side"));
  }
  EXPECT_EQ(sides, (std::set<double>{1.0, 2.0}));
}

TEST(SiteSelectionScenario, ObstaclesOnTheWayToTheBetterSiteBreakIt) {
  int failures = 0;
  for (std::uint64_t seed = 1; seed <= 6; ++seed) {
    sim::RunSpec spec = SpecWith(1.0, seed);
    spec.test_case.obstacles = {{-1.6, -2.6, 1.8, 0.4, 34.0}, {-1.6, 1.3, 1.6, 0.3, 48.0},
                                {2.6, -2.4, 1.4, 0.3, 181.0}, {-2.2, -2.2, 0.8, 0.3, 355.0},
                                {0.7, -0.8, 1.8, 0.3, 284.0}, {1.8, 0.6, 0.6, 0.1, 242.0},
                                {1.8, 0.6, 0.8, 0.1, 277.0},  {0.8, -0.8, 1.9, 0.3, 82.0}};
    const sim::RunResult result = worker::Run(spec);
    ASSERT_EQ(result.verdict, sim::Verdict::kCompleted) << result.message;
    EXPECT_EQ(result.failure.total, result.fitness < 0.5);
    EXPECT_EQ(result.failure.label.starts_with("majority for B"), result.failure.total);
    failures += result.failure.total ? 1 : 0;
  }
  EXPECT_GE(failures, 4);
}

TEST(SiteSelectionScenario, NobodyChangesSidesWhenNobodyComesBack) {
  sim::RunSpec spec = SpecWith(1.0, 1);
  spec.test_case.obstacles = {{1.5, 0.0, 4.8, 0.2, 90.0}};
  const sim::RunResult result = worker::Run(spec);
  EXPECT_EQ(result.fitness, 0.5);
  EXPECT_EQ(Metric(result, "visited_better"), 0.0);
  EXPECT_EQ(Metric(result, "travel_better"), -1.0);
}

}  // namespace
}  // namespace gauntlet::controllers::site_selection
