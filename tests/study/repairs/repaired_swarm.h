// A repair that has come to its end, of a swarm whose failures a function decides.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "search/experiment/experiment_file.h"
#include "search/search_table.h"
#include "study/repairs/repair_result.h"

namespace gauntlet::testing_support {

// Cases in the order in which they are handed in: training, guards, held out, random.
inline constexpr std::size_t kTrainingCases = 12;
inline constexpr std::size_t kHeldOut = 12;
inline constexpr std::size_t kRandomCases = 20;

// Whether a run of the case fails with these values of turning_speed_factor and turn_rate.
using FailsWith = std::function<bool(double factor, double rate, std::size_t of_case)>;

// What a run comes to that does not fail.
using PassesWith = std::function<RunOutcome(double factor, double rate, std::size_t of_case)>;

inline RunOutcome AsBefore(double /*factor*/, double /*rate*/, std::size_t /*of_case*/) {
  RunOutcome run{.fitness = 1.0};
  run.effects = {.contacts = 2.0, .seconds = 100.0, .distance = 30.0};
  return run;
}

inline Repair RepairedSwarm(const FailsWith& fails, const PassesWith& passes = AsBefore) {
  Experiment experiment = ParseExperiment("", "toy.toml", {"scenario=flocking"}, BuiltInCatalogue()).value();
  experiment.name = "toy";
  experiment.search.algorithm = "repair";
  experiment.repair = {
      .vary = "controller_parameters.turning_speed_factor=0..1 controller_parameters.turn_rate=0.05..2",
      .runs = 800,
      .training = kTrainingCases,
      .guards = kTrainingCases,
      .units = "6 6"};
  std::vector<sim::TestCase> cases(2 * kTrainingCases + kHeldOut + kRandomCases,
                                   EmptyArena(experiment.arena));
  for (std::size_t i = 0; i < cases.size(); ++i) {
    cases[i].obstacles = {{.x = 0.05 * static_cast<double>(i) - 1.0, .length = 0.4, .width = 0.1}};
    cases[i].name = "case " + std::to_string(i);
  }
  std::shared_ptr<SearchAlgorithm> search = MakeSearch(experiment, cases).value();
  for (auto requests = search->Ask(); !requests.empty(); requests = search->Ask()) {
    for (const EvaluationRequest& request : requests) {
      std::size_t of_case = 0;
      while (CaseHash(cases[of_case]) != CaseHash(request.test_case)) ++of_case;
      const sim::Parameters& values = request.settings->controller_parameters;
      const double factor = values.at("turning_speed_factor");
      const double rate = values.at("turn_rate");
      RunOutcome run = passes(factor, rate, of_case);
      run.total_failure = fails(factor, rate, of_case);
      if (run.total_failure) run.fitness = 0.0;
      search->Tell(OutcomeOfRuns(request.individual, request.evaluation, {run}));
    }
  }
  Repair repair{.experiment = experiment, .search = search, .finished = search->Progress().finished};
  repair.cases = cases;
  return repair;
}

// Cases that failed do so below a factor of .7, the guards and the random ones never.
inline bool FactorIsAtFault(double factor, double /*rate*/, std::size_t of_case) {
  const bool failed =
      of_case < kTrainingCases || (of_case >= 2 * kTrainingCases && of_case < 2 * kTrainingCases + kHeldOut);
  return failed && factor < 0.7;
}

}  // namespace gauntlet::testing_support
