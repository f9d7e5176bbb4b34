// A search that is saved at any boundary and restored elsewhere goes on as if nothing had happened.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <memory>

#include "search/archive/archive_search.h"
#include "search/archive/cma_me_search.h"
#include "search/evolution/genetic_algorithm.h"
#include "search/evolution/random_search.h"
#include "search/evolution/steady_state_search.h"
#include "search/given/given_search.h"
#include "tests/search/toy_search.h"

namespace gauntlet {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

using Factory = std::function<std::unique_ptr<SearchAlgorithm>()>;

struct Kind {
  std::string name;
  Factory make;
};

void PrintTo(const Kind& param, std::ostream* out) {
  *out << param.name;
}

SearchSetup GeneticSetup(ParentSelection selection) {
  SearchSetup setup = ToySetup();
  setup.experiment.search.parent_selection = selection;
  setup.experiment.search.population = 8;
  setup.experiment.search.generations = 9;
  setup.experiment.search.crossover_probability = 0.5;
  return setup;
}

SearchSetup RandomSetup(int cases) {
  SearchSetup setup = ToySetup();
  SetAlgorithm(setup, "random");
  setup.experiment.search.parameters["cases"] = cases;
  return setup;
}

Factory Genetic(ParentSelection selection) {
  return [selection] { return std::move(GeneticAlgorithm::Create(GeneticSetup(selection))).value(); };
}

// A lag that does not divide the population, so that evaluations are outstanding at boundaries.
Factory SteadyState(ParentSelection selection) {
  return [selection] {
    SearchSetup setup = GeneticSetup(selection);
    SetAlgorithm(setup, "steady-state");
    setup.experiment.search.parameters["lag"] = 3;
    return std::move(SteadyStateSearch::Create(setup)).value();
  };
}

SearchSetup OnFlocking(const std::string& algorithm, sim::Parameters parameters) {
  SearchSetup setup = ToySetup();
  setup.experiment.scenario = "flocking";
  SetAlgorithm(setup, algorithm);
  setup.experiment.search.parameters = std::move(parameters);
  return setup;
}

std::unique_ptr<SearchAlgorithm> ListOf(std::vector<sim::TestCase> cases) {
  SearchSetup setup = ToySetup();
  SetAlgorithm(setup, "cases");
  setup.experiment.search.replicates = 2;
  setup.cases = std::move(cases);
  return std::move(GivenSearch::Create(setup)).value();
}

// Some evaluations fail, so that resuming them is tested too.
EvaluationOutcome OutcomeWithFailures(const EvaluationRequest& request) {
  EvaluationOutcome outcome = OutcomeOf(request, Noise(request));
  outcome.completed = (request.individual + request.evaluation) % 7 != 0;
  return outcome;
}

// On to the next boundary; returns what was asked and adds what was told.
std::vector<EvaluationRequest> Step(SearchAlgorithm& search, std::vector<EvaluationOutcome>& told) {
  std::vector<EvaluationRequest> all;
  do {
    const std::vector<EvaluationRequest> requests = search.Ask();
    if (requests.empty()) break;
    for (const EvaluationRequest& request : requests) {
      told.push_back(OutcomeWithFailures(request));
      search.Tell(told.back());
    }
    all.insert(all.end(), requests.begin(), requests.end());
  } while (!search.AtBoundary());
  return all;
}

class SearchResumeTest : public ::testing::TestWithParam<Kind> {};

TEST_P(SearchResumeTest, RestoringAtEveryBoundaryEqualsTheUninterruptedSearch) {
  const std::unique_ptr<SearchAlgorithm> whole = GetParam().make();
  std::unique_ptr<SearchAlgorithm> broken = GetParam().make();
  int boundaries = 0;
  std::vector<EvaluationOutcome> told;
  while (true) {
    const std::string state = StateOf(*broken);
    EXPECT_EQ(state, StateOf(*whole));
    broken = GetParam().make();
    const Status restored = RestoreState(*broken, state, told);
    ASSERT_TRUE(restored.ok()) << restored.error().message;
    EXPECT_EQ(StateOf(*broken), state);
    EXPECT_EQ(broken->Statistics(), whole->Statistics());
    EXPECT_EQ(broken->Progress().evaluations_done, whole->Progress().evaluations_done);
    EXPECT_EQ(broken->Progress().finished, whole->Progress().finished);
    ++boundaries;

    std::vector<EvaluationOutcome> told_again = told;
    const std::vector<EvaluationRequest> expected = Step(*whole, told);
    EXPECT_TRUE(SameRequests(Step(*broken, told_again), expected)) << "after boundary " << boundaries;
    const std::vector<Individual> newborns = whole->TakeNewborns();
    const std::vector<Individual> broken_newborns = broken->TakeNewborns();
    ASSERT_EQ(broken_newborns.size(), newborns.size());
    for (std::size_t i = 0; i < newborns.size(); ++i) {
      EXPECT_EQ(broken_newborns[i].id, newborns[i].id);
      EXPECT_EQ(broken_newborns[i].parents, newborns[i].parents);
      EXPECT_EQ(broken_newborns[i].test_case.obstacles, newborns[i].test_case.obstacles);
    }
    if (expected.empty()) break;
  }
  EXPECT_TRUE(whole->Progress().finished);
  EXPECT_GE(boundaries, 2);
  const std::vector<Individual> population = whole->Population();
  const std::vector<Individual> broken_population = broken->Population();
  ASSERT_EQ(population.size(), broken_population.size());
  for (std::size_t i = 0; i < population.size(); ++i) {
    EXPECT_EQ(population[i].fitness, broken_population[i].fitness);
    EXPECT_EQ(population[i].evaluations, broken_population[i].evaluations);
    EXPECT_EQ(population[i].failed_evaluations, broken_population[i].failed_evaluations);
    EXPECT_EQ(population[i].birth_generation, broken_population[i].birth_generation);
  }
}

TEST_P(SearchResumeTest, EveryCutOfAStateIsRefused) {
  const std::unique_ptr<SearchAlgorithm> search = GetParam().make();
  std::vector<EvaluationOutcome> told;
  Step(*search, told);
  const std::string state = StateOf(*search);
  for (std::size_t size = 0; size < state.size(); size += 1 + state.size() / 200) {
    const Status restored = RestoreState(*GetParam().make(), state.substr(0, size), told);
    ASSERT_FALSE(restored.ok()) << size << " of " << state.size() << " bytes";
  }
}

INSTANTIATE_TEST_SUITE_P(
    AllSearches, SearchResumeTest,
    ::testing::Values(Kind{"AllParentBestHalf", Genetic(ParentSelection::kAllParentBestHalf)},
                      Kind{"TwoBest", Genetic(ParentSelection::kTwoBestParentsTwoWorseAway)},
                      Kind{"TwoRandom", Genetic(ParentSelection::kTwoRandomParentsTwoWorseAway)},
                      Kind{"SteadyState", SteadyState(ParentSelection::kAllParentBestHalf)},
                      Kind{"SteadyStateTwoBest", SteadyState(ParentSelection::kTwoBestParentsTwoWorseAway)},
                      Kind{"Random",
                           [] { return std::move(RandomSearch::Create(RandomSetup(230))).value(); }},
                      Kind{"Archive",
                           [] {
                             return std::move(ArchiveSearch::Create(
                                                  OnFlocking("archive", {{"runs", 300.0}, {"slots", 20.0}})))
                                 .value();
                           }},
                      Kind{"CmaMe",
                           [] {
                             return std::move(CmaMeSearch::Create(
                                                  OnFlocking("cma-me", {{"runs", 230.0}, {"emitters", 3.0}})))
                                 .value();
                           }},
                      Kind{"CaseList",
                           [] {
                             std::vector<sim::TestCase> cases(9);
                             for (std::size_t i = 0; i < cases.size(); ++i) {
                               cases[i].side_x = 6.0 + static_cast<double>(i);
                             }
                             return ListOf(cases);
                           }}),
    [](const auto& instance) { return instance.param.name; });

std::string StateAfterOneGeneration(const SearchSetup& setup) {
  const auto search = std::move(GeneticAlgorithm::Create(setup)).value();
  std::vector<EvaluationOutcome> told;
  Step(*search, told);
  return StateOf(*search);
}

TEST(SearchRestoreTest, StateOfAnotherExperimentIsRefusedByTheLineThatDiffers) {
  const SearchSetup setup = GeneticSetup(ParentSelection::kAllParentBestHalf);
  const std::string state = StateAfterOneGeneration(setup);

  SearchSetup other = setup;
  other.experiment.search.mutation_probability = 0.07;
  Status restored = RestoreState(*std::move(GeneticAlgorithm::Create(other)).value(), state);
  ASSERT_FALSE(restored.ok());
  EXPECT_EQ(restored.error().kind, ErrorKind::kInvalidInput);
  EXPECT_EQ(restored.error().message,
            "the saved search state belongs to another experiment: it has 'search.mutation_probability = "
            "0.05', this one has 'search.mutation_probability = 0.07'");

  other = setup;
  other.experiment.seed = 99;
  restored = RestoreState(*std::move(GeneticAlgorithm::Create(other)).value(), state);
  ASSERT_FALSE(restored.ok());
  EXPECT_EQ(
      restored.error().message,
      "the saved search state belongs to another experiment: it has 'seed = 7', this one has 'seed = 99'");

  other = setup;
  other.experiment.scenario_parameters["birds"] = 12;
  restored = RestoreState(*std::move(GeneticAlgorithm::Create(other)).value(), state);
  ASSERT_FALSE(restored.ok());
  EXPECT_EQ(restored.error().message,
            "the saved search state belongs to another experiment: it has '', this one has "
            "'scenario_parameters.birds = 12'");
}

TEST(SearchRestoreTest, RandomSearchRefusesTheStateOfAGeneticAlgorithm) {
  const std::string state = StateAfterOneGeneration(GeneticSetup(ParentSelection::kAllParentBestHalf));
  const Status restored = RestoreState(*std::move(RandomSearch::Create(RandomSetup(10))).value(), state);
  ASSERT_FALSE(restored.ok());
  EXPECT_EQ(restored.error().message,
            "the saved search state belongs to another experiment: it has 'search.algorithm = \"genetic\"', "
            "this one has 'search.algorithm = \"random\"'");
}

TEST(SearchRestoreTest, AFinishedSearchMayGoOnForMoreGenerationsButNotEndEarlier) {
  SearchSetup setup = GeneticSetup(ParentSelection::kTwoBestParentsTwoWorseAway);
  setup.experiment.search.generations = 4;
  const auto shorter = std::move(GeneticAlgorithm::Create(setup)).value();
  RunToEnd(*shorter, Noise);
  const std::string state = StateOf(*shorter);

  setup.experiment.search.generations = 6;
  const auto whole = std::move(GeneticAlgorithm::Create(setup)).value();
  RunToEnd(*whole, Noise);
  const auto extended = std::move(GeneticAlgorithm::Create(setup)).value();
  ASSERT_TRUE(RestoreState(*extended, state).ok());
  EXPECT_EQ(RunToEnd(*extended, Noise).size(), 16U);
  EXPECT_EQ(StateOf(*extended), StateOf(*whole));

  setup.experiment.search.generations = 3;
  const Status restored = RestoreState(*std::move(GeneticAlgorithm::Create(setup)).value(), state);
  ASSERT_FALSE(restored.ok());
  EXPECT_EQ(
      restored.error().message,
      "the saved search state has 32 evaluations, but the experiment ends after 24: search.generations = 3");
}

// A state says nothing of how long the search was to be: every search goes on from its end as if it had been
// longer from the start.
TEST(SearchRestoreTest, ASearchThatGoesOnForLongerEqualsOneThatWasThatLong) {
  for (const char* algorithm : {"genetic", "steady-state", "random"}) {
    for (const ParentSelection selection :
         {ParentSelection::kAllParentBestHalf, ParentSelection::kTwoBestParentsTwoWorseAway,
          ParentSelection::kTwoRandomParentsTwoWorseAway}) {
      const auto of_length = [&](int generations) {
        SearchSetup setup = GeneticSetup(selection);
        SetAlgorithm(setup, algorithm);
        setup.experiment.search.generations = generations;
        setup.experiment.search.parameters["cases"] = 100.0 * generations;
        return std::move(RowOf(setup.experiment).make(setup)).value();
      };
      const auto run = [](SearchAlgorithm& search, std::vector<EvaluationOutcome>& told) {
        std::vector<IndividualId> born;
        while (!Step(search, told).empty()) continue;
        for (const Individual& one : search.TakeNewborns()) born.push_back(one.id);
        EXPECT_TRUE(search.Progress().finished);
        EXPECT_EQ(search.Progress().evaluations_done, search.Progress().evaluations_planned);
        return born;
      };
      std::vector<EvaluationOutcome> told_whole;
      const auto whole = of_length(6);
      const std::vector<IndividualId> born_whole = run(*whole, told_whole);
      std::vector<EvaluationOutcome> told;
      std::vector<IndividualId> born;
      std::unique_ptr<SearchAlgorithm> search;
      for (const int generations : {1, 2, 6}) {
        const std::string state = search ? StateOf(*search) : "";
        search = of_length(generations);
        if (!state.empty()) {
          const Status restored = RestoreState(*search, state, told);
          ASSERT_TRUE(restored.ok()) << restored.error().message;
        }
        const std::vector<IndividualId> more = run(*search, told);
        born.insert(born.end(), more.begin(), more.end());
      }
      EXPECT_EQ(StateOf(*search), StateOf(*whole)) << algorithm;
      EXPECT_EQ(born, born_whole) << algorithm;
      EXPECT_EQ(told.size(), told_whole.size());
    }
  }
}

TEST(SearchRestoreTest, StateOfANewerFormatIsRefusedAsSuch) {
  const SearchSetup setup = GeneticSetup(ParentSelection::kAllParentBestHalf);
  std::string state = StateAfterOneGeneration(setup);
  state[8] = 3;  // the format follows the eight bytes that mark a state
  const Status restored = RestoreState(*std::move(GeneticAlgorithm::Create(setup)).value(), state);
  ASSERT_FALSE(restored.ok());
  EXPECT_EQ(restored.error().kind, ErrorKind::kVersion);
  EXPECT_EQ(restored.error().message, "the saved search state has format 3, this version reads 2");
}

TEST(SearchRestoreTest, CaseListRefusesTheStateOfAnotherList) {
  const std::string state = StateOf(*ListOf({sim::TestCase{}}));
  const Status restored = RestoreState(*ListOf({sim::TestCase{}, sim::TestCase{}}), state);
  ASSERT_FALSE(restored.ok());
  EXPECT_THAT(restored.error().message,
              AllOf(HasSubstr("'list of cases = 1 with"), HasSubstr("'list of cases = 2 with")));
}

}  // namespace
}  // namespace gauntlet
