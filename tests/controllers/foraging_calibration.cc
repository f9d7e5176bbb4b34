// Prints the figures that the foraging parameters were calibrated with (spec section 9): the empty arena with
// many seeds, and random valid cases, for the chosen variants over a grid of the knobs. Evolved cases are
// never looked at.
//
//   foraging_calibration [name=value ...] [variant ...]
//     cases=200 seeds=100 threads=2 genes=8 l_max=2   how much
//     first=0                                         number of the first case and seed
//     any other name                                  a parameter of scenario or controller; lists like
//                                                     turn_rate=0.5,0.714 make a grid
//     a word without '='                              a controller; "foraging" when none is named
#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <map>
#include <string>
#include <thread>
#include <vector>

#include "controllers/registry.h"
#include "sim/arena/validity.h"
#include "sim/random/random_stream.h"
#include "worker/run_executor.h"

namespace gauntlet {
namespace {

struct Options {
  std::map<std::string, double> amounts = {{"cases", 200}, {"seeds", 100}, {"threads", 2},
                                           {"genes", 8},   {"l_max", 2.0}, {"first", 0}};
  std::map<std::string, std::vector<double>> knobs;
  std::vector<std::string> controllers;

  int Count(const char* name) const { return static_cast<int>(amounts.at(name)); }
};

Options ParseOptions(int argc, char** argv) {
  Options options;
  for (int i = 1; i < argc; ++i) {
    const std::string argument = argv[i];
    const std::size_t equals = argument.find('=');
    if (equals == std::string::npos) {
      options.controllers.push_back(argument);
      continue;
    }
    std::vector<double> values;
    for (const char* text = argv[i] + equals + 1;;) {
      char* end = nullptr;
      values.push_back(std::strtod(text, &end));
      if (end == text) {
        std::fprintf(stderr, "not a number: %s\n", argv[i]);
        std::exit(2);
      }
      if (*end != ',') break;
      text = end + 1;
    }
    const std::string name = argument.substr(0, equals);
    if (options.amounts.contains(name)) {
      options.amounts[name] = values.front();
    } else {
      options.knobs[name] = values;
    }
  }
  if (options.controllers.empty()) options.controllers = {"foraging"};
  return options;
}

double RoundTo(double value, double step) {
  return std::floor(value / step + 0.5) * step;
}

// Genes by spec 1.1, redrawn one by one until valid.
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

double Metric(const sim::RunResult& result, std::string_view name) {
  for (const auto& [key, value] : result.metrics) {
    if (key == name) return value;
  }
  return 0.0;
}

double ThreadSeconds() {
  timespec time{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

void Measure(const std::vector<sim::RunSpec>& specs, int threads) {
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

  double mean = 0.0, squares = 0.0, zeros = 0.0, no_path = 0.0, trapped = 0.0, beacons = 0.0, lost = 0.0;
  double cpu_ms = 0.0, n = 0.0;
  int refused = 0;
  for (const sim::RunResult& result : results) {
    if (result.verdict != sim::Verdict::kCompleted) {
      if (refused++ == 0) std::printf("  refused: %s\n", result.message.c_str());
      continue;
    }
    n += 1.0;
    mean += result.fitness;
    squares += result.fitness * result.fitness;
    zeros += Metric(result, "condition_2");
    no_path += Metric(result, "condition_1");
    trapped += Metric(result, "trapped_robots");
    beacons += Metric(result, "mean_robots_beacon");
    lost += Metric(result, "food_lost");
    cpu_ms += 1e3 * result.cpu_seconds;
  }
  n = std::max(1.0, n);
  mean /= n;
  std::printf(" | %5.2f %5.2f %5.1f%% %6.1f%% %5.2f %5.2f %4.0f %5.1f", mean,
              std::sqrt(std::max(0.0, squares / n - mean * mean)), 100.0 * zeros / n, 100.0 * no_path / n,
              trapped / n, beacons / n, lost, cpu_ms / n);
}

bool Has(std::span<const controllers::ParameterInfo> infos, const std::string& name) {
  return std::any_of(infos.begin(), infos.end(), [&](const auto& info) { return info.name == name; });
}

void MeasureSettings(const Options& options, sim::RunSpec spec,
                     const std::map<std::string, double>& settings) {
  const auto* scenario = controllers::FindScenario(spec.scenario);
  const auto* controller = controllers::FindController(spec.controller);
  if (controller == nullptr) {
    std::fprintf(stderr, "no controller %s\n", spec.controller.c_str());
    std::exit(2);
  }
  std::printf("%-22s", spec.controller.c_str());
  for (const auto& [name, value] : settings) {
    if (Has(scenario->parameters, name)) spec.scenario_parameters[name] = value;
    if (Has(controller->parameters, name)) spec.controller_parameters[name] = value;
    std::printf(" %s=%g", name.c_str(), value);
  }
  const auto first = static_cast<std::size_t>(options.Count("first"));
  std::vector<sim::RunSpec> empty(static_cast<std::size_t>(options.Count("seeds")), spec);
  for (std::size_t i = 0; i < empty.size(); ++i) empty[i].seed = 1 + first + i;
  std::vector<sim::RunSpec> random(static_cast<std::size_t>(options.Count("cases")), spec);
  const auto parameters = controllers::ResolveParameters(scenario->parameters, spec.scenario_parameters);
  const auto requirements = scenario->requirements(*parameters, spec.test_case);
  for (std::size_t i = 0; i < random.size(); ++i) {
    random[i].seed = 10'001 + first + i;
    random[i].test_case = RandomCase(static_cast<std::uint32_t>(first + i), options.Count("genes"),
                                     options.amounts.at("l_max"), requirements);
  }
  Measure(empty, options.Count("threads"));
  Measure(random, options.Count("threads"));
  std::printf("\n");
  std::fflush(stdout);
}

// Every combination of the knobs' values.
void MeasureGrid(const Options& options, const sim::RunSpec& spec,
                 std::map<std::string, std::vector<double>>::const_iterator knob,
                 std::map<std::string, double> settings) {
  if (knob == options.knobs.end()) return MeasureSettings(options, spec, settings);
  for (const double value : knob->second) {
    settings[knob->first] = value;
    MeasureGrid(options, spec, std::next(knob), settings);
  }
}

int Main(int argc, char** argv) {
  const Options options = ParseOptions(argc, argv);
  std::printf(
      "controller | empty, then random: items, sd, no items, no path, trapped, beacons, lost, ms/run\n");
  for (const std::string& controller : options.controllers) {
    sim::RunSpec spec;
    spec.scenario = "foraging";
    spec.controller = controller;
    MeasureGrid(options, spec, options.knobs.begin(), {});
  }
  return 0;
}

}  // namespace
}  // namespace gauntlet

int main(int argc, char** argv) {
  return gauntlet::Main(argc, argv);
}
