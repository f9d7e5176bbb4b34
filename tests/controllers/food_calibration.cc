// Prints the figures that the parameters of foraging and of task partitioning were calibrated with (spec
// section 9): the empty arena with many seeds, and random valid cases, for the chosen variants over a grid of
// the knobs. Evolved cases are never looked at.
//
//   food_calibration [name=value ...] [variant ...]
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

struct Column {
  const char* title;
  const char* metric;
  double factor;
};
// After items and sd.
std::vector<Column> ColumnsOf(std::string_view scenario) {
  if (scenario == "foraging") {
    return {{"no path %", "condition_1", 100.0},
            {"trapped", "trapped_robots", 1.0},
            {"beacons", "mean_robots_beacon", 1.0},
            {"lost", "food_lost", 1.0}};
  }
  return {{"trapped", "trapped_robots", 1.0},
          {"transfers", "transfers", 1.0},
          {"broken", "broken_transfers", 1.0},
          {"waits", "waits", 1.0},
          {"timeouts", "wait_timeouts", 1.0},
          {"length", "partition_length", 1.0},
          {"explore", "mean_robots_explore", 1.0},
          {"to nest", "mean_robots_go-to-nest", 1.0},
          {"wait", "mean_robots_wait-for-transfer", 1.0},
          {"lost", "food_lost", 1.0}};
}

void Measure(const std::vector<sim::RunSpec>& specs, int threads) {
  const std::vector<Column> columns = ColumnsOf(specs.empty() ? "" : specs.front().scenario);
  const std::vector<sim::RunResult> results = RunAll(specs, threads);
  std::vector<double> sums(columns.size(), 0.0);
  double mean = 0.0, squares = 0.0, zeros = 0.0, cpu_ms = 0.0, n = 0.0;
  int refused = 0;
  for (const sim::RunResult& result : results) {
    if (result.verdict != sim::Verdict::kCompleted) {
      if (refused++ == 0) std::printf("  refused: %s\n", result.message.c_str());
      continue;
    }
    n += 1.0;
    mean += result.fitness;
    squares += result.fitness * result.fitness;
    zeros += result.fitness == 0.0 ? 1.0 : 0.0;
    cpu_ms += 1e3 * result.cpu_seconds;
    for (std::size_t i = 0; i < columns.size(); ++i) {
      sums[i] += columns[i].factor * Metric(result, columns[i].metric);
    }
  }
  n = std::max(1.0, n);
  mean /= n;
  std::printf(" | %5.2f %5.2f %5.1f", mean, std::sqrt(std::max(0.0, squares / n - mean * mean)),
              100.0 * zeros / n);
  for (const double sum : sums) std::printf(" %6.2f", sum / n);
  std::printf(" %5.1f", cpu_ms / n);
}

bool Has(std::span<const controllers::ParameterInfo> infos, const std::string& name) {
  return std::any_of(infos.begin(), infos.end(), [&](const auto& info) { return info.name == name; });
}

void MeasureSettings(const Options& options, sim::RunSpec spec,
                     const std::map<std::string, double>& settings) {
  const auto* scenario = controllers::FindScenario(spec);
  const auto* controller = controllers::FindController(spec.controller);
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
  for (const std::string& controller : options.controllers) {
    const auto* info = controllers::FindController(controller);
    if (info == nullptr) {
      std::fprintf(stderr, "no controller %s\n", controller.c_str());
      return 2;
    }
    sim::RunSpec spec;
    spec.scenario = info->scenario;
    spec.controller = controller;
    std::printf("%s | empty, then random: items, sd, zero %%", spec.scenario.c_str());
    for (const Column& column : ColumnsOf(spec.scenario)) std::printf(", %s", column.title);
    std::printf(", ms/run\n");
    MeasureGrid(options, spec, options.knobs.begin(), {});
  }
  return 0;
}

}  // namespace
}  // namespace gauntlet

int main(int argc, char** argv) {
  return gauntlet::Main(argc, argv);
}
