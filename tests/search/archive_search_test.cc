// Covers: search/archive/archive_judge.cc
#include "search/archive/archive_search.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <deque>
#include <map>

#include "search/experiment/experiment_file.h"
#include "search/experiment/objective.h"
#include "search/search_table.h"
#include "tests/search/toy_search.h"

namespace gauntlet {
namespace {

constexpr int kSlots = 20;

SearchSetup ArchiveSetup(int runs) {
  SearchSetup setup = ToySetup();
  setup.experiment.scenario = "flocking";
  SetAlgorithm(setup, "archive");
  setup.experiment.search.parameters["runs"] = runs;
  setup.experiment.search.parameters["slots"] = kSlots;
  return setup;
}

std::unique_ptr<ArchiveSearch> MakeArchive(const SearchSetup& setup, LinePolicy policy = LinePolicy::kAll) {
  return std::move(ArchiveSearch::Create(setup, policy)).value();
}

// A swarm that breaks at the first obstacle within 0.3 m of the line from start to goal.
const sim::ObstacleGene* TrapOf(const sim::TestCase& test_case) {
  for (const sim::ObstacleGene& gene : test_case.obstacles) {
    if (std::abs(gene.x - gene.y) < 0.42) return &gene;
  }
  return nullptr;
}

EvaluationOutcome Outcome(const EvaluationRequest& request, bool fails) {
  const sim::ObstacleGene* trap = TrapOf(request.test_case);
  RunOutcome run;
  run.total_failure = fails;
  run.fitness = fails ? 0.0 : 1.0;
  run.metrics = {{"split_x", trap == nullptr ? 0.0 : trap->x}, {"split_y", trap == nullptr ? 0.0 : trap->y}};
  return OutcomeOfRuns(request.individual, request.evaluation, {run});
}

using ToyFailure = std::function<bool(const EvaluationRequest&)>;

bool BreaksAtTraps(const EvaluationRequest& request) {
  return TrapOf(request.test_case) != nullptr;
}

// Tells at most `at_once` outcomes between two calls of Ask; returns what was asked, in order.
std::vector<EvaluationRequest> Drive(ArchiveSearch& search, std::size_t at_once, const ToyFailure& fails) {
  std::vector<EvaluationRequest> all;
  std::size_t told = 0;
  while (!search.Progress().finished) {
    std::ranges::move(search.Ask(), std::back_inserter(all));
    EXPECT_LE(all.size() - told, static_cast<std::size_t>(kSlots));
    if (told == all.size()) break;
    for (std::size_t i = 0; i < at_once && told < all.size(); ++i, ++told) {
      search.Tell(Outcome(all[told], fails(all[told])));
    }
  }
  return all;
}

TEST(ArchiveSearchTest, FindsOneObstacleForEachPlaceWhereOneIsEnough) {
  const auto search = MakeArchive(ArchiveSetup(1000));
  EXPECT_EQ(Drive(*search, 1, BreaksAtTraps).size(), 1000U) << "the budget, to the run";
  // The line crosses the five cells of the diagonal, and its traps may lie a little beside it.
  EXPECT_GE(search->Population().size(), 5U);
  for (const Individual& elite : search->Population()) {
    EXPECT_EQ(elite.test_case.obstacles.size(), 1U) << elite.id;
    EXPECT_NE(TrapOf(elite.test_case), nullptr);
  }
  EXPECT_EQ(StatisticOf(*search, "cells_with_up_to_1"), StatisticOf(*search, "cells_filled"));
}

TEST(ArchiveSearchTest, TheMomentOfAskingChangesNothing) {
  const auto one_by_one = MakeArchive(ArchiveSetup(400));
  const auto in_batches = MakeArchive(ArchiveSetup(400));
  EXPECT_TRUE(SameRequests(Drive(*one_by_one, 1, BreaksAtTraps), Drive(*in_batches, 100, BreaksAtTraps)));
  EXPECT_EQ(StateOf(*one_by_one), StateOf(*in_batches));
}

TEST(ArchiveSearchTest, ALongerSearchBeginsLikeAShorterOne) {
  const auto shorter = MakeArchive(ArchiveSetup(250));
  const auto longer = MakeArchive(ArchiveSetup(500));
  const std::vector<EvaluationRequest> asked = Drive(*shorter, 7, BreaksAtTraps);
  std::vector<EvaluationRequest> beginning = Drive(*longer, 7, BreaksAtTraps);
  beginning.resize(asked.size());
  EXPECT_TRUE(SameRequests(asked, beginning));

  const auto extended = MakeArchive(ArchiveSetup(500));
  ASSERT_TRUE(RestoreState(*extended, StateOf(*shorter)).ok());
  Drive(*extended, 7, BreaksAtTraps);
  EXPECT_EQ(StateOf(*extended), StateOf(*longer));
}

TEST(ArchiveSearchTest, NoLayoutHasMoreObstaclesThanAllowed) {
  for (const int genes : {1, 2}) {
    SearchSetup setup = ArchiveSetup(1400);
    setup.experiment.genome.genes = genes;
    const auto search = MakeArchive(setup);
    for (const EvaluationRequest& request : Drive(*search, 7, BreaksAtTraps))
      EXPECT_LE(request.test_case.obstacles.size(), static_cast<std::size_t>(genes));
    EXPECT_TRUE(RestoreState(*MakeArchive(setup), StateOf(*search)).ok());
  }
  SearchSetup setup = ArchiveSetup(200);
  setup.experiment.genome.genes = 0;
  const auto without = ArchiveSearch::Create(setup);
  ASSERT_FALSE(without.ok());
  EXPECT_EQ(without.error().message,
            "genome.genes = 0: search.algorithm = \"archive\" looks for obstacles that break the swarm; "
            "allow 1 or more");
}

TEST(ArchiveSearchTest, WhatFailsEveryOtherTimeIsNotAdmitted) {
  const auto search = MakeArchive(ArchiveSetup(600));
  Drive(*search, 1, [](const EvaluationRequest& request) { return request.evaluation % 2 == 0; });
  EXPECT_TRUE(search->Population().empty());
}

TEST(ArchiveSearchTest, AnEliteThatStopsFailingLeaves) {
  const auto search = MakeArchive(ArchiveSetup(1000));
  Drive(*search, 1, [](const EvaluationRequest& request) {
    return BreaksAtTraps(request) && request.evaluation < 3;  // as lucky as those who are chosen
  });
  for (const Individual& elite : search->Population()) EXPECT_LE(elite.evaluations, 5U);
  EXPECT_GT(StatisticOf(*search, "recheck_runs"), 0.0);
}

// All failures are of one kind.
SearchSetup OneCell(int runs) {
  SearchSetup setup = ArchiveSetup(runs);
  setup.experiment.search.cells = "split_x:-3:3:1 split_y:-3:3:1";
  return setup;
}

TEST(ArchiveSearchTest, RowsThatCannotBecomeTheSmallestAreNoLongerTried) {
  const auto search = MakeArchive(OneCell(1400));
  const std::vector<EvaluationRequest> asked = Drive(*search, 1, BreaksAtTraps);
  const auto rows = [&](std::size_t from, std::size_t to) {
    return std::count_if(asked.begin() + static_cast<std::ptrdiff_t>(from),
                         asked.begin() + static_cast<std::ptrdiff_t>(to),
                         [](const EvaluationRequest& request) {
                           const std::size_t obstacles = request.test_case.obstacles.size();
                           return request.parents.empty() && (obstacles == 2 || obstacles == 3);
                         });
  };
  EXPECT_GT(rows(0, 400), 50);
  ASSERT_EQ(StatisticOf(*search, "cells_with_up_to_1"), 1.0);
  EXPECT_LE(rows(1040, 1400), 5) << "while the elite is run again the cell is open";
}

TEST(ArchiveSearchTest, LateWhatIsShorterHasToBeAsReliable) {
  const auto search = MakeArchive(OneCell(1300));
  Drive(*search, 1, [&](const EvaluationRequest& request) {
    if (!BreaksAtTraps(request)) return false;
    if (SizeOf(request.test_case.obstacles).length > 1.5) return true;
    return search->Progress().evaluations_done > ArchiveSearch::kEarly && request.evaluation != 3;
  });
  ASSERT_EQ(search->Population().size(), 1U);
  const LayoutSize size = SizeOf(search->Population().front().test_case.obstacles);
  EXPECT_EQ(size.obstacles, 1U);
  EXPECT_GT(size.length, 1.5) << "shorter ones fail in 7 of 8 runs";
}

TEST(ArchiveSearchTest, ElitesOfOneObstacleAreMovedToWhereMoreAreNeeded) {
  const auto search = MakeArchive(ArchiveSetup(2000));
  std::map<IndividualId, std::size_t> sizes;
  int moved = 0;
  for (const EvaluationRequest& request : Drive(*search, 1, BreaksAtTraps)) {
    const sim::Genome& obstacles = request.test_case.obstacles;
    const bool is_new = sizes.emplace(request.individual, obstacles.size()).second;
    if (!is_new || obstacles.size() != 1 || request.parents.empty()) continue;
    if (sizes.at(request.parents.front()) == 1 && obstacles.front().length >= 1.8) ++moved;
  }
  EXPECT_GT(moved, 20);
}

TEST(ArchiveSearchTest, WhatFailsByLuckLeavesWhereLayoutsFailNowAndThen) {
  std::size_t elites = 0;
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    const auto search = MakeArchive(ArchiveSetup(1000));
    Drive(*search, 1, [seed](const EvaluationRequest& request) {
      const auto draw = static_cast<std::uint32_t>(request.individual * 100 + request.evaluation);
      sim::RandomStream random(seed, sim::StreamPurpose::kTest, draw);
      return BreaksAtTraps(request) && random.Uniform() < 0.4;
    });
    elites += search->Population().size();
  }
  EXPECT_LE(elites, 20U) << "of five or so cells in each search, which a share of failures alone would fill";
}

TEST(ArchiveSearchTest, AControllerThatNeverFailsLeavesAnEmptyArchive) {
  const auto search = MakeArchive(ArchiveSetup(300));
  EXPECT_EQ(Drive(*search, 9, [](const EvaluationRequest&) { return false; }).size(), 300U);
  EXPECT_TRUE(search->Progress().finished);
  EXPECT_TRUE(search->Population().empty());
}

TEST(ArchiveSearchTest, KeepsStartAndGoalFree) {
  SearchSetup setup = ArchiveSetup(200);
  setup.experiment.search.parameters["keep_out"] = 1.0;
  const auto search = MakeArchive(setup);
  for (const EvaluationRequest& request : Drive(*search, 5, BreaksAtTraps)) {
    for (const sim::ObstacleGene& gene : request.test_case.obstacles) {
      EXPECT_GE(Distance(BoxOf(gene), setup.requirements.start), 1.0);
      EXPECT_GE(Distance(BoxOf(gene), setup.requirements.goal), 1.0);
    }
  }
}

TEST(ArchiveSearchTest, ARunThatEndsWithoutAResultIsNoFailure) {
  const auto search = MakeArchive(ArchiveSetup(200));
  std::deque<EvaluationRequest> outstanding;
  while (!search->Progress().finished) {
    std::ranges::move(search->Ask(), std::back_inserter(outstanding));
    RunOutcome crashed;
    crashed.verdict = sim::Verdict::kCrashed;
    crashed.total_failure = true;
    const EvaluationRequest& request = outstanding.front();
    search->Tell(OutcomeOfRuns(request.individual, request.evaluation, {crashed}));
    outstanding.pop_front();
  }
  EXPECT_TRUE(search->Population().empty());
}

bool IsOneLess(const sim::Genome& fewer, const sim::Genome& more) {
  if (fewer.size() + 1 != more.size()) return false;
  return std::ranges::all_of(
      fewer, [&](const sim::ObstacleGene& gene) { return std::ranges::find(more, gene) != more.end(); });
}

TEST(ArchiveSearchTest, RandomDeletionOnlyDrawsCasesAndTakesObstaclesAway) {
  SearchSetup setup = ArchiveSetup(1000);
  SetAlgorithm(setup, "random-deletion");
  const auto search = MakeArchive(setup, LinePolicy::kDeletionOnly);
  std::map<IndividualId, sim::Genome> seen;
  std::size_t deletions = 0;
  for (const EvaluationRequest& request : Drive(*search, 5, BreaksAtTraps)) {
    const sim::Genome& obstacles = request.test_case.obstacles;
    seen.emplace(request.individual, obstacles);
    if (request.parents.empty()) {
      EXPECT_EQ(std::ssize(obstacles), setup.experiment.genome.genes);
      continue;
    }
    ++deletions;
    EXPECT_TRUE(IsOneLess(obstacles, seen.at(request.parents.front()))) << request.individual;
  }
  EXPECT_GT(deletions, 100U);
  EXPECT_GE(StatisticOf(*search, "cells_with_up_to_1"), 3.0) << "one trap is enough";
  for (const char* emitter : {"nearest", "mirrored", "across", "jittered", "recheck"}) {
    EXPECT_EQ(StatisticOf(*search, std::string(emitter) + "_runs"), 0.0) << emitter;
  }
}

// A swarm that breaks at an obstacle within 6 cm of one point, and says how near it came to that.
EvaluationOutcome NearOutcome(const EvaluationRequest& request) {
  double nearest = 10.0;
  for (const sim::ObstacleGene& gene : request.test_case.obstacles)
    nearest = std::min(nearest, std::hypot(gene.x - 1.53, gene.y + 1.27));
  RunOutcome run;
  run.total_failure = nearest < 0.06;
  run.metrics = {{"split_x", 1.5}, {"split_y", -1.3}, {"robustness", (nearest - 0.06) / 10.0}};
  return OutcomeOfRuns(request.individual, request.evaluation, {run});
}

// Runs until the first failure, or the end.
std::size_t RunsToAFailure(ArchiveSearch& search) {
  std::size_t runs = 0;
  while (!search.Progress().finished) {
    for (const EvaluationRequest& request : search.Ask()) {
      const EvaluationOutcome outcome = NearOutcome(request);
      ++runs;
      if (outcome.runs.front().total_failure) return runs;
      search.Tell(outcome);
    }
  }
  return runs;
}

SearchSetup SteeredSetup(std::uint64_t seed, Objective objective) {
  SearchSetup setup = ArchiveSetup(2000);
  setup.experiment.seed = seed;
  setup.experiment.search.parameters[std::string(kObjectiveParameter)] = static_cast<double>(objective);
  return setup;
}

TEST(ArchiveSearchTest, RobustnessSteersItBeforeAnythingFails) {
  int sooner = 0;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const std::size_t plain = RunsToAFailure(*MakeArchive(SteeredSetup(seed, Objective::kFitness)));
    const std::size_t steered = RunsToAFailure(*MakeArchive(SteeredSetup(seed, Objective::kRobustness)));
    if (steered < plain) ++sooner;
  }
  EXPECT_GE(sooner, 16) << sooner;
}

TEST(ArchiveSearchTest, WhatItRemembersIsPartOfItsState) {
  const auto whole = MakeArchive(SteeredSetup(3, Objective::kRobustness));
  const auto first = MakeArchive(SteeredSetup(3, Objective::kRobustness));
  const auto tell = [](ArchiveSearch& search, std::uint64_t evaluations) {
    std::vector<EvaluationRequest> asked;
    std::size_t told = 0;
    while (search.Progress().evaluations_done < evaluations) {
      std::ranges::move(search.Ask(), std::back_inserter(asked));
      search.Tell(NearOutcome(asked.at(told++)));
    }
  };
  tell(*whole, 600);
  tell(*first, 300);
  const auto second = MakeArchive(SteeredSetup(3, Objective::kRobustness));
  ASSERT_TRUE(RestoreState(*second, StateOf(*first)).ok());
  tell(*second, 600);
  EXPECT_EQ(StateOf(*second), StateOf(*whole));
}

TEST(ArchiveSearchTest, AScenarioWithoutAxesIsRefused) {
  SearchSetup setup = ArchiveSetup(200);
  setup.experiment.scenario = "light-flocking";
  const auto search = ArchiveSearch::Create(setup);
  ASSERT_FALSE(search.ok());
  EXPECT_EQ(search.error().message,
            "scenario light-flocking does not say along which metrics its failures differ, which "
            "search.algorithm = \"archive\" needs: search.cells does");
}

TEST(ArchiveSearchTest, ABudgetThatCannotFillACellIsRefused) {
  const auto load = [](const std::vector<std::string>& settings) {
    std::vector<std::string> all = {"search.algorithm=archive"};
    all.insert(all.end(), settings.begin(), settings.end());
    return LoadExperiment("flocking", all, BuiltInCatalogue());
  };
  const auto few = load({"search.runs=72"});
  ASSERT_FALSE(few.ok());
  EXPECT_EQ(few.error().message,
            "--set search.runs=72: search.runs = 72 cannot fill a cell: a case has to fail in 3 runs, and "
            "all search.slots = 36 cases have a run before one of them has its next; use 73 runs or more, or "
            "fewer slots");
  EXPECT_TRUE(load({"search.runs=73"}).ok());
  EXPECT_TRUE(load({"search.runs=5", "search.slots=2"}).ok());
  EXPECT_FALSE(load({"search.runs=4", "search.slots=2"}).ok());
}

}  // namespace
}  // namespace gauntlet
