#include "controllers/flocking/flocking_registry.h"

#include <algorithm>

#include "controllers/common/parameters.h"
#include "sim/geometry/trigonometry.h"

namespace gauntlet::controllers {
namespace {

using sim::kDegree;
using sim::kPi;

constexpr std::array kScenarioParameters = std::to_array<ParameterInfo>({
    {"birds", "", 10, 1, 100, true, "birds under test; a test case may override it (thesis 4.6)"},
    {"min_swarm", "", 5, 1, 100, true, "fewer birds with the prey at the end: total failure (thesis 4.6)"},
    {"time_limit", "s", 900, 1, 3600, false,
     "judged then if the prey has not arrived (chosen: the released 200 s are too short for detours)"},
    {"corner_distance", "m", 0.5, 0.2, 2.9, false,
     "start and goal of the prey from the walls' centre lines (released test cases)"},
    {"spawn_side", "m", 1.0, 0.3, 6.0, false,
     "square in the corner that birds start in (released test cases)"},
    {"goal_radius", "m", 0.15, 0.02, 1.0, false,
     "the run ends when the prey is this near to the goal (chosen)"},
    {"camera_range", "m", 1.6373, 0.2, 10.0, false,
     "half side of the square a bird sees (ARGoS: 0.2887 m * tan(80 degrees), released test cases)"},
    {"link_range", "m", 1.6373, 0.2, 10.0, false,
     "birds farther apart do not follow each other (equal to camera_range, as a disc)"},
    {"link_memory", "s", 2.0, 0.1, 60.0, false, "a link holds for this long without sight (chosen)"},
    {"rejoin_time", "s", 5.0, 0.0, 600.0, false, "birds back within this time did not split off (chosen)"},
    {"split_window", "s", 1.0, 0.2, 20.0, false,
     "velocities of the clusters are taken over this time around a split (chosen)"},
    {"prey_speed", "m/s", 0.05, 0.005, 0.3, false, "speed of the prey (calibrated)"},
    {"prey_turn_rate", "rad/s", 1.5, 0.1, 4.0, false, "largest turn rate of the prey (chosen)"},
    {"prey_drive_within", "rad", 0.5, 0.01, kPi, false,
     "the prey turns on the spot with a larger heading error (chosen)"},
    {"prey_waypoint_radius", "m", 0.10, 0.01, 0.5, false,
     "the prey passes a waypoint at this distance (chosen)"},
    {"prey_inflation", "m", 0.15, 0.10, 0.5, false,
     "the prey plans this far from obstacles, 0.10 where that closes every way (chosen)"},
});

constexpr std::array kMetrics = std::to_array<MetricInfo>({
    {"angular_order", "", false, "agreement of the headings of the birds left, 0 to 1 (thesis 4.5.1)"},
    {"birds_left", "", false, "birds in the prey's cluster at the end"},
    {"proportion_left", "", false, "the same as a share of the birds"},
    {"arrival_time", "s", false, "end of the run: the prey's arrival, or the time limit"},
    {"timeout", "yes/no", false, "whether the prey never arrived"},
    {"prey_path_length", "m", false, "of the planned path"},
    {"splits", "", false, "times birds left the prey's cluster for good"},
    {"split_time", "s", true, "of the last split", true},
    {"split_angle", "rad", true, "between the headings of both clusters around the last split, 0 to pi",
     true},
    {"split_speed_ratio", "", true, "slower cluster over faster one around the last split"},
});

constexpr std::array kBirdParameters = std::to_array<ParameterInfo>({
    {"bird_speed", "m/s", 0.055, 0.005, 0.3, false,
     "forward speed (calibrated; released controller at most 0.10)"},
    {"turn_rate", "rad/s", 45.0 * kDegree, 0.05, 2.0, false, "turn rate of the turning reactions (chosen)"},
    {"straight_within", "rad", 10.0 * kDegree, 0.0, kPi / 2.0, false,
     "a smaller bearing means straight on (released controller)"},
    {"turning_speed_factor", "", 0.5, 0.0, 1.0, false, "forward speed while turning (chosen)"},
    {"obstacle_distance", "m", 0.10, 0.005, 0.10, false,
     "obstacles nearer than this to the body are avoided (ARGoS: range of the proximity ring)"},
    {"obstacle_speed_factor", "", 0.5, 0.0, 1.0, false,
     "forward speed beside an obstacle (thesis 4.7.1; chosen)"},
    {"separation_distance", "m", 0.25, 0.18, 1.0, false,
     "robots nearer than this are turned away from (chosen)"},
    {"wander_turn_probability", "", 0.05, 0.0, 1.0, false,
     "chance of a new heading per tick when nobody is visible (Buchanan's dps code)"},
    {"wander_turn_limit", "rad", 115.0 * kDegree, 0.0, kPi, false,
     "largest change of heading of the random walk (Buchanan's dps code)"},
});

constexpr std::array kCatchUpParameters = std::to_array<ParameterInfo>({
    {"catch_up_distance", "m", 0.3, 0.18, 3.0, false,
     "d_new: a bird hurries when the nearest robot in front is farther (thesis 4.7.2; calibrated)"},
    {"catch_up_gain", "", 2.0, 1.0, 3.0, false,
     "factor on speed and turn rate when hurrying (thesis 4.7.2; calibrated)"},
});

constexpr auto kImprovedBirdParameters = [] {
  std::array<ParameterInfo, kBirdParameters.size() + kCatchUpParameters.size()> all;
  std::copy(kCatchUpParameters.begin(), kCatchUpParameters.end(),
            std::copy(kBirdParameters.begin(), kBirdParameters.end(), all.begin()));
  return all;
}();

const std::vector<FailureType>& FailureTypes() {
  static const std::vector<FailureType> types = [] {
    std::vector<FailureType> all;
    for (int type = 0; type < kFailureTypes; ++type) all.push_back({type, FailureLabel(type)});
    return all;
  }();
  return types;
}

sim::ArenaRequirements Requirements(const sim::Parameters& parameters, const sim::TestCase& test_case) {
  const double corner_distance = GetParameter(parameters, "corner_distance");
  sim::ArenaRequirements requirements;
  requirements.start = FlockingStart(test_case, corner_distance);
  requirements.goal = FlockingGoal(test_case, corner_distance);
  return requirements;
}

std::unique_ptr<sim::Scenario> Create(const sim::RunSpec& spec) {
  return std::make_unique<FlockingScenario>(spec.test_case, FlockingSettingsFrom(spec.scenario_parameters),
                                            BirdSettingsFrom(spec.controller_parameters), spec.seed);
}

}  // namespace

FlockingSettings FlockingSettingsFrom(const sim::Parameters& parameters) {
  FlockingSettings settings;
  settings.birds = static_cast<int>(GetParameter(parameters, "birds"));
  settings.min_swarm = static_cast<int>(GetParameter(parameters, "min_swarm"));
  settings.tick_limit = ToTicks(GetParameter(parameters, "time_limit"));
  settings.corner_distance = GetParameter(parameters, "corner_distance");
  settings.spawn_side = GetParameter(parameters, "spawn_side");
  settings.goal_radius = GetParameter(parameters, "goal_radius");
  settings.camera_range = GetParameter(parameters, "camera_range");
  settings.prey.speed = GetParameter(parameters, "prey_speed");
  settings.prey.turn_rate = GetParameter(parameters, "prey_turn_rate");
  settings.prey.drive_within = GetParameter(parameters, "prey_drive_within");
  settings.prey.waypoint_radius = GetParameter(parameters, "prey_waypoint_radius");
  settings.prey.inflation = GetParameter(parameters, "prey_inflation");
  settings.split.link.range = GetParameter(parameters, "link_range");
  settings.split.link.memory = ToTicks(GetParameter(parameters, "link_memory"));
  settings.split.rejoin = ToTicks(GetParameter(parameters, "rejoin_time"));
  settings.split.half_window = ToTicks(GetParameter(parameters, "split_window") / 2.0);
  return settings;
}

BirdSettings BirdSettingsFrom(const sim::Parameters& parameters) {
  BirdSettings settings;
  settings.speed = GetParameter(parameters, "bird_speed");
  settings.turn_rate = GetParameter(parameters, "turn_rate");
  settings.straight_within = GetParameter(parameters, "straight_within");
  settings.turning_speed_factor = GetParameter(parameters, "turning_speed_factor");
  settings.obstacle_distance = GetParameter(parameters, "obstacle_distance");
  settings.obstacle_speed_factor = GetParameter(parameters, "obstacle_speed_factor");
  settings.separation_distance = GetParameter(parameters, "separation_distance");
  settings.wander.turn_probability = GetParameter(parameters, "wander_turn_probability");
  settings.wander.turn_limit = GetParameter(parameters, "wander_turn_limit");
  if (parameters.contains("catch_up_gain")) {
    settings.catch_up =
        CatchUp{GetParameter(parameters, "catch_up_distance"), GetParameter(parameters, "catch_up_gain")};
  }
  return settings;
}

const ScenarioInfo& FlockingScenarioInfo() {
  static const ScenarioInfo info = {
      .name = "flocking",
      .description = "birds follow a prey from corner to corner without losing anyone (thesis chapter 4)",
      .default_controller = "flocking",
      .words = {.member = "bird"},
      .parameters = kScenarioParameters,
      .time_limit = "time_limit",
      .metrics = kMetrics,
      .failure_types = FailureTypes(),
      .untyped_failure = "without a split",
      .requirements = Requirements,
      .create = Create,
  };
  return info;
}

const std::array<ControllerInfo, 2>& FlockingControllerInfos() {
  static const std::array<ControllerInfo, 2> infos = {{
      {"flocking", "flocking", "the bird of thesis 4.3: sees the prey or its flockmates, avoids obstacles",
       kBirdParameters},
      {"flocking-improved", "flocking", "the bird of thesis 4.7.2: hurries when the robots in front are far",
       kImprovedBirdParameters},
  }};
  return infos;
}

}  // namespace gauntlet::controllers
