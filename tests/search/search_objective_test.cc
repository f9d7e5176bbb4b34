// What search.objective makes of the same outcomes.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "search/experiment/experiment_file.h"
#include "search/search_table.h"
#include "tests/search/toy_search.h"

namespace gauntlet {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

Experiment Flocking(const std::string& algorithm, const std::string& objective) {
  return LoadExperiment(
             "flocking",
             {"search.algorithm=" + algorithm, "search.objective=" + objective, "search.replicates=2",
              algorithm == "random" ? "search.cases=20" : "search.generations=30"},
             BuiltInCatalogue())
      .value();
}

double LengthOf(const sim::TestCase& test_case) {
  double length = 0.0;
  for (const sim::ObstacleGene& gene : test_case.obstacles) length += gene.length;
  return length;
}

// The first of two runs fails, the second one where the obstacles are at least `fails_from` m long in all.
EvaluationOutcome Outcome(const EvaluationRequest& request, double fails_from) {
  RunOutcome first{.fitness = 0.25, .total_failure = true};
  RunOutcome second{.fitness = 0.75, .total_failure = LengthOf(request.test_case) >= fails_from};
  return OutcomeOfRuns(request.individual, request.evaluation, {first, second});
}

std::unique_ptr<SearchAlgorithm> Driven(const Experiment& experiment, double fails_from = 9.0) {
  std::unique_ptr<SearchAlgorithm> search = MakeSearch(experiment).value();
  while (!search->Progress().finished) {
    for (const EvaluationRequest& request : search->Ask()) search->Tell(Outcome(request, fails_from));
  }
  return search;
}

TEST(SearchObjectiveTest, FitnessIsTheScenarios) {
  const auto search = Driven(Flocking("random", "fitness"));
  for (const Individual& one : search->Population()) EXPECT_EQ(one.fitness, 0.5);
}

TEST(SearchObjectiveTest, FailureProbabilityIsTheShareOfRunsThatTheSwarmSurvives) {
  const auto search = Driven(Flocking("random", "failure-probability"));
  for (const Individual& one : search->Population()) {
    EXPECT_EQ(one.fitness, LengthOf(one.test_case) >= 9.0 ? 0.0 : 0.5);
  }
}

TEST(SearchObjectiveTest, SmallestFailureIsTheLengthOfTheObstaclesWhereTheSwarmFails) {
  const auto search = Driven(Flocking("random", "smallest-failure"));
  for (const Individual& one : search->Population()) {
    const double length = LengthOf(one.test_case) / (8 * 2.0);  // of 8 obstacles of at most 2 m
    EXPECT_DOUBLE_EQ(one.fitness, LengthOf(one.test_case) >= 9.0 ? length : (1.0 + length) / 2);
  }
}

TEST(SearchObjectiveTest, RobustnessIsTheMeanOfTheRuns) {
  const Result<Experiment> experiment =
      LoadExperiment("flocking",
                     {"search.algorithm=random", "search.cases=1", "search.objective=robustness",
                      "requirements.there=eventually distance_to(goal) < 1"},
                     BuiltInCatalogue());
  ASSERT_TRUE(experiment.ok()) << experiment.error().message;
  const auto search = MakeSearch(*experiment).value();
  EXPECT_TRUE(search->WantsMetrics());
  const EvaluationRequest request = search->Ask().front();
  const RunOutcome run{.fitness = 0.25, .metrics = {{"robustness", 0.5}}};
  const RunOutcome crashed{.verdict = sim::Verdict::kCrashed};
  search->Tell(OutcomeOfRuns(request.individual, request.evaluation, {run, crashed}));
  EXPECT_EQ(search->Population().front().fitness, -0.25) << "a run without a result is as bad as can be";
}

TEST(SearchObjectiveTest, EvolutionFollowsIt) {
  for (const char* algorithm : {"genetic", "steady-state"}) {
    const auto mean_length = [](const SearchAlgorithm& search) {
      double sum = 0.0;
      for (const Individual& one : search.Population()) sum += LengthOf(one.test_case);
      return sum / static_cast<double>(search.Population().size());
    };
    EXPECT_LT(mean_length(*Driven(Flocking(algorithm, "smallest-failure"), 0.0)),
              mean_length(*Driven(Flocking(algorithm, "fitness"), 0.0)))
        << algorithm;
  }
}

TEST(SearchObjectiveTest, StoredSearchesDoNotKnowTheKey) {
  const auto identity = [](const std::string& objective) {
    return SearchIdentity(SetupOf(Flocking("genetic", objective)));
  };
  EXPECT_THAT(identity("fitness"), Not(HasSubstr("objective")));
  EXPECT_THAT(identity("failure-probability"), HasSubstr("search.objective = \"failure-probability\""));
}

TEST(SearchObjectiveTest, IsRefusedWhereItMakesNoSense) {
  const auto refused = [](const std::vector<std::string>& settings) {
    const Result<Experiment> experiment = LoadExperiment("flocking", settings, BuiltInCatalogue());
    EXPECT_FALSE(experiment.ok());
    return experiment.ok() ? "" : experiment.error().message;
  };
  EXPECT_EQ(refused({"search.objective=smallest-failure", "genome.length_min=1", "genome.length_max=1"}),
            "--set search.objective=smallest-failure: search.objective = \"smallest-failure\" tells test "
            "cases apart by how long their obstacles are, and genome.genes = 8 of 1 to 1 m "
            "(genome.length_min, length_max) are all as long: use \"failure-probability\"");
  EXPECT_EQ(
      refused({"search.objective=robustness"}),
      "--set search.objective=robustness: search.objective = \"robustness\" is of what must hold: say it in "
      "[requirements]");
  EXPECT_THAT(refused({"search.algorithm=archive", "search.objective=smallest-failure"}),
              HasSubstr("looks for frequent and small failures anyway; it can be steered by \"robustness\""));
  EXPECT_EQ(refused({"search.objective=smallest"}),
            "--set search.objective=smallest: search.objective = \"smallest\" is unknown, allowed fitness, "
            "smallest-failure, failure-probability, robustness");
}

}  // namespace
}  // namespace gauntlet
