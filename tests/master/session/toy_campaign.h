// Campaigns whose runs are answered at once by a function: searches, loop, store and backend, all in memory.
#pragma once

#include <gtest/gtest.h>

#include <cstdint>
#include <deque>
#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "master/session/search_driver.h"
#include "master/session/search_loop.h"
#include "search/search_setup.h"
#include "search/search_table.h"
#include "sim/random/random_stream.h"
#include "tests/support/fake_backend.h"
#include "tests/support/fake_clock.h"
#include "tests/support/memory_store.h"

namespace gauntlet {

// The toy's simulation: completed, and a fitness, a length and a failure that depend on the spec alone.
inline sim::RunResult ToyRun(const sim::RunSpec& spec) {
  sim::RandomStream random(spec.seed, sim::StreamPurpose::kTest);
  sim::RunResult result;
  result.fitness = random.Uniform();
  result.ticks = static_cast<sim::Tick>(100 + random.Below(1000));
  result.failure.total = result.fitness < 0.3;
  if (result.failure.total) result.failure.type = static_cast<int>(random.Below(3));
  result.metrics = {{"fitness", result.fitness}};
  return result;
}

// Small; no scenario is needed, because nothing is simulated.
inline Experiment ToyExperiment(std::uint64_t seed = 7) {
  Experiment experiment;
  experiment.name = "toy";
  experiment.scenario = "toy";
  experiment.controller = "toy";
  experiment.seed = seed;
  experiment.search.population = 6;
  experiment.search.generations = 4;
  experiment.search.replicates = 2;
  return experiment;
}

inline std::unique_ptr<SearchAlgorithm> MakeToySearch(const Experiment& experiment) {
  SearchSetup setup = SetupOf(experiment);
  setup.requirements.start = {2.5, 2.5};
  setup.requirements.goal = {-2.5, -2.5};
  return std::move(RowOf(experiment).make(setup)).value();
}

// A campaign's searches.
inline std::vector<SearchPlan> PlansOf(const std::vector<Experiment>& experiments) {
  std::vector<SearchPlan> plans;
  for (const Experiment& experiment : experiments) plans.push_back({"", experiment});
  return Numbered(std::move(plans));
}

// One process's life with the campaign that a store holds.
class ToySession {
 public:
  using MakeSearch = std::function<std::unique_ptr<SearchAlgorithm>(const Experiment&)>;

  ToySession(const std::vector<Experiment>& experiments, testing_support::MemoryStore& store,
             testing_support::FakeBackend::Simulate simulate = ToyRun,
             const MakeSearch& make_search = MakeToySearch)
      : backend(clock, std::move(simulate)), plans_(PlansOf(experiments)) {
    SearchLoop::Parts parts{{}, backend, store, clock};
    for (const SearchPlan& plan : plans_) {
      if (store.searches.size() < plan.id)
        store.searches.push_back({plan.id, "toy", "genetic", plan.experiment.seed});
      searches_.push_back(make_search(plan.experiment));
      drivers.emplace_back(
          SearchDriver::Parts{.plan = plan, .search = *searches_.back(), .backend = backend, .store = store});
      parts.searches.push_back(&drivers.back());
    }
    loop = std::make_unique<SearchLoop>(parts);
  }

  Result<CampaignEnd> Run(const std::function<StopWish()>& stop = [] { return StopWish::kNone; }) {
    if (Status restored = loop->Restore(); !restored) return restored.error();
    return loop->Run(stop, [this](const CampaignProgress& now) { progress.push_back(now); });
  }

  testing_support::FakeClock clock;
  testing_support::FakeBackend backend;
  std::deque<SearchDriver> drivers;
  std::unique_ptr<SearchLoop> loop;
  std::vector<CampaignProgress> progress;  // as it was reported

 private:
  const std::vector<SearchPlan> plans_;
  std::vector<std::unique_ptr<SearchAlgorithm>> searches_;
};

// A store in which the campaign of these searches has come to its end.
inline testing_support::MemoryStore FinishedToyCampaign(const std::vector<Experiment>& experiments) {
  testing_support::MemoryStore store;
  const Result<CampaignEnd> end = ToySession(experiments, store).Run();
  EXPECT_TRUE(end.ok() && *end == CampaignEnd::kFinished);
  return store;
}

}  // namespace gauntlet
