#include "controllers/generic/generic_registry.h"

#include <array>
#include <memory>
#include <utility>

#include "sim/geometry/trigonometry.h"

namespace gauntlet::controllers::generic {
namespace {

using sim::kPi;

const std::vector<sim::AnnotationStyle> kGenericAnnotations = {
    {"area", "start of the robots", sim::Mark::kArea, "area the swarm starts in"},
    {"area", "ground", sim::Mark::kArea, ""},
    {"area", "source", sim::Mark::kArea, ""},
    {"area", "nest", sim::Mark::kArea, ""},
    {"disc", "ground", sim::Mark::kGoal, ""},
    {"disc", "source", sim::Mark::kFood, ""},
    {"disc", "nest", sim::Mark::kNest, ""},
    {"disc", "goal", sim::Mark::kGoal, ""},
    {"disc", "light", sim::Mark::kGoal, ""},
};

}  // namespace

const ParameterTable<GenericSettings>& GenericParameters() {
  using S = GenericSettings;
  static const ParameterTable<S> table({
      {"robots", "", 10, 1, 100, Into<&S::robots>(), "robots under test; a test case may override it"},
      {"time_limit", "s", 120, 1, 3600, IntoTicks<&S::tick_limit>(), "length of a run at most"},
      {"spawn_x", "m", 0, -50, 50, Into<&S::spawn_x>(), "centre of the rectangle that robots start in"},
      {"spawn_y", "m", 0, -50, 50, Into<&S::spawn_y>(), "likewise"},
      {"spawn_length", "m", 2, 0.2, 100, Into<&S::spawn_length>(), "of that rectangle, along x"},
      {"spawn_width", "m", 2, 0.2, 100, Into<&S::spawn_width>(), "of that rectangle, along y"},
      {"heading", "rad", 0, -kPi, kPi, Into<&S::heading>(), "that robots start with; 0 = along x"},
      {"heading_spread", "rad", kPi, 0, kPi, Into<&S::heading_spread>(),
       "headings differ from it by at most this; pi = any heading"},
      {"camera_range", "m", 1.6373, 0.2, 10, Into<&S::camera_range>(),
       "half side of the square a robot sees (ARGoS: 0.2887 m * tan(80 degrees))"},
      {"communication_range", "m", sim::foot_bot::kRangeAndBearingRange, 0.1, 10,
       Into<&S::communication_range>(), "of range-and-bearing (ARGoS' default)"},
      {"goal_x",
       "m",
       0,
       -50,
       50,
       {[](S& settings, double v) { settings.goal.x() = v; }},
       "x of the goal, to which the measures refer and every layout leaves a free path"},
      {"goal_y", "m", 0, -50, 50, {[](S& settings, double v) { settings.goal.y() = v; }}, "y of the goal"},
      {"goal_radius", "m", 0.5, 0, 50, Into<&S::goal_radius>(), "robots so near are in the goal"},
      {"clearance", "m", 0, 0, 50, Into<&S::clearance>(),
       "kept free of obstacles around the start's centre and the goal"},
      {"link_range", "m", 0.5, 0.17, 10, Into<&S::link_range>(),
       "robots nearer than this that see each other are in one cluster, whatever a controller's link_range "
       "says (three bodies)"},
      {"trapped_window", "s", 60, 1, 3600, IntoTicks<&S::trapped_window>(),
       "a robot is trapped that kept to its place for this long at the end"},
      {"trapped_radius", "m", 0.1, 0.01, 5, Into<&S::trapped_radius>(),
       "what counts as a place: so far around its mean position (about a body)"},
      {"end_when_reached", "bool", 0, 0, 1, Into<&S::end_when_reached>(),
       "the run is over as soon as the formula 'reached' is true"},
  });
  return table;
}

const ScenarioInfo& GenericScenarioInfo() {
  static const ScenarioInfo info = {
      .name = "generic",
      .description =
          "any swarm, defined in the experiment file: lights, floor, items, and formulas that say "
          "how well it did and whether it failed (docs/generic-scenario.md)",
      .default_controller = "light-flocking",
      .style = {.lost = "trapped", .lost_is_failure = false, .annotations = kGenericAnnotations},
      .parameters = GenericParameters().infos(),
      .metrics = Metrics(),
      .failures = {.axes = {{"center_x", -3.0, 3.0, 5}, {"center_y", -3.0, 3.0, 5}},
                   .place = {{"center_x", "center_y", 0.6}}},
      .any_controller = true,
      .check_definition = [](std::string_view definition) -> Status {
        TRY(ParseDefinition(definition));
        return Ok{};
      },
      .requirements =
          [](const sim::Parameters& parameters, const sim::TestCase& test_case) {
            return GenericParameters().Read(parameters).Requirements(test_case);
          },
      .create = [](const sim::RunSpec& spec, ControllerFactory controller) -> std::unique_ptr<sim::Scenario> {
        return std::make_unique<GenericScenario>(
            spec.test_case, GenericParameters().Read(spec.scenario_parameters),
            *ParseDefinition(spec.definition), std::move(controller), spec.seed);
      },
  };
  return info;
}

}  // namespace gauntlet::controllers::generic
