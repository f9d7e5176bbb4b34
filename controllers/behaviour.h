// What a behaviour declares of itself, as rows of the registry: its scenario and the controllers written for
// it.
#pragma once

#include <memory>
#include <span>
#include <string>
#include <string_view>

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
  bool descriptor = false;  // tells how a swarm behaved, so a search may steer by it
};

// A way in which the whole swarm can fail, as Evaluate reports it in SwarmFailure.
struct FailureType {
  int type = 0;  // SwarmFailure::type: stored, so do not renumber
  std::string name;
};

// How texts and pictures call what is in a scenario's swarm.
struct SwarmWords {
  std::string_view member = "robot";  // one of those under test, singular
  std::string_view lost = "lost";     // what RobotSummary::lost says of it
  bool lost_is_failure = true;        // total failure means that too many were lost, not something of its own
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
  SwarmWords words = {};
  std::span<const ParameterInfo> parameters;
  std::string_view time_limit;  // the parameter, in s, after which a run ends at the latest
  std::span<const MetricInfo> metrics;
  std::span<const FailureType> failure_types = {};
  std::string_view untyped_failure = "without a type";  // a total failure whose type is -1
  // What arenas of this scenario must offer, given its resolved parameters and the test case.
  sim::ArenaRequirements (*requirements)(const sim::Parameters& parameters, const sim::TestCase& test_case);
  // Builds the scenario of a resolved, valid spec.
  std::unique_ptr<sim::Scenario> (*create)(const sim::RunSpec& spec);

  // The longest that a run with these parameters simulates, s; what they do not name has its default.
  double TimeLimit(const sim::Parameters& given) const;
};

}  // namespace gauntlet::controllers
