// Covers: search/evolution/breeding_search.cc, search/evolution/population_search.cc
#include "search/evolution/genetic_algorithm.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>
#include <map>
#include <set>

#include "tests/search/toy_search.h"

namespace gauntlet {
namespace {

using ::testing::ElementsAre;

SearchSetup SetupOf(ParentSelection selection, int population = 20, int generations = 50) {
  SearchSetup setup = ToySetup();
  setup.experiment.search.parent_selection = selection;
  setup.experiment.search.population = population;
  setup.experiment.search.generations = generations;
  return setup;
}

std::unique_ptr<GeneticAlgorithm> MakeGenetic(const SearchSetup& setup) {
  return std::move(GeneticAlgorithm::Create(setup)).value();
}

double MeanFitness(const SearchAlgorithm& search) {
  double sum = 0.0;
  for (const Individual& one : search.Population()) sum += one.fitness;
  return sum / static_cast<double>(search.Population().size());
}

std::vector<IndividualId> Ids(const std::vector<Individual>& individuals) {
  std::vector<IndividualId> ids;
  for (const Individual& one : individuals) ids.push_back(one.id);
  return ids;
}

// Requests per generation and per individual of a complete search.
struct Accounts {
  std::map<std::uint32_t, int> by_generation;
  std::map<IndividualId, int> by_individual;
};

Accounts AccountsOf(const std::vector<EvaluationRequest>& requests) {
  Accounts accounts;
  for (const EvaluationRequest& request : requests) {
    ++accounts.by_generation[request.generation];
    // Evaluations of one individual are numbered without gaps.
    EXPECT_EQ(request.evaluation, accounts.by_individual[request.individual]++);
  }
  return accounts;
}

TEST(GeneticAlgorithmTest, ACaseThatAProgramRefusesInHalfOfItsRunsHasNoFitness) {
  for (const bool program : {true, false}) {
    SearchSetup setup = SetupOf(ParentSelection::kTwoBestParentsTwoWorseAway);
    if (program) setup.experiment.scenario = "command";
    const auto search = MakeGenetic(setup);
    const IndividualId first = search->Ask().at(0).individual;
    search->Tell(OutcomeOfRuns(first, 0, {{.verdict = sim::Verdict::kRefused}, {.fitness = 0.5}}));
    const Individual& told = search->Population().at(0);
    EXPECT_EQ(told.id, first);
    EXPECT_EQ(told.failed_evaluations, program ? 1U : 0U);
    EXPECT_EQ(told.evaluations, program ? 0U : 1U);
  }
}

TEST(GeneticAlgorithmTest, TwoParentSchemesSimulateEverybodyInEveryGeneration) {
  for (const ParentSelection selection :
       {ParentSelection::kTwoBestParentsTwoWorseAway, ParentSelection::kTwoRandomParentsTwoWorseAway}) {
    const auto search = MakeGenetic(SetupOf(selection));
    EXPECT_EQ(search->Progress().evaluations_planned, 1000U);
    const std::vector<EvaluationRequest> requests = RunToEnd(*search, Noise);
    EXPECT_EQ(requests.size(), 1000U);  // 20 x 50
    const Accounts accounts = AccountsOf(requests);
    EXPECT_EQ(accounts.by_generation.size(), 50U);
    for (const auto& [generation, count] : accounts.by_generation) EXPECT_EQ(count, 20) << generation;
    EXPECT_EQ(accounts.by_individual.size(), 118U);  // 20 + 49 x 2
    EXPECT_EQ(search->Population().size(), 20U);
    EXPECT_EQ(search->Progress().evaluations_done, 1000U);
    EXPECT_EQ(search->Progress().generation, 50U);
    EXPECT_TRUE(search->Progress().finished);
    EXPECT_TRUE(search->Ask().empty());
  }
}

TEST(GeneticAlgorithmTest, AllParentBestHalfSimulatesOnlyChildrenAfterTheFirstGeneration) {
  const auto search = MakeGenetic(SetupOf(ParentSelection::kAllParentBestHalf, 20, 30));
  EXPECT_EQ(search->Progress().evaluations_planned, 600U);
  const std::vector<EvaluationRequest> requests = RunToEnd(*search, Noise);
  EXPECT_EQ(requests.size(), 600U);  // 20 + 29 x 20
  const Accounts accounts = AccountsOf(requests);
  EXPECT_EQ(accounts.by_individual.size(), 600U);
  for (const auto& [individual, count] : accounts.by_individual) EXPECT_EQ(count, 1) << individual;
  EXPECT_EQ(search->Population().size(), 20U);
}

TEST(GeneticAlgorithmTest, ReevaluationModeOverridesTheScheme) {
  SearchSetup setup = SetupOf(ParentSelection::kTwoBestParentsTwoWorseAway);
  setup.experiment.search.reevaluation = Reevaluation::kChildren;
  auto search = MakeGenetic(setup);
  EXPECT_EQ(search->Progress().evaluations_planned, 118U);
  EXPECT_EQ(RunToEnd(*search, Noise).size(), 118U);  // 20 + 49 x 2

  setup = SetupOf(ParentSelection::kAllParentBestHalf, 20, 30);
  setup.experiment.search.reevaluation = Reevaluation::kPopulation;
  search = MakeGenetic(setup);
  EXPECT_EQ(search->Progress().evaluations_planned, 1180U);
  EXPECT_EQ(RunToEnd(*search, Noise).size(), 1180U);  // 20 + 29 x 40
}

TEST(GeneticAlgorithmTest, OneGenerationIsTheInitialPopulation) {
  const auto search = MakeGenetic(SetupOf(ParentSelection::kTwoBestParentsTwoWorseAway, 4, 1));
  EXPECT_EQ(RunToEnd(*search, Noise).size(), 4U);
  EXPECT_THAT(Ids(search->Population()), ElementsAre(1, 2, 3, 4));
}

TEST(GeneticAlgorithmTest, TwoBestMakeTwoChildrenThatReplaceTheTwoWorst) {
  const auto search = MakeGenetic(SetupOf(ParentSelection::kTwoBestParentsTwoWorseAway, 6, 2));
  const std::map<IndividualId, double> fitness = {{1, 0.9}, {2, 0.2}, {3, 0.5}, {4, 0.8}, {5, 0.1}, {6, 0.6}};
  RunOneAsk(*search, [&](const EvaluationRequest& r) { return fitness.at(r.individual); });
  EXPECT_EQ(search->TakeNewborns().size(), 6U);
  const std::vector<EvaluationRequest> second = search->Ask();
  EXPECT_THAT(Ids(search->Population()), ElementsAre(2, 3, 5, 6, 7, 8));
  const std::vector<Individual> newborns = search->TakeNewborns();
  ASSERT_THAT(Ids(newborns), ElementsAre(7, 8));
  EXPECT_THAT(newborns[0].parents, ElementsAre(5, 2));
  EXPECT_THAT(newborns[1].parents, ElementsAre(5, 2));
  EXPECT_EQ(newborns[0].birth_generation, 2U);
  EXPECT_EQ(second.size(), 6U);
  EXPECT_TRUE(search->TakeNewborns().empty());
}

TEST(GeneticAlgorithmTest, AllParentBestHalfKeepsTheFitterHalfOfParentsAndChildren) {
  const auto search = MakeGenetic(SetupOf(ParentSelection::kAllParentBestHalf, 4, 2));
  // Children 5 to 8; the fittest four are 2, 6, 7, and 8, which ties with 1 and is younger.
  const std::map<IndividualId, double> fitness = {{1, 0.5}, {2, 0.1}, {3, 0.9}, {4, 0.8},
                                                  {5, 0.7}, {6, 0.2}, {7, 0.3}, {8, 0.5}};
  RunToEnd(*search, [&](const EvaluationRequest& r) { return fitness.at(r.individual); });
  EXPECT_THAT(Ids(search->Population()), ElementsAre(2, 6, 7, 8));
}

TEST(GeneticAlgorithmTest, EveryParentBreedsOnceInAllParentBestHalf) {
  const auto search = MakeGenetic(SetupOf(ParentSelection::kAllParentBestHalf, 10, 2));
  RunOneAsk(*search, Noise);
  search->TakeNewborns();
  search->Ask();
  std::map<IndividualId, int> children;
  for (const Individual& child : search->TakeNewborns()) {
    for (const IndividualId parent : child.parents) ++children[parent];
  }
  EXPECT_EQ(children.size(), 10U);
  for (const auto& [parent, count] : children) EXPECT_EQ(count, 2) << parent;
}

TEST(GeneticAlgorithmTest, FitnessIsTheMeanOrTheLastOfAllEvaluations) {
  // Individual 3 is evaluated twice, 0.4 and then 0.1; it stays because the others are worse.
  const auto fitness = [](const EvaluationRequest& r) {
    if (r.individual != 3) return 0.8;
    return r.evaluation == 0 ? 0.4 : 0.1;
  };
  for (const FitnessAggregation aggregation : {FitnessAggregation::kMean, FitnessAggregation::kLast}) {
    SearchSetup setup = SetupOf(ParentSelection::kTwoBestParentsTwoWorseAway, 4, 2);
    setup.experiment.search.aggregation = aggregation;
    const auto search = MakeGenetic(setup);
    RunToEnd(*search, fitness);
    const Individual third = search->Population().front();
    ASSERT_EQ(third.id, 3U);
    EXPECT_EQ(third.evaluations, 2U);
    EXPECT_EQ(third.fitness_sum, 0.4 + 0.1);
    EXPECT_DOUBLE_EQ(third.fitness, aggregation == FitnessAggregation::kMean ? 0.25 : 0.1);
  }
}

TEST(GeneticAlgorithmTest, FailedEvaluationsDoNotCountInTheFitness) {
  const auto search = MakeGenetic(SetupOf(ParentSelection::kTwoBestParentsTwoWorseAway, 4, 2));
  for (int generation = 1; generation <= 2; ++generation) {
    for (const EvaluationRequest& request : search->Ask()) {
      EvaluationOutcome outcome = OutcomeOf(request, 0.5);
      if (request.individual == 3) outcome.completed = generation == 2;
      if (request.individual == 4) outcome.fitness = std::numeric_limits<double>::quiet_NaN();
      search->Tell(outcome);
    }
    if (generation > 1) continue;
    const std::vector<Individual> population = search->Population();
    EXPECT_EQ(population[2].fitness, std::numeric_limits<double>::infinity());
    EXPECT_EQ(population[3].fitness, std::numeric_limits<double>::infinity());
    EXPECT_EQ(population[2].failed_evaluations, 1U);
  }
  // Both had no fitness and were replaced, although they were the youngest.
  EXPECT_THAT(Ids(search->Population()), ElementsAre(1, 2, 5, 6));
}

TEST(GeneticAlgorithmTest, EvaluationNumbersGoOnAfterAFailedOne) {
  const auto search = MakeGenetic(SetupOf(ParentSelection::kTwoBestParentsTwoWorseAway, 4, 2));
  for (const EvaluationRequest& request : search->Ask()) {
    EvaluationOutcome outcome = OutcomeOf(request, 0.5);
    outcome.completed = false;
    search->Tell(outcome);
  }
  for (const EvaluationRequest& request : search->Ask()) {
    EXPECT_EQ(request.evaluation, request.individual <= 4 ? 1U : 0U);
  }
}

TEST(GeneticAlgorithmTest, AboutSixtyPercentOfChildrenAreClonesWithTheThesisParameters) {
  SearchSetup setup = SetupOf(ParentSelection::kTwoBestParentsTwoWorseAway);
  double children = 0.0;
  double clones = 0.0;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    setup.experiment.seed = seed;
    const auto search = MakeGenetic(setup);
    std::vector<Individual> born;
    while (!RunOneAsk(*search, Noise).empty()) {
      const std::vector<Individual> newborns = search->TakeNewborns();
      born.insert(born.end(), newborns.begin(), newborns.end());
    }
    EXPECT_EQ(StatisticOf(*search, "children"), 98.0);
    children += 98.0;
    clones += 98.0 * StatisticOf(*search, "clone_rate");
    const auto distinct = static_cast<double>(CountDistinctGenomes(born));
    EXPECT_GT(distinct, 20.0);
    // Every child that is no clone is a new genome, and clones are none.
    EXPECT_NEAR(distinct, 118.0 - 98.0 * StatisticOf(*search, "clone_rate"), 1.0);
  }
  // 0.597 for unrelated parents; but the two best become relatives, and crossing clones gives clones:
  // 0.95^8 = 0.663 if all were. Repeated mutations add a little to both.
  RecordProperty("clone_rate", std::to_string(clones / children));
  EXPECT_NEAR(clones / children, 0.62, 0.06);
}

TEST(GeneticAlgorithmTest, ConvergesOnAToyFitness) {
  for (const ParentSelection selection :
       {ParentSelection::kAllParentBestHalf, ParentSelection::kTwoBestParentsTwoWorseAway}) {
    const auto search = MakeGenetic(SetupOf(selection));
    RunOneAsk(*search, SumOfX);
    const double initial = MeanFitness(*search);
    RunToEnd(*search, SumOfX);
    // Eight x between -3 and 3: the random mean is 0 with a standard deviation of 5 for one individual.
    EXPECT_LT(MeanFitness(*search), initial - 5.0);
  }
}

TEST(GeneticAlgorithmTest, SameSeedSameRequestsOtherSeedOthers) {
  SearchSetup setup = SetupOf(ParentSelection::kTwoRandomParentsTwoWorseAway, 10, 10);
  const std::vector<EvaluationRequest> requests = RunToEnd(*MakeGenetic(setup), Noise);
  EXPECT_TRUE(SameRequests(RunToEnd(*MakeGenetic(setup), Noise), requests));
  SearchSetup other_seed = setup;
  other_seed.experiment.seed = 8;
  EXPECT_NE(MakeGenetic(other_seed)->Population().front().test_case.obstacles,
            requests.front().test_case.obstacles);
}

TEST(GeneticAlgorithmTest, RequestsCarryReplicatesAndTheArena) {
  SearchSetup setup = SetupOf(ParentSelection::kTwoBestParentsTwoWorseAway, 4, 1);
  setup.experiment.search.replicates = 3;
  setup.experiment.arena = {.side = 7.0, .wall_thickness = 0.2};
  for (const EvaluationRequest& request : MakeGenetic(setup)->Ask()) {
    EXPECT_EQ(request.replicates, 3U);
    EXPECT_EQ(request.test_case.side_x, 7.0);
    EXPECT_EQ(request.test_case.side_y, 7.0);
    EXPECT_EQ(request.test_case.wall_thickness, 0.2);
    EXPECT_EQ(request.test_case.obstacles.size(), 8U);
  }
}

TEST(GeneticAlgorithmTest, AsksNothingWhileItWaitsForOutcomes) {
  const auto search = MakeGenetic(SetupOf(ParentSelection::kTwoBestParentsTwoWorseAway, 4, 2));
  EXPECT_TRUE(search->AtBoundary());
  const std::vector<EvaluationRequest> requests = search->Ask();
  EXPECT_FALSE(search->AtBoundary());
  EXPECT_TRUE(search->Ask().empty());
  for (const EvaluationRequest& request : requests) search->Tell(OutcomeOf(request, 0.5));
  EXPECT_TRUE(search->AtBoundary());
  EXPECT_FALSE(search->Ask().empty());
}

TEST(GeneticAlgorithmDeathTest, OutcomesOutOfOrderAreADefect) {
  const auto search = MakeGenetic(SetupOf(ParentSelection::kTwoBestParentsTwoWorseAway, 4, 2));
  const std::vector<EvaluationRequest> requests = search->Ask();
  EXPECT_DEATH(search->Tell(OutcomeOf(requests[1], 0.5)),
               "told individual 2 evaluation 0, expected 1 evaluation 0");
}

TEST(GeneticAlgorithmTest, RangesWithoutRoomAreRefusedAtOnce) {
  SearchSetup setup = SetupOf(ParentSelection::kTwoBestParentsTwoWorseAway);
  setup.experiment.genome.length_min = 20.0;
  setup.experiment.genome.length_max = 20.0;
  setup.experiment.genome.width_min = 20.0;
  setup.experiment.genome.width_max = 20.0;
  setup.experiment.genome.tries_per_gene = 3;
  const auto search = GeneticAlgorithm::Create(setup);
  ASSERT_FALSE(search.ok());
  EXPECT_EQ(search.error().message,
            "no valid test case found in 100 starts with genome.genes = 8, positions -3 to 3 m, lengths 20 "
            "to 20 m, widths 20 to 20 m in an arena of 6 x 6 m: use fewer or smaller obstacles");
}

}  // namespace
}  // namespace gauntlet
