#include "controllers/foraging/foraging_registry.h"

#include <algorithm>

#include "controllers/common/parameters.h"
#include "sim/geometry/trigonometry.h"

namespace gauntlet::controllers {
namespace {

using sim::kDegree;
using sim::kPi;

constexpr std::string_view kVirtualPheromone = "foraging";
constexpr std::string_view kImproved = "foraging-improved";
constexpr std::string_view kRandomSide = "foraging-random-side";
constexpr std::string_view kBasic = "foraging-basic";

constexpr std::array kScenarioParameters = std::to_array<ParameterInfo>({
    {"robots", "", 20, 1, 100, true, "swarm size; a test case may override it (thesis 5.4.1)"},
    {"time_limit", "s", 800, 1, 3600, false, "items are counted until then (thesis 5.4.1)"},
    {"nest_food_distance", "m", 4.0, 1.5, 20.0, false,
     "between the centres of nest and food, on the y axis (thesis 5.4.1)"},
    {"nest_radius", "m", 0.5, 0.2, 2.0, false, "dark floor (chosen)"},
    {"food_radius", "m", 0.25, 0.05, 1.0, false, "the food is no body; robots stop at its edge (chosen)"},
    {"spawn_radius", "m", 0.8, 0.3, 5.0, false, "robots start in this disc around the nest (chosen)"},
    {"clearance", "m", 0.30, 0.0, 1.0, false,
     "no obstacle nearer than this to the centres of nest and food (chosen)"},
    {"food_visible_range", "m", 1.6373, 0.2, 10.0, false,
     "half side of the square in which a robot sees the food (ARGoS: 0.2887 m * tan(80 degrees))"},
    {"communication_range", "m", 3.0, 0.1, 10.0, false,
     "of range-and-bearing (default of ARGoS; calibrated)"},
    {"bodies_block_radio", "bool", 0, 0, 1, true, "no messages through other robots (chosen: off)"},
    {"pickup_time", "s", 2.0, 0.0, 60.0, false, "a robot stops at the food for this long (chosen)"},
    {"serving_interval", "s", 60.0, 0.0, 600.0, false, "from one item to the next (calibrated)"},
    {"trapped_window", "s", 120.0, 10.0, 3600.0, false,
     "trapped: kept within trapped_radius for this long at the end, neither a beacon nor waiting (chosen)"},
    {"trapped_radius", "m", 0.5, 0.05, 5.0, false, "around the robot's mean position (chosen)"},
});

constexpr std::array kMetrics = std::to_array<MetricInfo>({
    {"food_taken", "", false, "items taken from the food"},
    {"food_carried", "", false, "items in the robots' hands at the end"},
    {"food_lost", "", false, "items that a robot lost on its way"},
    {"first_item_time", "s", true, "when the first item was dropped at the nest"},
    {"first_path_time", "s", true, "when beacons first joined nest and food", true},
    {"condition_1", "yes/no", false, "no path of beacons ever (thesis 5.4.2)"},
    {"condition_2", "yes/no", false, "no item dropped at the nest (thesis 5.4.2)"},
    {"trapped_robots", "", false, "robots that stayed within a small place for the last 120 s, beacons aside",
     true},
    {"food_window_*", "", false, "items dropped in each 120 s"},
    {"mean_robots_*", "", false, "robots in that state, mean over the run"},
});

constexpr std::array kForagerParameters = std::to_array<ParameterInfo>({
    {"speed", "m/s", 0.05, 0.005, 0.3, false, "forward speed (thesis 5.4.1)"},
    {"turn_rate", "rad/s", 0.714, 0.05, 4.0, false, "on the spot (2 * speed / wheel distance; calibrated)"},
    {"straight_within", "rad", 10.0 * kDegree, 0.0, kPi / 2.0, false,
     "a smaller bearing means straight on (released controller)"},
    {"hard_turn", "rad", 90.0 * kDegree, 0.2, kPi, false,
     "a larger bearing means a turn on the spot (released controller)"},
    {"wander_turn_probability", "", 0.003, 0.0, 1.0, false, "chance of a new heading per tick (calibrated)"},
    {"wander_turn_limit", "rad", 115.0 * kDegree, 0.0, kPi, false,
     "largest change of heading of the random walk (Buchanan's dps code)"},
    {"avoid_distance", "m", 0.06, 0.005, 0.095, false,
     "something nearer to the body in front is turned away from (chosen)"},
    {"avoid_clear_distance", "m", 0.08, 0.005, 0.099, false,
     "the turn ends when nothing in front is nearer (chosen)"},
    {"avoid_front", "rad", 60.0 * kDegree, 0.15, kPi, false, "to either side of the heading (chosen)"},
    {"avoid_time", "s", 2.0, 0.0, 60.0, false, "straight on after the turn (chosen)"},
    {"food_memory", "s", 2.0, 0.0, 60.0, false, "gathering ends when the food is unseen for longer (chosen)"},
});

constexpr std::array kBeaconParameters = std::to_array<ParameterInfo>({
    {"pheromone_decay_time", "s", 300.0, 1.0, 1e6, false, "a level falls to 1/e in this time (calibrated)"},
    {"pheromone_trail_time", "s", 60.0, 1.0, 1e6, false,
     "a way that took this much longer lays 1/e of the pheromone (calibrated)"},
    {"follow_level", "", 1e-3, 1e-300, 1.0, false,
     "Following needs more pheromone towards the food (chosen)"},
    {"home_level", "", 1e-6, 1e-300, 1.0, false, "F-Homing needs more pheromone towards the nest (chosen)"},
    {"reached_distance", "m", 0.40, 0.18, 2.0, false, "between centres: a beacon is reached (chosen)"},
    {"bar_time", "s", 20.0, 0.0, 600.0, false,
     "a robot that reached the best beacon in vain follows none for this long (calibrated)"},
    {"become_beacon_probability", "", 0.1, 0.0, 1.0, false,
     "per tick, when fewer than two beacons are in range (chosen: decisions of a tick are not seen in it)"},
    {"leave_beacon_rate", "1/s", 0.1, 0.0, 10.0, false,
     "P: a beacon with more than two others in range leaves (thesis 5.2.1; chosen)"},
});

constexpr std::array kFieldParameters = std::to_array<ParameterInfo>({
    {"field_least_push", "", 0.1, 0.0, 10.0, false,
     "a sum of proximity readings shorter than this repels nobody (chosen)"},
    {"field_analytic", "bool", 0, 0, 1, true, "Khatib's law of repulsion instead of a unit vector (option)"},
    {"field_reach", "m", 0.10, 0.02, 0.10, false, "d0 of Khatib's law (range of the proximity ring)"},
    {"field_balance", "m", 0.05, 0.01, 0.0999, false,
     "where Khatib's repulsion equals the attraction (chosen)"},
});

constexpr auto kPheromoneParameters = Joined(kForagerParameters, kBeaconParameters);
constexpr auto kImprovedParameters = Joined(kPheromoneParameters, kFieldParameters);

sim::ArenaRequirements Requirements(const sim::Parameters& parameters, const sim::TestCase& /*test_case*/) {
  return RequirementsOf(ForagingSettingsFrom(parameters), parameters);
}

std::unique_ptr<sim::Scenario> Create(const sim::RunSpec& spec) {
  const ForagingSettings settings = ForagingSettingsFrom(spec.scenario_parameters);
  return std::make_unique<ForagingScenario>(
      spec.test_case, settings, ForagerSettingsFrom(spec.controller, spec.controller_parameters, settings),
      spec.seed);
}

}  // namespace

ForagingSettings ForagingSettingsFrom(const sim::Parameters& parameters) {
  const auto get = [&](const char* name) { return GetParameter(parameters, name); };
  ForagingSettings settings;
  ReadNestAndFood(parameters, settings);
  settings.camera_range = get("food_visible_range");
  settings.bodies_block_radio = get("bodies_block_radio") != 0.0;
  settings.pickup_distance = settings.food_radius + sim::foot_bot::kRadius;
  settings.serving_interval = ToTicks(get("serving_interval"));
  return settings;
}

ForagerSettings ForagerSettingsFrom(std::string_view controller, const sim::Parameters& parameters,
                                    const ForagingSettings& scenario) {
  const auto get = [&](const char* name) { return GetParameter(parameters, name); };
  ForagerSettings settings;
  settings.speed = get("speed");
  settings.steering = {get("straight_within"), get("hard_turn"), get("turn_rate")};
  settings.wander = {get("wander_turn_probability"), get("wander_turn_limit")};
  settings.avoidance.near_distance = get("avoid_distance");
  settings.avoidance.clear_distance = std::max(get("avoid_distance"), get("avoid_clear_distance"));
  settings.avoidance.front_angle = get("avoid_front");
  settings.avoidance.speed = settings.speed;
  settings.avoidance.turn_rate = settings.steering.turn_rate;
  settings.avoidance.escape_ticks = ToTicks(get("avoid_time"));
  settings.avoidance.random_side = controller == kRandomSide || controller == kImproved;
  settings.pickup_distance = scenario.pickup_distance;
  settings.food_memory = ToTicks(get("food_memory"));
  if (controller != kBasic) {
    BeaconSettings& beacons = settings.beacons.emplace();
    beacons.pheromone = {get("pheromone_decay_time"), get("pheromone_trail_time"), settings.speed};
    beacons.communication_range = scenario.communication_range;
    beacons.follow_staleness = -sim::Log(get("follow_level"));
    beacons.home_staleness = -sim::Log(get("home_level"));
    beacons.reached_distance = get("reached_distance");
    beacons.bar_ticks = ToTicks(get("bar_time"));
    beacons.become_chance = get("become_beacon_probability");
    beacons.leave_chance = get("leave_beacon_rate") * sim::kTickSeconds;
  }
  if (controller == kImproved) {
    settings.field = PotentialFieldSettings{get("field_least_push"), get("field_analytic") != 0.0,
                                            get("field_reach"), get("field_balance")};
  }
  return settings;
}

const ScenarioInfo& ForagingScenarioInfo() {
  static const ScenarioInfo info = {
      .name = "foraging",
      .description = "robots bring items from a source of food to the nest (thesis chapter 5)",
      .default_controller = "foraging",
      .words = {.lost = "trapped", .lost_is_failure = false},
      .parameters = kScenarioParameters,
      .time_limit = "time_limit",
      .metrics = kMetrics,
      .failure_types = ForagingFailureTypes(),
      .requirements = Requirements,
      .create = Create,
  };
  return info;
}

const std::array<ControllerInfo, 4>& ForagingControllerInfos() {
  static const std::array<ControllerInfo, 4> infos = {{
      {kVirtualPheromone, "foraging",
       "the VP algorithm of thesis 5.2.1: beacons keep pheromone; avoids obstacles by turning left",
       kPheromoneParameters},
      {kImproved, "foraging",
       "the improved VP of thesis 5.5.2.2: a potential field when a target is in range", kImprovedParameters},
      {kRandomSide, "foraging", "VP that avoids obstacles to a random side (thesis 5.5.2, found no better)",
       kPheromoneParameters},
      {kBasic, "foraging", "the basic algorithm of thesis 2.4.2.1: no beacons, no pheromone",
       kForagerParameters},
  }};
  return infos;
}

}  // namespace gauntlet::controllers
