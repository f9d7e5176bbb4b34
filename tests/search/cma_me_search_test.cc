#include "search/archive/cma_me_search.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>

#include "search/search_table.h"
#include "tests/search/toy_search.h"

namespace gauntlet {
namespace {

SearchSetup CmaMeSetup(int runs) {
  SearchSetup setup = ToySetup();
  setup.experiment.scenario = "flocking";
  SetAlgorithm(setup, "cma-me");
  setup.experiment.search.parameters["runs"] = runs;
  return setup;
}

std::unique_ptr<CmaMeSearch> MakeCmaMe(const SearchSetup& setup) {
  return std::move(CmaMeSearch::Create(setup)).value();
}

// A swarm that splits at the first obstacle, and fails there when that is long. It is the tougher the nearer
// all others are to one corner.
EvaluationOutcome SplitsAtTheFirst(const EvaluationRequest& request) {
  const sim::Genome& obstacles = request.test_case.obstacles;
  RunOutcome run;
  run.metrics = {{"split_x", obstacles.front().x}, {"split_y", obstacles.front().y}};
  run.total_failure = obstacles.front().length > 0.6;
  for (std::size_t i = 1; i < obstacles.size(); ++i)
    run.fitness += std::hypot(obstacles[i].x - 2.0, obstacles[i].y + 2.0);
  return OutcomeOfRuns(request.individual, request.evaluation, {run});
}

using ToyOutcome = EvaluationOutcome (*)(const EvaluationRequest&);

// Tells at most `at_once` outcomes between two calls of Ask, until `evaluations` are told; returns what was
// asked, and adds what was told.
std::vector<EvaluationRequest> DriveTo(CmaMeSearch& search, std::uint64_t evaluations, std::size_t at_once,
                                       std::vector<EvaluationOutcome>* told = nullptr,
                                       ToyOutcome outcome_of = SplitsAtTheFirst) {
  std::vector<EvaluationRequest> all;
  for (std::size_t next = 0; search.Progress().evaluations_done < evaluations;) {
    std::ranges::move(search.Ask(), std::back_inserter(all));
    if (next == all.size()) break;
    for (std::size_t i = 0; i < at_once && next < all.size(); ++i, ++next) {
      if (search.Progress().evaluations_done == evaluations) break;
      const EvaluationOutcome outcome = outcome_of(all[next]);
      if (told != nullptr) told->push_back(outcome);
      search.Tell(outcome);
    }
  }
  return all;
}

TEST(CmaMeSearchTest, FillsTheCellsWithTougherCasesThanRandomOnes) {
  const SearchSetup setup = CmaMeSetup(4000);
  const auto search = MakeCmaMe(setup);
  EXPECT_EQ(DriveTo(*search, 5000, 7).size(), 4000U) << "the budget, to the run";
  EXPECT_TRUE(search->Progress().finished);
  EXPECT_GE(search->Population().size(), 20U) << "of 25";
  const DescriptorGrid grid(search->Archive().axes);
  std::map<std::size_t, double> of_random;
  sim::RandomStream random(1, sim::StreamPurpose::kTest);
  for (int i = 0; i < 4000; ++i) {
    const EvaluationRequest request{.test_case = MakeGenerator(setup).RandomTestCase(random).value()};
    const sim::ObstacleGene& first = request.test_case.obstacles.front();
    double& best = of_random.try_emplace(grid.CellOf({first.x, first.y}), 1e9).first->second;
    best = std::min(best, SplitsAtTheFirst(request).fitness);
  }
  for (const Individual& elite : search->Population()) {
    const sim::ObstacleGene& first = elite.test_case.obstacles.front();
    EXPECT_LT(elite.fitness, of_random.at(grid.CellOf({first.x, first.y}))) << elite.id;
  }
}

TEST(CmaMeSearchTest, GivesTheToughestFailureOfEachCell) {
  const auto search = MakeCmaMe(CmaMeSetup(600));
  const DescriptorGrid grid(search->Archive().axes);
  std::map<std::size_t, EvaluationRequest> toughest;
  for (const EvaluationRequest& request : DriveTo(*search, 600, 1)) {
    const sim::ObstacleGene& first = request.test_case.obstacles.front();
    const auto [here, is_new] = toughest.try_emplace(grid.CellOf({first.x, first.y}), request);
    if (!is_new && SplitsAtTheFirst(request).fitness < SplitsAtTheFirst(here->second).fitness)
      here->second = request;
  }
  std::vector<IndividualId> expected;
  for (const auto& [cell, request] : toughest) {
    if (SplitsAtTheFirst(request).runs.front().total_failure) expected.push_back(request.individual);
  }
  std::vector<IndividualId> elites;
  for (const Individual& elite : search->Population()) elites.push_back(elite.id);
  EXPECT_EQ(elites, expected);
  ASSERT_EQ(search->Archive().failures.size(), expected.size());
  EXPECT_LT(expected.size(), toughest.size()) << "some did not fail";
  EXPECT_EQ(search->Archive().failures.front().individual, expected.front());
  EXPECT_EQ(search->Archive().failures.front().failures, 1);
}

TEST(CmaMeSearchTest, NewCellsCountMostThenImprovedOnesThenTheRest) {
  using enum EmitterRank::Entry;
  std::vector<EmitterRank> ranks = {{kNone, 0.1, 0}, {kImprovedCell, -0.1, 1}, {kImprovedCell, -0.4, 2},
                                    {kNone, 0.2, 3}, {kNewCell, 0.9, 4},       {kNewCell, 0.8, 5},
                                    {kNone, 0.1, 6}};
  std::ranges::sort(ranks);
  std::vector<std::size_t> places;
  for (const EmitterRank& rank : ranks) places.push_back(rank.place);
  EXPECT_THAT(places, testing::ElementsAre(5, 4, 2, 1, 0, 6, 3));
}

TEST(CmaMeSearchTest, TheMomentOfAskingChangesNothing) {
  const auto one_by_one = MakeCmaMe(CmaMeSetup(500));
  const auto in_batches = MakeCmaMe(CmaMeSetup(500));
  EXPECT_TRUE(SameRequests(DriveTo(*one_by_one, 500, 1), DriveTo(*in_batches, 500, 100)));
  EXPECT_EQ(one_by_one->Statistics(), in_batches->Statistics());
}

TEST(CmaMeSearchTest, ARestoredSearchGoesOnWithTheSameRequests) {
  const auto whole = MakeCmaMe(CmaMeSetup(700));
  const std::vector<EvaluationRequest> asked = DriveTo(*whole, 700, 5);
  const auto first = MakeCmaMe(CmaMeSetup(300));  // goes on for longer
  std::vector<EvaluationOutcome> told;
  DriveTo(*first, 300, 5, &told);
  ASSERT_TRUE(first->AtBoundary());
  const auto second = MakeCmaMe(CmaMeSetup(700));
  ASSERT_TRUE(RestoreState(*second, StateOf(*first), told).ok());
  EXPECT_EQ(second->Archive().failures.size(), first->Archive().failures.size());
  EXPECT_TRUE(SameRequests(DriveTo(*second, 700, 9), {asked.begin() + 300, asked.end()}));
  EXPECT_EQ(second->Statistics(), whole->Statistics());
  told.pop_back();
  EXPECT_FALSE(RestoreState(*MakeCmaMe(CmaMeSetup(700)), StateOf(*first), told).ok());
}

TEST(CmaMeSearchTest, AnEmitterThatFindsNothingBeginsAnew) {
  const auto search = MakeCmaMe(CmaMeSetup(600));
  DriveTo(*search, 600, 3, nullptr, [](const EvaluationRequest& request) {
    EvaluationOutcome outcome = SplitsAtTheFirst(request);
    outcome.runs.front().metrics.front().second = controllers::kNowhere;
    outcome.runs.front().total_failure = false;
    return outcome;
  });
  EXPECT_TRUE(search->Population().empty());
  EXPECT_EQ(StatisticOf(*search, "cells_without_failure"), 0.0) << "where nothing was measured is no cell";
  EXPECT_GE(StatisticOf(*search, "restarts"), 5.0);
}

TEST(CmaMeSearchTest, ARunWithoutAResultEntersNoCell) {
  const auto search = MakeCmaMe(CmaMeSetup(100));
  DriveTo(*search, 100, 3, nullptr, [](const EvaluationRequest& request) {
    EvaluationOutcome outcome = SplitsAtTheFirst(request);
    outcome.runs.front().verdict = sim::Verdict::kCrashed;
    return OutcomeOfRuns(outcome.individual, outcome.evaluation, outcome.runs);
  });
  EXPECT_TRUE(search->Population().empty());
}

TEST(CmaMeSearchTest, EveryCaseIsValidAndOnTheGrid) {
  for (const int genes : {1, 20}) {
    for (const double step : {0.0, 0.5}) {
      SearchSetup setup = CmaMeSetup(150);
      setup.experiment.genome.genes = genes;
      setup.experiment.genome.step = step;
      setup.experiment.genome.width_min = 0.5;
      setup.experiment.genome.width_max = 0.5;
      setup.experiment.genome.length_max = 3.0;
      setup.experiment.genome.moving = 0.3;
      const auto search = MakeCmaMe(setup);
      const std::vector<EvaluationRequest> all = DriveTo(*search, 150, 10);
      EXPECT_EQ(all.size(), 150U);
      bool moves = false;
      for (const EvaluationRequest& request : all) {
        const sim::Genome& obstacles = request.test_case.obstacles;
        EXPECT_EQ(std::ssize(obstacles), genes);
        EXPECT_TRUE(MakeGenerator(setup).Valid(obstacles));
        for (const sim::ObstacleGene& gene : obstacles) {
          moves = moves || gene.Moves();
          EXPECT_EQ(gene.orientation_deg, std::floor(gene.orientation_deg));
          EXPECT_EQ(gene.width, 0.5);
          if (step > 0.0) EXPECT_EQ(gene.x / step, std::floor(gene.x / step));
        }
      }
      EXPECT_TRUE(moves);
    }
  }
}

TEST(CmaMeSearchTest, WithoutCellsOrObstaclesItIsRefused) {
  SearchSetup setup = CmaMeSetup(100);
  setup.experiment.scenario = "light-flocking";
  const auto without_cells = CmaMeSearch::Create(setup);
  ASSERT_FALSE(without_cells.ok());
  EXPECT_EQ(without_cells.error().message,
            "scenario light-flocking does not say along which metrics its failures differ, which "
            "search.algorithm = \"cma-me\" needs: search.cells does");
  setup = CmaMeSetup(100);
  setup.experiment.genome.genes = 0;
  const auto without_obstacles = CmaMeSearch::Create(setup);
  ASSERT_FALSE(without_obstacles.ok());
  EXPECT_THAT(without_obstacles.error().message, testing::StartsWith("genome.genes = 0: search.algorithm"));
}

}  // namespace
}  // namespace gauntlet
