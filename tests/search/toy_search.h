// A small arena and a toy fitness, so that searches can be driven without any simulation.
#pragma once

#include <functional>
#include <vector>

#include "base/canonical_encoder.h"
#include "base/hash.h"
#include "search/search_algorithm.h"
#include "search/search_table.h"

namespace gauntlet {

// The experiment of a toy; the thesis' arena and genome; start and goal in opposite corners as in flocking.
inline SearchSetup ToySetup() {
  Experiment experiment;
  experiment.name = "toy";
  experiment.scenario = "toy";
  experiment.seed = 7;
  SearchSetup setup = SetupOf(experiment);
  setup.requirements.start = {2.5, 2.5};
  setup.requirements.goal = {-2.5, -2.5};
  return setup;
}

// Of another search.
inline void SetAlgorithm(SearchSetup& setup, const std::string& algorithm) {
  setup.experiment.search.algorithm = algorithm;
  setup.row = &RowOf(setup.experiment);
}

using ToyFitness = std::function<double(const EvaluationRequest&)>;

inline double SumOfX(const EvaluationRequest& request) {
  double sum = 0.0;
  for (const sim::ObstacleGene& gene : request.test_case.obstacles) sum += gene.x;
  return sum;
}

// A number in [0, 1) that depends on individual and evaluation only: like simulations with fresh seeds.
inline double Noise(const EvaluationRequest& request) {
  sim::RandomStream random(1, sim::StreamPurpose::kTest, static_cast<std::uint32_t>(request.individual),
                           request.evaluation);
  return random.Uniform();
}

inline EvaluationOutcome OutcomeOf(const EvaluationRequest& request, double fitness) {
  return {.individual = request.individual,
          .evaluation = request.evaluation,
          .completed = true,
          .fitness = fitness,
          .runs = {}};
}

// Asks once and tells everything; returns what was asked.
inline std::vector<EvaluationRequest> RunOneAsk(SearchAlgorithm& search, const ToyFitness& fitness) {
  std::vector<EvaluationRequest> requests = search.Ask();
  for (const EvaluationRequest& request : requests) search.Tell(OutcomeOf(request, fitness(request)));
  return requests;
}

// Runs to the end; returns all that was asked, in order.
inline std::vector<EvaluationRequest> RunToEnd(SearchAlgorithm& search, const ToyFitness& fitness) {
  std::vector<EvaluationRequest> all;
  while (!search.Progress().finished) {
    const std::vector<EvaluationRequest> requests = RunOneAsk(search, fitness);
    if (requests.empty()) break;  // it would never finish: the test will see too few requests
    all.insert(all.end(), requests.begin(), requests.end());
  }
  return all;
}

inline bool SameRequest(const EvaluationRequest& a, const EvaluationRequest& b) {
  return a.individual == b.individual && a.evaluation == b.evaluation && a.replicates == b.replicates &&
         a.generation == b.generation && a.test_case.obstacles == b.test_case.obstacles;
}

inline bool SameRequests(const std::vector<EvaluationRequest>& a, const std::vector<EvaluationRequest>& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), SameRequest);
}

inline std::string StateOf(const SearchAlgorithm& search) {
  CanonicalEncoder encoder;
  search.Save(encoder);
  return encoder.Take();
}

// `told`: what the search had been told when the state was saved.
inline Status RestoreState(SearchAlgorithm& search, const std::string& state,
                           const std::vector<EvaluationOutcome>& told = {}) {
  CanonicalDecoder decoder(state);
  return search.Restore(decoder,
                        [&told](const std::function<void(const EvaluationOutcome&)>& visit) -> Status {
                          for (const EvaluationOutcome& outcome : told) visit(outcome);
                          return Ok{};
                        });
}

inline double StatisticOf(const SearchAlgorithm& search, const std::string& name) {
  for (const auto& [key, value] : search.Statistics()) {
    if (key == name) return value;
  }
  return -1.0;
}

}  // namespace gauntlet
