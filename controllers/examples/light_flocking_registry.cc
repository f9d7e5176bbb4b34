#include "controllers/examples/light_flocking_registry.h"

#include <array>

#include "controllers/common/parameters.h"
#include "sim/geometry/trigonometry.h"

namespace gauntlet::controllers {
namespace {

using sim::kDegree;
using sim::kPi;

// Defaults: ARGoS' sample flocking behaviour as the released test cases of the thesis configure it.
constexpr std::array kScenarioParameters = std::to_array<ParameterInfo>({
    {"robots", "", 10, 1, 100, true, "robots under test; a test case may override it (released test cases)"},
    {"time_limit", "s", 200, 1, 3600, false, "length of a run (released test cases)"},
    {"corner_distance", "m", 0.5, 0.2, 2.9, false,
     "start and light from the walls' centre lines (released test cases)"},
    {"spawn_side", "m", 1.0, 0.3, 6.0, false,
     "square in the corner that robots start in (released test cases)"},
    {"camera_range", "m", 1.6373, 0.2, 10.0, false,
     "half side of the square a robot sees (ARGoS: 0.2887 m * tan(80 degrees), released test cases)"},
    {"light_height", "m", 0.5, 0.0, 0.9, false, "height of the light (released test cases)"},
    {"light_intensity", "", 3.0, 0.1, 10.0, false,
     "ARGoS' intensity: seen up to 2.5 times as many metres away (released test cases)"},
});

constexpr std::array kMetrics = std::to_array<MetricInfo>({
    {"light_distance", "m", false, "mean distance of the robots to the light at the end"},
    {"stopped", "", false, "share of the robots that moved less than 2 cm in the last 30 s", true},
    {"clusters", "", false, "groups of robots that are linked by line of sight at the end", true},
});

constexpr std::array kControllerParameters = std::to_array<ParameterInfo>({
    {"target_distance", "m", 0.75, 0.2, 3.0, false, "distance that flockmates keep (ARGoS sample: 75 cm)"},
    {"gain", "m^2/s", 0.1, 0.0, 10.0, false, "strength of the force (ARGoS sample: 1000 cm^2/s)"},
    {"exponent", "", 2, 1, 6, true, "exponent of the force (ARGoS sample)"},
    {"cutoff", "", 1.8, 1.0, 5.0, false,
     "flockmates beyond this times the target distance do not count (ARGoS sample: 180 %)"},
    {"max_speed", "m/s", 0.1, 0.005, 0.3, false, "speed of a wheel (ARGoS sample: 10 cm/s)"},
    {"light_share", "", 0.25, 0.0, 1.0, false, "pull of the light relative to max_speed (ARGoS sample)"},
    {"no_turn", "rad", 10.0 * kDegree, 0.0, kPi, false, "up to here straight on (ARGoS sample)"},
    {"soft_turn", "rad", 70.0 * kDegree, 0.0, kPi, false,
     "a turn on the spot becomes an arc down from here (ARGoS sample)"},
    {"hard_turn", "rad", 90.0 * kDegree, 0.1, kPi, false,
     "beyond it a turn on the spot, below it an arc (ARGoS sample)"},
});

sim::ArenaRequirements Requirements(const sim::Parameters& parameters, const sim::TestCase& test_case) {
  const double corner_distance = GetParameter(parameters, "corner_distance");
  sim::ArenaRequirements requirements;
  requirements.start = {test_case.side_x / 2.0 - corner_distance, test_case.side_y / 2.0 - corner_distance};
  requirements.goal = -requirements.start;
  return requirements;
}

std::unique_ptr<sim::Scenario> Create(const sim::RunSpec& spec) {
  return std::make_unique<LightFlockingScenario>(
      spec.test_case, LightFlockingScenarioSettingsFrom(spec.scenario_parameters),
      LightFlockingSettingsFrom(spec.controller_parameters), spec.seed);
}

}  // namespace

LightFlockingScenarioSettings LightFlockingScenarioSettingsFrom(const sim::Parameters& parameters) {
  LightFlockingScenarioSettings settings;
  settings.robots = static_cast<int>(GetParameter(parameters, "robots"));
  settings.tick_limit = ToTicks(GetParameter(parameters, "time_limit"));
  settings.corner_distance = GetParameter(parameters, "corner_distance");
  settings.spawn_side = GetParameter(parameters, "spawn_side");
  settings.camera_range = GetParameter(parameters, "camera_range");
  settings.light_height = GetParameter(parameters, "light_height");
  settings.light_intensity = GetParameter(parameters, "light_intensity");
  return settings;
}

LightFlockingSettings LightFlockingSettingsFrom(const sim::Parameters& parameters) {
  LightFlockingSettings settings;
  settings.target_distance = GetParameter(parameters, "target_distance");
  settings.gain = GetParameter(parameters, "gain");
  settings.exponent = static_cast<int>(GetParameter(parameters, "exponent"));
  settings.cutoff = GetParameter(parameters, "cutoff");
  settings.max_speed = GetParameter(parameters, "max_speed");
  settings.light_share = GetParameter(parameters, "light_share");
  settings.no_turn = GetParameter(parameters, "no_turn");
  settings.soft_turn = GetParameter(parameters, "soft_turn");
  settings.hard_turn = GetParameter(parameters, "hard_turn");
  return settings;
}

const ScenarioInfo& LightFlockingScenarioInfo() {
  static const ScenarioInfo info = {
      .name = "light-flocking",
      .description = "example: robots flock from corner to corner, to a light (ARGoS' sample behaviour)",
      .default_controller = "light-flocking",
      .parameters = kScenarioParameters,
      .time_limit = "time_limit",
      .metrics = kMetrics,
      .requirements = Requirements,
      .create = Create,
  };
  return info;
}

const ControllerInfo& LightFlockingControllerInfo() {
  static const ControllerInfo info = {
      "light-flocking", "light-flocking",
      "example: Lennard-Jones forces between robots and a light that draws them (ARGoS' sample behaviour)",
      kControllerParameters};
  return info;
}

}  // namespace gauntlet::controllers
