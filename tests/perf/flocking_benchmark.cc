// User CPU of whole flocking runs, sensors, controllers, physics and metrics included: the figure that says
// how long a campaign takes.
#include <benchmark/benchmark.h>

#include <vector>

#include "controllers/registry.h"
#include "sim/arena/validity.h"
#include "sim/random/random_stream.h"
#include "worker/run_executor.h"

namespace gauntlet {
namespace {

// Valid cases of eight obstacles in the ranges of the default experiment, and the empty arena first.
std::vector<sim::RunSpec> Specs(const char* controller) {
  const controllers::ScenarioInfo& scenario = *controllers::FindScenario("flocking");
  sim::RunSpec spec;
  spec.scenario = "flocking";
  spec.scenario_parameters = controllers::ResolveParameters(scenario.parameters, {}).value();
  spec.controller = controller;
  spec.controller_parameters =
      controllers::ResolveParameters(controllers::FindController(controller)->parameters, {}).value();
  std::vector<sim::RunSpec> specs = {spec};
  for (std::uint32_t number = 1; number <= 20; ++number) {
    sim::RandomStream random(1, sim::StreamPurpose::kTest, number);
    sim::IncrementalValidity validity({}, scenario.requirements(spec.scenario_parameters, {}));
    spec.test_case = {};
    while (spec.test_case.obstacles.size() < 8) {
      const sim::ObstacleGene gene = {random.Uniform(-3, 3), random.Uniform(-3, 3), random.Uniform(0.4, 2.0),
                                      random.Uniform(0.1, 0.4), random.Uniform(0, 360)};
      if (!validity.TryAppend(gene)) spec.test_case.obstacles.push_back(gene);
    }
    spec.seed = number;
    specs.push_back(spec);
  }
  return specs;
}

void Flocking(benchmark::State& state, const char* controller) {
  const std::vector<sim::RunSpec> specs = Specs(controller);
  double robot_ticks = 0.0;
  std::size_t next = 0;
  for (auto _ : state) {
    const sim::RunResult result = worker::Run(specs[next++ % specs.size()]);
    robot_ticks += static_cast<double>(result.ticks) * static_cast<double>(result.robots.size());
  }
  state.counters["robot_ticks/s"] = benchmark::Counter(robot_ticks, benchmark::Counter::kIsRate);
  // Seconds of CPU for 200 s of 11 robots: 22,000 robot-ticks.
  state.counters["200s_x_11"] =
      benchmark::Counter(robot_ticks / 22000.0, benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
}
BENCHMARK_CAPTURE(Flocking, original, "flocking")->Unit(benchmark::kMillisecond)->Iterations(210);
BENCHMARK_CAPTURE(Flocking, improved, "flocking-improved")->Unit(benchmark::kMillisecond)->Iterations(210);

}  // namespace
}  // namespace gauntlet

BENCHMARK_MAIN();
