// Questions that are answered in memory: their search is driven to its end, and a store keeps its runs.
#pragma once

#include <algorithm>
#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "master/store/run_numbers.h"
#include "proto/run_codec.h"
#include "search/experiment/experiment_file.h"
#include "search/search_table.h"
#include "study/questions/case_answer.h"
#include "tests/support/memory_store.h"

namespace gauntlet::testing_support {

inline Experiment Flocking(const std::vector<std::string>& sets = {}) {
  return LoadExperiment("flocking", sets, BuiltInCatalogue()).value();
}

// Walls at x = 0, 1, ... tenths of a metre, by which they are told apart.
inline sim::TestCase Walls(std::size_t count, const std::string& name = "run 17") {
  sim::TestCase one;
  one.name = name;
  for (std::size_t i = 0; i < count; ++i)
    one.obstacles.push_back({.x = 0.1 * static_cast<double>(i), .length = 1, .width = 0.2});
  return one;
}

inline bool Has(const sim::TestCase& test_case, std::size_t wall) {
  return std::ranges::count(test_case.obstacles, 0.1 * static_cast<double>(wall), &sim::ObstacleGene::x) > 0;
}

// A run that ends with a result.
inline sim::RunResult Ended(bool failed, double fitness = 0.5) {
  sim::RunResult result;
  result.fitness = failed ? 0.0 : fitness;
  result.failure.total = failed;
  result.metrics = {{"splits", failed ? 1.0 : 0.0}, {"split_x", -1.0}, {"split_y", 0.5}};
  return result;
}

using Simulation = std::function<sim::RunResult(const EvaluationRequest&)>;

// What a campaign holds after at most `most` of the runs that the plans ask for.
inline void Answer(const std::vector<SearchPlan>& plans, const Simulation& simulate, MemoryStore& store,
                   std::uint64_t most = std::numeric_limits<std::uint64_t>::max()) {
  for (std::size_t i = 0; i < plans.size(); ++i) {
    const auto id = static_cast<SearchId>(i + 1);
    const auto search = MakeSearch(plans[i].experiment, plans[i].cases).value();
    std::uint64_t runs = 0;
    while (!search->Progress().finished && runs < most) {
      for (const EvaluationRequest& request : search->Ask()) {
        for (const Individual& born : search->TakeNewborns()) store.individuals[id].push_back(born);
        std::vector<RunOutcome> outcomes;
        for (std::uint32_t replicate = 0; replicate < request.replicates && runs < most; ++replicate) {
          sim::RunResult result = simulate(request);
          SetHashes(result);
          outcomes.push_back({.verdict = result.verdict,
                              .fitness = result.fitness,
                              .total_failure = result.failure.total,
                              .metrics = result.metrics,
                              .robots = result.robots});
          const RunId run = RunIdOf(id, ++runs);
          store.runs[run] = {.id = run, .search = id, .individual = request.individual};
          store.runs[run].seed = run;
          store.runs[run].evaluation = request.evaluation;
          store.runs[run].result = proto::EncodeRunResult(result);
        }
        if (outcomes.size() < request.replicates) break;
        search->Tell(OutcomeOfRuns(request.individual, request.evaluation, std::move(outcomes)));
      }
    }
    StoredSearch stored;
    stored.id = id;
    stored.finished_with = search->Progress().finished ? RunIdOf(id, runs) : 0;
    store.searches.push_back(stored);
  }
}

// The answers of a question's experiment about cases.
inline std::vector<CaseAnswer> Answers(const Experiment& about, const std::vector<sim::TestCase>& cases,
                                       const Simulation& simulate, CaseKey key) {
  MemoryStore store;
  const std::vector<SearchPlan> plans = {{"", about, cases}};
  Answer(plans, simulate, store);
  return AnswersIn(plans, store, "d/asked/1", key).value();
}

}  // namespace gauntlet::testing_support
