// What tests of scenarios share: specs, metrics by name, random boxes, a scenario that looks over another's
// shoulder.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "sim/arena/validity.h"
#include "sim/random/random_stream.h"
#include "sim/run_result.h"
#include "sim/run_spec.h"
#include "sim/scenario.h"

namespace gauntlet::testing_support {

inline sim::RunSpec SpecOf(const std::string& scenario, const std::string& controller, std::uint64_t seed) {
  sim::RunSpec spec;
  spec.scenario = scenario;
  spec.controller = controller;
  spec.seed = seed;
  return spec;
}

// A failure of the test when the result has no such metric.
inline double Metric(const sim::RunResult& result, std::string_view name) {
  const auto found = std::find_if(result.metrics.begin(), result.metrics.end(),
                                  [&](const auto& metric) { return metric.first == name; });
  if (found != result.metrics.end()) return found->second;
  ADD_FAILURE() << "no metric " << name;
  return 0.0;
}

inline double SumOfMetrics(const sim::RunResult& result, std::string_view prefix) {
  double sum = 0.0;
  for (const auto& [name, value] : result.metrics) sum += name.starts_with(prefix) ? value : 0.0;
  return sum;
}

// Tries `tries` boxes and keeps those that leave the case valid, until it has `most`.
inline void AddRandomBoxes(sim::TestCase& test_case, const sim::ArenaRequirements& requirements,
                           sim::RandomStream& random, int tries, std::size_t most) {
  sim::IncrementalValidity validity(test_case, requirements);
  for (int i = 0; i < tries && test_case.obstacles.size() < most; ++i) {
    sim::ObstacleGene gene;
    gene.x = random.Uniform(-3.0, 3.0);
    gene.y = random.Uniform(-3.0, 3.0);
    gene.length = random.Uniform(0.4, 2.0);
    gene.width = random.Uniform(0.1, 0.4);
    gene.orientation_deg = random.Below(360);
    if (!validity.TryAppend(gene)) test_case.obstacles.push_back(gene);
  }
}

// Is the scenario that it is given; tests derive from it to watch.
class WatchedScenario : public sim::Scenario {
 public:
  explicit WatchedScenario(std::unique_ptr<sim::Scenario> scenario) : scenario_(std::move(scenario)) {}

  const sim::Arena& arena() const override { return scenario_->arena(); }
  sim::Tick tick_limit() const override { return scenario_->tick_limit(); }
  std::span<const sim::Light> lights() const override { return scenario_->lights(); }
  std::span<const sim::RadioBeacon> radio_beacons() const override { return scenario_->radio_beacons(); }
  double FloorGrey(const sim::Vec2& point) const override { return scenario_->FloorGrey(point); }
  Result<std::vector<sim::RobotSetup>> CreateSwarm(const sim::Headquarters& headquarters) override {
    return scenario_->CreateSwarm(headquarters);
  }
  void Interact(const sim::Interaction& interaction) override { scenario_->Interact(interaction); }
  bool Finished(const sim::Observer& observer) override { return scenario_->Finished(observer); }
  sim::Outcome Evaluate(const sim::Observer& observer) override { return scenario_->Evaluate(observer); }

 private:
  std::unique_ptr<sim::Scenario> scenario_;
};

}  // namespace gauntlet::testing_support
