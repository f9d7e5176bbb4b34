// One table of what can be tested: scenarios and controllers by name, each parameter with its unit, default
// and range. The master reads names and parameters; only a runner builds scenarios.
#pragma once

#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "base/result.h"
#include "sim/arena/validity.h"
#include "sim/run_spec.h"
#include "sim/scenario.h"

namespace gauntlet::controllers {

struct ParameterInfo {
  std::string_view name;
  std::string_view unit;  // "m", "m/s", "s", "rad", "" for counts, "bool" for 0/1
  double default_value = 0.0;
  double min = 0.0;
  double max = 0.0;
  bool integer = false;
  std::string_view description;  // one line, with the source of the default
};

// One of the values that a scenario reports of a run.
struct MetricInfo {
  std::string_view name;     // "food_window_*" stands for a family, food_window_1, food_window_2...
  std::string_view unit;     // "m", "s", "deg", "yes/no" for 0/1, "" for counts and ratios
  bool may_be_none = false;  // -1 then says that there was nothing to measure
  std::string_view description;
};

struct ControllerInfo {
  std::string_view name;
  std::string_view scenario;  // the scenario it is written for
  std::string_view description;
  std::span<const ParameterInfo> parameters;
};

struct ScenarioInfo {
  std::string_view name;
  std::string_view description;
  std::string_view default_controller;
  std::span<const ParameterInfo> parameters;
  std::span<const MetricInfo> metrics;
  // What arenas of this scenario must offer, given its resolved parameters and the test case.
  sim::ArenaRequirements (*requirements)(const sim::Parameters& parameters, const sim::TestCase& test_case);
  // Builds the scenario of a resolved, valid spec.
  std::unique_ptr<sim::Scenario> (*create)(const sim::RunSpec& spec);
};

std::span<const ScenarioInfo> Scenarios();
std::span<const ControllerInfo> Controllers();
// nullptr when there is none of that name.
const ScenarioInfo* FindScenario(std::string_view name);
const ControllerInfo* FindController(std::string_view name);

// The metric `name` of a scenario, or the family it belongs to; nullptr when the scenario reports none such.
const MetricInfo* FindMetric(const ScenarioInfo& scenario, std::string_view name);

// Defaults overridden by `given`. Error: unknown name (with the nearest known one), value out of range or not
// whole.
Result<sim::Parameters> ResolveParameters(std::span<const ParameterInfo> infos, const sim::Parameters& given);

// Checks names, parameters and the arena, then builds the scenario. Error: the message begins with the broken
// rule's name and a colon when the test case is at fault.
Result<std::unique_ptr<sim::Scenario>> CreateScenario(const sim::RunSpec& spec);

// The number of robots of the spec's swarm, provided that it can be put into the arena at all. Start places
// are random, so a few seeds from the spec's on are tried, and one that works is enough. Error: as
// CreateScenario, or why the last try failed ("no-room-to-spawn: ...").
Result<std::size_t> CountSwarm(const sim::RunSpec& spec);

}  // namespace gauntlet::controllers
