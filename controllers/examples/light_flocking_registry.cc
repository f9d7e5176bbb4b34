#include "controllers/examples/light_flocking_registry.h"

#include <array>

#include "sim/geometry/trigonometry.h"

namespace gauntlet::controllers::light_flocking {
namespace {

using sim::kDegree;
using sim::kPi;

const std::vector<MetricInfo> kLightFlockingMetrics = {
    {"light_distance", "m", {}, "mean distance of the robots to the light at the end"},
    {"stopped", "", {}, "share of the robots that moved less than 2 cm in the last 30 s", true},
    {"clusters", "", {}, "groups of robots that are linked by line of sight at the end", true},
};

const std::vector<sim::AnnotationStyle> kLightFlockingAnnotations = {
    {"area", "", sim::Mark::kArea, "area the swarm starts in"},
    {"disc", "light", sim::Mark::kGoal, ""},
};

}  // namespace

// Defaults of both tables: ARGoS' sample flocking behaviour as the released test cases of the thesis
// configure it.
const ParameterTable<LightFlockingScenarioSettings>& LightFlockingScenarioParameters() {
  using S = LightFlockingScenarioSettings;
  static const ParameterTable<S> table({
      {"robots", "", 10, 1, 100, Into<&S::robots>(),
       "robots under test; a test case may override it (released test cases)"},
      {"time_limit", "s", 200, 1, 3600, IntoTicks<&S::tick_limit>(), "length of a run (released test cases)"},
      {"corner_distance", "m", 0.5, 0.2, 2.9, Into<&S::corner_distance>(),
       "start and light from the walls' centre lines (released test cases)"},
      {"spawn_side", "m", 1.0, 0.3, 6.0, Into<&S::spawn_side>(),
       "square in the corner that robots start in (released test cases)"},
      {"camera_range", "m", 1.6373, 0.2, 10.0, Into<&S::camera_range>(),
       "half side of the square a robot sees (ARGoS: 0.2887 m * tan(80 degrees), released test cases)"},
      {"light_height", "m", 0.5, 0.0, 0.9, Into<&S::light_height>(),
       "height of the light (released test cases)"},
      {"light_intensity", "", 3.0, 0.1, 10.0, Into<&S::light_intensity>(),
       "ARGoS' intensity: seen up to 2.5 times as many metres away (released test cases)"},
  });
  return table;
}

const ParameterTable<LightFlockingSettings>& LightFlockingParameters() {
  using S = LightFlockingSettings;
  static const ParameterTable<S> table({
      {"target_distance", "m", 0.75, 0.2, 3.0, Into<&S::target_distance>(),
       "distance that flockmates keep (ARGoS sample: 75 cm)"},
      {"gain", "m^2/s", 0.1, 0.0, 10.0, Into<&S::gain>(),
       "strength of the force (ARGoS sample: 1000 cm^2/s)"},
      {"exponent", "", 2, 1, 6, Into<&S::exponent>(), "exponent of the force (ARGoS sample)"},
      {"cutoff", "", 1.8, 1.0, 5.0, Into<&S::cutoff>(),
       "flockmates beyond this times the target distance do not count (ARGoS sample: 180 %)"},
      {"max_speed", "m/s", 0.1, 0.005, 0.3, Into<&S::max_speed>(),
       "speed of a wheel (ARGoS sample: 10 cm/s)"},
      {"light_share", "", 0.25, 0.0, 1.0, Into<&S::light_share>(),
       "pull of the light relative to max_speed (ARGoS sample)"},
      {"no_turn", "rad", 10.0 * kDegree, 0.0, kPi, Into<&S::no_turn>(),
       "up to here straight on (ARGoS sample)"},
      {"soft_turn", "rad", 70.0 * kDegree, 0.0, kPi, Into<&S::soft_turn>(),
       "a turn on the spot becomes an arc down from here (ARGoS sample)"},
      {"hard_turn", "rad", 90.0 * kDegree, 0.1, kPi, Into<&S::hard_turn>(),
       "beyond it a turn on the spot, below it an arc (ARGoS sample)"},
  });
  return table;
}

ControllerFactory MakeLightFlockers(const LightFlockingSettings& settings) {
  return {
      .create = [settings](
                    const ControllerContext&) { return std::make_unique<LightFlockingController>(settings); },
      .traits = {.link_range = settings.cutoff * settings.target_distance}};
}

const ScenarioInfo& LightFlockingScenarioInfo() {
  static const ScenarioInfo info = ScenarioRow<LightFlockingScenario>(
      LightFlockingScenarioParameters(),
      {
          .name = "light-flocking",
          .description = "example: robots flock from corner to corner, to a light (ARGoS' sample behaviour)",
          .default_controller = "light-flocking",
          .style = {.annotations = kLightFlockingAnnotations},
          .metrics = kLightFlockingMetrics,
      });
  return info;
}

std::span<const ControllerInfo> LightFlockingControllers() {
  static const std::array rows = {ControllerRow(
      "light-flocking", "light-flocking",
      "example: Lennard-Jones forces between robots and a light that draws them (ARGoS' sample behaviour)",
      LightFlockingParameters(), MakeLightFlockers)};
  return rows;
}

}  // namespace gauntlet::controllers::light_flocking
