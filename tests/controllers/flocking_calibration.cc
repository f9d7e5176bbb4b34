// Prints the figures that the flocking parameters were calibrated with (spec section 9): the empty arena with
// many seeds, and random valid cases, for both birds over a grid of the three knobs. Evolved cases are never
// looked at.
//
//   flocking_calibration [name=value ...]
//     cases=200 seeds=100 threads=2 genes=8        how much
//     first=0                                      number of the first case and seed
//     l_max=2 bird_speed=0.055 prey_speed=0.05      knobs; lists like bird_speed=0.05,0.06 make a grid
//     original=0                                   leaves the original bird out
//     any other name                               a parameter of the scenario or of the controllers
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

using Options = std::map<std::string, std::vector<double>>;

Options ParseOptions(int argc, char** argv) {
  Options options = {{"cases", {200}},       {"seeds", {100}}, {"threads", {2}},
                     {"genes", {8}},         {"l_max", {2.0}}, {"bird_speed", {0.055}},
                     {"prey_speed", {0.05}}, {"first", {0}},   {"original", {1}}};
  for (int i = 1; i < argc; ++i) {
    const std::string argument = argv[i];
    const std::size_t equals = argument.find('=');
    std::vector<double> values;
    for (const char* text = argv[i] + equals + 1; equals != std::string::npos;) {
      char* end = nullptr;
      values.push_back(std::strtod(text, &end));
      if (end == text || *end != ',') break;
      text = end + 1;
    }
    if (values.empty()) {
      std::fprintf(stderr, "not name=value: %s\n", argv[i]);
      std::exit(2);
    }
    options[argument.substr(0, equals)] = values;
  }
  return options;
}

struct Figures {
  double mean = 0.0, sd = 0.0, zeros = 0.0, birds_left = 0.0, order = 0.0, timeouts = 0.0, seconds = 0.0;
  double cpu_ms = 0.0;
  int runs_with_loss = 0;
  int refused = 0;
  std::size_t runs = 0;
};

Figures Measure(const std::vector<sim::RunSpec>& specs, int threads) {
  const std::vector<sim::RunResult> results = RunAll(specs, threads);
  Figures figures;
  double squares = 0.0;
  for (const sim::RunResult& result : results) {
    if (result.verdict != sim::Verdict::kCompleted) {
      if (figures.refused++ == 0) std::printf("  refused: %s\n", result.message.c_str());
      continue;
    }
    ++figures.runs;
    figures.mean += result.fitness;
    squares += result.fitness * result.fitness;
    figures.zeros += result.fitness == 0.0 ? 1.0 : 0.0;
    figures.birds_left += Metric(result, "birds_left");
    figures.order += Metric(result, "angular_order");
    figures.timeouts += Metric(result, "timeout");
    figures.seconds += Metric(result, "arrival_time");
    figures.cpu_ms += 1e3 * result.cpu_seconds;
    if (Metric(result, "proportion_left") < 1.0) ++figures.runs_with_loss;
  }
  const double n = static_cast<double>(std::max<std::size_t>(1, figures.runs));
  for (double* sum : {&figures.mean, &figures.zeros, &figures.birds_left, &figures.order, &figures.timeouts,
                      &figures.seconds, &figures.cpu_ms}) {
    *sum /= n;
  }
  figures.sd = std::sqrt(std::max(0.0, squares / n - figures.mean * figures.mean));
  return figures;
}

int Main(int argc, char** argv) {
  Options options = ParseOptions(argc, argv);
  const auto number = [&](const char* name) { return static_cast<int>(options.at(name).front()); };
  std::printf(
      "controller         l_max v_bird v_prey | empty: lost fitness order | random: fitness    sd  zeros"
      "  birds order timeout seconds refused | ms/run\n");
  for (const double l_max : options.at("l_max")) {
    for (const double prey_speed : options.at("prey_speed")) {
      for (const double bird_speed : options.at("bird_speed")) {
        for (const char* name : {"flocking", "flocking-improved"}) {
          if (number("original") == 0 && std::string(name) == "flocking") continue;
          sim::RunSpec spec;
          spec.scenario = "flocking";
          spec.controller = name;
          const auto* scenario = controllers::FindScenario(spec);
          const auto* controller = controllers::FindController(name);
          const auto has = [](const auto& infos, const std::string& key) {
            return std::any_of(infos.begin(), infos.end(),
                               [&](const auto& info) { return info.name == key; });
          };
          for (const auto& [key, values] : options) {
            if (has(scenario->parameters, key)) spec.scenario_parameters[key] = values.front();
            if (has(controller->parameters, key)) spec.controller_parameters[key] = values.front();
          }
          spec.scenario_parameters["prey_speed"] = prey_speed;
          spec.controller_parameters["bird_speed"] = bird_speed;

          const Specs specs = MakeSpecs(spec, {.seeds = number("seeds"),
                                               .cases = number("cases"),
                                               .first = number("first"),
                                               .genes = number("genes"),
                                               .l_max = l_max});
          const Figures e = Measure(specs.empty, number("threads"));
          const Figures r = Measure(specs.random, number("threads"));
          std::printf(
              "%-18s %5.2f %6.3f %6.3f | %11d %7.4f %5.3f | %15.4f %5.3f %5.1f%% %6.2f %5.3f %6.1f%% "
              "%7.1f %7d | %5.1f %5.1f\n",
              name, l_max, bird_speed, prey_speed, e.runs_with_loss, e.mean, e.order, r.mean, r.sd,
              100.0 * r.zeros, r.birds_left, r.order, 100.0 * r.timeouts, r.seconds, r.refused, e.cpu_ms,
              r.cpu_ms);
          std::fflush(stdout);
        }
      }
    }
  }
  return 0;
}

}  // namespace
}  // namespace gauntlet

int main(int argc, char** argv) {
  return gauntlet::Main(argc, argv);
}
