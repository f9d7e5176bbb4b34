// What a behaviour declares of itself, as rows of the registry: its scenario, and the controllers that are
// written for it. A scenario never names a controller's class: it is handed a factory from the controller's
// row.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "base/result.h"
#include "controllers/common/odometer.h"
#include "controllers/failure_descriptor.h"
#include "controllers/parameters.h"
#include "sim/arena/validity.h"
#include "sim/run_spec.h"
#include "sim/run_style.h"
#include "sim/scenario.h"

namespace gauntlet::controllers {

// What robots are told of a lamp.
struct Lamp {
  double height = 0.0;     // m above the floor
  double intensity = 0.0;  // as in ARGoS: it shines with exp(-2 D / intensity) at D m in space
};

// What a scenario tells a robot's controller before the run; everything else the robot has to sense. What a
// scenario does not have stays as it is here.
struct ControllerContext {
  sim::RobotIndex robot = 0;         // its own number
  std::uint64_t seed = 0;            // of the run: for generators that are not the robot's RandomStream
  sim::Pose start = {};              // its own, in the arena
  double communication_range = 0.0;  // m, of range-and-bearing
  double pickup_distance = 0.0;      // m from the source's centre to its own, where it gets an item
  Lamp nest_lamp = {};               // above the nest
  bool starts_in_relay = false;      // where items pass in a swarm at work, rather than in the nest
  Odometer odometer = nullptr;       // its own motion
};

// What a scenario has to know of a controller to judge its swarm.
struct ControllerTraits {
  bool marks_path = false;  // robots become beacons, so that a run without a path of them failed
  bool learns_partition_length = false;
  double handover_reach = 0.0;  // m between centres, up to which two robots may hand an item over
  double link_range = 0.0;      // m between centres, up to which two robots are one cluster
};

// A controller with its parameters.
struct ControllerFactory {
  std::function<std::unique_ptr<sim::Controller>(const ControllerContext& context)> create;
  ControllerTraits traits = {};
  // Parameters that contradict one another or the arena: the message begins with a rule's name and a colon.
  // May be empty.
  std::function<Status(const sim::Arena& arena)> check = nullptr;

  Status Check(const sim::Arena& arena) const { return check ? check(arena) : Ok{}; }
};

// Stands for the scenario of a controller that is written for none in particular.
inline constexpr std::string_view kAnyScenario = "any";

struct ControllerInfo {
  std::string name;
  std::string scenario;  // the scenario it is written for, or kAnyScenario
  std::string description;
  std::vector<ParameterInfo> parameters;
  std::function<ControllerFactory(const sim::Parameters& resolved)> make;

  bool WrittenFor(std::string_view name_of_scenario) const {
    return scenario == name_of_scenario || scenario == kAnyScenario;
  }
};

// A row whose controller gets its settings from a table, which outlives the row.
template <typename Settings>
ControllerInfo ControllerRow(std::string_view name, std::string_view scenario, std::string_view description,
                             const ParameterTable<Settings>& table,
                             ControllerFactory (*make)(const Settings& settings)) {
  return {std::string(name), std::string(scenario), std::string(description), table.infos(),
          [&table, make](const sim::Parameters& resolved) { return make(table.Read(resolved)); }};
}

// One of the values that a scenario reports of a run.
struct MetricInfo {
  std::string name;            // "food_window_*" stands for a family, food_window_1, food_window_2...
  std::string unit;            // "m", "s", "rad", "yes/no" for 0/1, "" for counts and ratios
  std::optional<double> none;  // the value that says that there was nothing to measure
  std::string description;
  bool descriptor = false;  // tells how a swarm behaved, so a search may steer by it
  bool operator==(const MetricInfo&) const = default;
};

struct ScenarioInfo {
  std::string name;
  std::string description;
  std::string default_controller;
  sim::RunStyle style = {};
  std::vector<ParameterInfo> parameters = {};
  std::string time_limit = "time_limit";  // the parameter, in s, after which a run ends at the latest
  std::vector<MetricInfo> metrics;
  // What is 1 after a run in which a test case broke the swarm, when cases are confirmed and made smaller:
  // kTotalFailure or a yes/no metric.
  std::string failing = kTotalFailure;
  FailureDescriptor failures = {};
  FailureTypes failure_types = {};
  bool any_controller = false;  // also takes controllers that are written for other scenarios
  // What is wrong with RunSpec::definition. nullptr: the scenario takes none.
  std::function<Status(std::string_view definition)> check_definition = nullptr;
  // What arenas of this scenario must offer, given its resolved parameters and the test case.
  std::function<sim::ArenaRequirements(const sim::Parameters& parameters, const sim::TestCase& test_case)>
      requirements = nullptr;
  // Builds the scenario of a resolved, valid spec.
  std::function<std::unique_ptr<sim::Scenario>(const sim::RunSpec& spec, ControllerFactory controller)>
      create = nullptr;

  bool Takes(const ControllerInfo& controller) const { return any_controller || controller.WrittenFor(name); }
  // The longest that a run with these parameters simulates, s; what they do not name has its default.
  double TimeLimit(const sim::Parameters& given) const;
};

// The row with a scenario that gets its settings from a table, which outlives it. The settings know what they
// require of a test case's arena. The test case that a scenario is built for obeys that; its number of robots
// and its spawn area override the settings. The seed decides the start poses.
template <typename Scenario, typename Settings>
ScenarioInfo ScenarioRow(const ParameterTable<Settings>& table, ScenarioInfo row) {
  row.parameters = table.infos();
  row.requirements = [&table](const sim::Parameters& parameters, const sim::TestCase& test_case) {
    return table.Read(parameters).Requirements(test_case);
  };
  row.create = [&table](const sim::RunSpec& spec, ControllerFactory controller) {
    return std::make_unique<Scenario>(spec.test_case, table.Read(spec.scenario_parameters),
                                      std::move(controller), spec.seed);
  };
  return row;
}

}  // namespace gauntlet::controllers
