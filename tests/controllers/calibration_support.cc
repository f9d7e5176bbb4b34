#include "tests/controllers/calibration_support.h"

#include <atomic>
#include <cmath>
#include <ctime>
#include <thread>

#include "controllers/registry.h"
#include "sim/arena/validity.h"
#include "sim/random/random_stream.h"
#include "worker/run_executor.h"

namespace gauntlet::calibration {
namespace {

double RoundTo(double value, double step) {
  return std::floor(value / step + 0.5) * step;
}

sim::TestCase RandomCase(std::uint32_t index, int genes, double l_max,
                         const sim::ArenaRequirements& requirements) {
  sim::RandomStream random(1, sim::StreamPurpose::kTest, index);
  for (;;) {
    sim::TestCase test_case;
    sim::IncrementalValidity validity(test_case, requirements);
    for (int tries = 0; tries < 500 && static_cast<int>(test_case.obstacles.size()) < genes; ++tries) {
      sim::ObstacleGene gene;
      gene.x = RoundTo(random.Uniform(-3.0, 3.0), 0.1);
      gene.y = RoundTo(random.Uniform(-3.0, 3.0), 0.1);
      gene.length = RoundTo(random.Uniform(0.4, l_max), 0.1);
      gene.width = RoundTo(random.Uniform(0.1, 0.4), 0.1);
      gene.orientation_deg = random.Below(360);
      if (!validity.TryAppend(gene)) test_case.obstacles.push_back(gene);
    }
    if (static_cast<int>(test_case.obstacles.size()) == genes) return test_case;
  }
}

double ThreadSeconds() {
  timespec time{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

}  // namespace

Specs MakeSpecs(const sim::RunSpec& spec, const Amounts& amounts) {
  const auto first = static_cast<std::size_t>(amounts.first);
  Specs specs;
  specs.empty.assign(static_cast<std::size_t>(amounts.seeds), spec);
  for (std::size_t i = 0; i < specs.empty.size(); ++i) specs.empty[i].seed = 1 + first + i;
  specs.random.assign(static_cast<std::size_t>(amounts.cases), spec);
  const auto* scenario = controllers::FindScenario(spec);
  const auto parameters = controllers::ResolveParameters(scenario->parameters, spec.scenario_parameters);
  const auto requirements = scenario->requirements(*parameters, spec.test_case);
  for (std::size_t i = 0; i < specs.random.size(); ++i) {
    specs.random[i].seed = 10'001 + first + i;
    specs.random[i].test_case =
        RandomCase(static_cast<std::uint32_t>(first + i), amounts.genes, amounts.l_max, requirements);
  }
  return specs;
}

std::vector<sim::RunResult> RunAll(const std::vector<sim::RunSpec>& specs, int threads) {
  std::vector<sim::RunResult> results(specs.size());
  std::atomic<std::size_t> next = 0;
  std::vector<std::thread> pool;
  for (int i = 0; i < threads; ++i) {
    pool.emplace_back([&] {
      for (std::size_t job = next++; job < specs.size(); job = next++) {
        const double begin = ThreadSeconds();
        results[job] = worker::Run(specs[job]);
        results[job].cpu_seconds = ThreadSeconds() - begin;
      }
    });
  }
  for (std::thread& thread : pool) thread.join();
  return results;
}

double Metric(const sim::RunResult& result, std::string_view name) {
  for (const auto& [key, value] : result.metrics) {
    if (key == name) return value;
  }
  return 0.0;
}

}  // namespace gauntlet::calibration
