#include "search/evolution/steady_state_search.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <deque>

#include "search/evolution/genetic_algorithm.h"
#include "search/experiment/experiment_file.h"
#include "search/search_table.h"
#include "tests/search/simulated_cluster.h"
#include "tests/search/toy_search.h"

namespace gauntlet {
namespace {

constexpr int kPopulation = 8;
constexpr int kGenerations = 6;

SearchSetup SteadySetup(int lag, ParentSelection selection = ParentSelection::kAllParentBestHalf) {
  SearchSetup setup = ToySetup();
  SetAlgorithm(setup, "steady-state");
  setup.experiment.search.parameters["lag"] = lag;
  setup.experiment.search.parent_selection = selection;
  setup.experiment.search.population = kPopulation;
  setup.experiment.search.generations = kGenerations;
  setup.experiment.search.crossover_probability = 0.5;
  setup.experiment.search.mutation_probability = 0.2;
  return setup;
}

std::unique_ptr<SteadyStateSearch> MakeSteady(const SearchSetup& setup) {
  return std::move(SteadyStateSearch::Create(setup)).value();
}

// Asks, tells at most `tells_between_asks` outcomes, asks again. Returns what was asked, in order.
std::vector<EvaluationRequest> Drive(SteadyStateSearch& search, std::size_t tells_between_asks,
                                     const ToyFitness& fitness) {
  std::vector<EvaluationRequest> all;
  std::deque<EvaluationRequest> outstanding;
  while (!search.Progress().finished) {
    for (EvaluationRequest& request : search.Ask()) {
      all.push_back(request);
      outstanding.push_back(std::move(request));
    }
    for (std::size_t told = 0; told < tells_between_asks && !outstanding.empty(); ++told) {
      search.Tell(OutcomeOf(outstanding.front(), fitness(outstanding.front())));
      outstanding.pop_front();
    }
  }
  return all;
}

TEST(SteadyStateSearchTest, TheMomentOfAskingChangesNothing) {
  for (const int lag : {1, 3, 7}) {
    const auto one_by_one = MakeSteady(SteadySetup(lag));
    const auto in_batches = MakeSteady(SteadySetup(lag));
    EXPECT_TRUE(SameRequests(Drive(*one_by_one, 1, SumOfX), Drive(*in_batches, 100, SumOfX))) << lag;
    EXPECT_EQ(StateOf(*one_by_one), StateOf(*in_batches)) << lag;
  }
}

TEST(SteadyStateSearchTest, NoMoreThanTheLagIsOutstanding) {
  const int lag = 3;
  const auto search = MakeSteady(SteadySetup(lag));
  std::deque<EvaluationRequest> outstanding;
  for (int told = 0; told < kPopulation * kGenerations; ++told) {
    for (EvaluationRequest& request : search->Ask()) outstanding.push_back(std::move(request));
    EXPECT_EQ(outstanding.size(), std::min<std::size_t>(lag, kPopulation * kGenerations - told));
    search->Tell(OutcomeOf(outstanding.front(), Noise(outstanding.front())));
    outstanding.pop_front();
  }
  EXPECT_TRUE(search->Ask().empty());
  EXPECT_TRUE(search->Progress().finished);
}

// The rule that makes it independent of the workers: request k is a function of results 1 .. k - lag.
TEST(SteadyStateSearchTest, ARequestKnowsAllResultsButTheLastOnesOfTheLag) {
  const int lag = 5;
  constexpr std::size_t kChanged = 14;  // the result that is another one the second time
  for (const ParentSelection selection :
       {ParentSelection::kAllParentBestHalf, ParentSelection::kTwoBestParentsTwoWorseAway}) {
    // The toughest of all, or the easiest, which is dropped at once.
    const auto with = [&](double result) {
      return [result](const EvaluationRequest& request) {
        return request.individual == kChanged ? result : Noise(request);
      };
    };
    const auto first = MakeSteady(SteadySetup(lag, selection));
    const auto second = MakeSteady(SteadySetup(lag, selection));
    const std::vector<EvaluationRequest> asked = Drive(*first, 1, with(-10.0));
    const std::vector<EvaluationRequest> asked_again = Drive(*second, 2, with(10.0));
    ASSERT_EQ(asked.size(), asked_again.size());
    std::size_t same = 0;
    while (same < asked.size() && SameRequest(asked[same], asked_again[same])) ++same;
    EXPECT_GE(same, kChanged + lag - 1);
    EXPECT_LT(same, asked.size()) << "it must matter at some time";
    if (selection == ParentSelection::kTwoBestParentsTwoWorseAway) {
      EXPECT_LE(same, kChanged + lag + 2) << "it is a parent from then on";
    }
  }
}

TEST(SteadyStateSearchTest, TheLargestLagIsTheDefault) {
  const auto search = MakeSteady(SteadySetup(0));
  EXPECT_EQ(search->Ask().size(), static_cast<std::size_t>(kPopulation - 1));
}

TEST(SteadyStateSearchTest, EvaluatesEverybodyOnceAndKeepsTheFittest) {
  const auto search = MakeSteady(SteadySetup(4));
  const std::vector<EvaluationRequest> asked = Drive(*search, 1, SumOfX);
  ASSERT_EQ(asked.size(), static_cast<std::size_t>(kPopulation * kGenerations));
  EXPECT_EQ(search->Progress().evaluations_planned, asked.size());
  std::vector<double> all;
  for (std::size_t i = 0; i < asked.size(); ++i) {
    EXPECT_EQ(asked[i].individual, i + 1);
    EXPECT_EQ(asked[i].evaluation, 0U);
    EXPECT_EQ(asked[i].generation, i / kPopulation + 1);
    all.push_back(SumOfX(asked[i]));
  }
  std::sort(all.begin(), all.end());
  std::vector<double> kept;
  for (const Individual& one : search->Population()) kept.push_back(one.fitness);
  std::sort(kept.begin(), kept.end());
  all.resize(kPopulation);
  EXPECT_EQ(kept, all);
  EXPECT_EQ(search->TakeNewborns().size(), asked.size());
}

TEST(SteadyStateSearchTest, BeginsWithTheCasesOfTheGenerationalSearch) {
  const auto search = MakeSteady(SteadySetup(4));
  const std::vector<EvaluationRequest> asked = Drive(*search, 1, SumOfX);
  SearchSetup setup = SteadySetup(4);
  SetAlgorithm(setup, "genetic");
  const auto generational = std::move(GeneticAlgorithm::Create(setup)).value();
  const std::vector<EvaluationRequest> initial = generational->Ask();
  ASSERT_EQ(initial.size(), static_cast<std::size_t>(kPopulation));
  for (std::size_t i = 0; i < initial.size(); ++i) EXPECT_TRUE(SameRequest(asked[i], initial[i])) << i;
}

TEST(SteadyStateSearchTest, EvolvesTougherCases) {
  const auto search = MakeSteady(SteadySetup(4));
  const std::vector<EvaluationRequest> asked = Drive(*search, 1, SumOfX);
  const auto mean = [&](std::size_t from) {
    double sum = 0.0;
    for (std::size_t i = from; i < from + kPopulation; ++i) sum += SumOfX(asked[i]);
    return sum / kPopulation;
  };
  EXPECT_LT(mean(asked.size() - kPopulation), mean(0) - 1.0);
}

// What it is for: one slow evaluation does not stop everybody.
TEST(SteadyStateSearchTest, WorkersAreIdleLessTheLargerTheLag) {
  constexpr int kWorkers = 4;
  const auto idle = [&](const char* algorithm, int lag) {
    SearchSetup setup = SteadySetup(lag);
    SetAlgorithm(setup, algorithm);
    setup.experiment.search.generations = 30;
    const auto search = RowOf(setup.experiment).make(setup);
    return RunOnCluster(**search, kWorkers, HeavyTailed, SumOfX).idle_share;
  };
  EXPECT_NEAR(idle("steady-state", 1), 0.75, 1e-9) << "one at a time";
  EXPECT_LT(idle("steady-state", 4), idle("steady-state", 2));
  EXPECT_LT(idle("steady-state", 7), idle("steady-state", 4));
  EXPECT_LT(idle("steady-state", 7), idle("genetic", 7));
}

std::string RefusalOfSettings(const std::vector<std::string>& settings) {
  const auto experiment = LoadExperiment("flocking", settings, BuiltInCatalogue());
  return experiment.ok() ? "" : experiment.error().message;
}

TEST(SteadyStateSearchTest, ImpossibleSettingsAreNamed) {
  const std::string steady = "search.algorithm=steady-state";
  EXPECT_EQ(RefusalOfSettings({steady}), "");
  EXPECT_EQ(RefusalOfSettings({steady, "search.lag=20"}),
            "--set search.lag=20: search.lag = 20 must be below search.population = 20: the first child "
            "needs two parents");
  EXPECT_EQ(RefusalOfSettings({steady, "search.lag=-1"}),
            "--set search.lag=-1: search.lag = -1 is out of range, allowed 0 to 9999");
  EXPECT_EQ(RefusalOfSettings({steady, "search.reevaluation=population"}),
            "--set search.reevaluation=population: search.reevaluation = \"population\" needs generations: "
            "with search.algorithm = \"steady-state\" everybody is evaluated once (use search.replicates)");
  EXPECT_EQ(RefusalOfSettings({"search.algorithm=steady"}),
            "--set search.algorithm=steady: search.algorithm = \"steady\" is unknown, allowed genetic, "
            "steady-state, random, archive, random-deletion, cma-me, cases, resimulation, confirmation, "
            "minimisation, blame, check, fit, margin, repair, probability, stream");
  EXPECT_EQ(RefusalOfSettings({"search.mode=steady-state"}),
            "--set search.mode=steady-state: unknown key 'search.mode'; write search.algorithm = "
            "\"steady-state\" or \"genetic\"");
}

}  // namespace
}  // namespace gauntlet
