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
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <map>
#include <string>
#include <vector>

#include "controllers/registry.h"
#include "tests/controllers/calibration_support.h"

namespace gauntlet {
namespace {

using calibration::MakeSpecs;
using calibration::Metric;
using calibration::RunAll;
using calibration::Specs;

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

void Measure(const std::vector<sim::RunSpec>& specs, int threads) {
  const std::vector<sim::RunResult> results = RunAll(specs, threads);
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
  const Specs specs = MakeSpecs(spec, {.seeds = options.Count("seeds"),
                                       .cases = options.Count("cases"),
                                       .first = options.Count("first"),
                                       .genes = options.Count("genes"),
                                       .l_max = options.amounts.at("l_max")});
  Measure(specs.empty, options.Count("threads"));
  Measure(specs.random, options.Count("threads"));
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
