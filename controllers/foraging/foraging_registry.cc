#include "controllers/foraging/foraging_registry.h"

#include <algorithm>
#include <array>

#include "base/number_text.h"
#include "sim/geometry/trigonometry.h"

namespace gauntlet::controllers {
namespace {

using sim::kDegree;
using sim::kPi;

const std::vector<MetricInfo> kForagingMetrics = {
    {"food_taken", "", {}, "items taken from the food", true},
    {"food_carried", "", {}, "items in the robots' hands at the end"},
    {"food_lost", "", {}, "items that a robot lost on its way"},
    {"first_item_time", "s", kNotMeasured, "when the first item was dropped at the nest"},
    {"first_path_time", "s", kNotMeasured, "when beacons first joined nest and food", true},
    {"condition_1", "yes/no", {}, "no path of beacons ever (thesis 5.4.2)"},
    {"condition_2", "yes/no", {}, "no item dropped at the nest (thesis 5.4.2)"},
    {"trapped_robots",
     "",
     {},
     "robots that stayed within a small place for the last 120 s, beacons aside",
     true},
    {"median_x", "m", {}, "of the robots' places in every second of the run", true},
    {"median_y", "m", {}, "of the robots' places in every second of the run", true},
    {"spread_x", "m", {}, "standard deviation of the robots' places over the run", true},
    {"spread_y", "m", {}, "standard deviation of the robots' places over the run", true},
    {"food_window_*", "", {}, "items dropped in each 120 s"},
    {"mean_robots_*", "", {}, "robots in that state, mean over the run"},
};

const std::vector<sim::AnnotationStyle> kForagingAnnotations = {
    {"beacon", "", sim::Mark::kBeacon, "beacon at the end"},
    {"states", "beacon", sim::Mark::kFormerBeacon, "beacon earlier"},
    {"chain", "", sim::Mark::kChain, ""},
    {"disc", "nest", sim::Mark::kNest, ""},
    {"disc", "food", sim::Mark::kFood, ""},
};

Status CheckField(const ForagerSettings& settings) {
  const auto& field = settings.field;
  if (!field || !field->analytic || field->balance < field->reach) return Ok{};
  return InvalidInput("field-law: field_balance = " + NumberText(field->balance) +
                      " m must be below field_reach = " + NumberText(field->reach) + " m");
}

ControllerFactory MakeForagers(const ForagerSettings& settings) {
  return {.create =
              [settings](const ControllerContext& context) {
                return std::make_unique<ForagingController>(settings, context);
              },
          .traits = {.marks_path = settings.beacons.has_value()},
          .check = [settings](const sim::Arena&) { return CheckField(settings); }};
}

}  // namespace

const ParameterTable<ForagingSettings>& ForagingParameters() {
  using S = ForagingSettings;
  static const ParameterTable<S> table({
      {"robots", "", 20, 1, 100, Into<&S::robots>(),
       "swarm size; a test case may override it (thesis 5.4.1)"},
      {"time_limit", "s", 800, 1, 3600, IntoTicks<&S::tick_limit>(),
       "items are counted until then (thesis 5.4.1)"},
      {"nest_food_distance", "m", 4.0, 1.5, 20.0, Into<&S::nest_food_distance>(),
       "between the centres of nest and food, on the y axis (thesis 5.4.1)"},
      {"nest_radius", "m", 0.5, 0.2, 2.0, Into<&S::nest_radius>(), "dark floor (chosen)"},
      {"food_radius", "m", 0.25, 0.05, 1.0, Fill<S>{[](S& s, double radius) {
         s.food_radius = radius;
         s.pickup_distance = radius + sim::foot_bot::kRadius;
       }},
       "the food is no body; robots stop at its edge (chosen)"},
      {"spawn_radius", "m", 0.8, 0.3, 5.0, Into<&S::spawn_radius>(),
       "robots start in this disc around the nest (chosen)"},
      {"clearance", "m", 0.30, 0.0, 1.0, Into<&S::clearance>(),
       "no obstacle nearer than this to the centres of nest and food (chosen)"},
      {"food_visible_range", "m", 1.6373, 0.2, 10.0, Into<&S::camera_range>(),
       "half side of the square in which a robot sees the food (ARGoS: 0.2887 m * tan(80 degrees))"},
      {"communication_range", "m", 3.0, 0.1, 10.0, Into<&S::communication_range>(),
       "of range-and-bearing (default of ARGoS; calibrated)"},
      {"bodies_block_radio", "bool", 0, 0, 1, Into<&S::bodies_block_radio>(),
       "no messages through other robots (chosen: off)"},
      {"pickup_time", "s", 2.0, 0.0, 60.0, IntoTicks<&S::pickup>(),
       "a robot stops at the food for this long (chosen)"},
      {"serving_interval", "s", 60.0, 0.0, 600.0, IntoTicks<&S::serving_interval>(),
       "from one item to the next (calibrated)"},
      {"trapped_window", "s", 120.0, 10.0, 3600.0, IntoTicks<&S::trapped_window>(),
       "trapped: kept within trapped_radius for this long at the end, neither a beacon nor waiting (chosen)"},
      {"trapped_radius", "m", 0.5, 0.05, 5.0, Into<&S::trapped_radius>(),
       "around the robot's mean position (chosen)"},
  });
  return table;
}

const ParameterTable<ForagerSettings>& BasicForagerParameters() {
  using S = ForagerSettings;
  static const ParameterTable<S> table({
      {"speed", "m/s", 0.05, 0.005, 0.3,
       Fill<S>{[](S& s, double speed) { s.speed = s.avoidance.speed = speed; }},
       "forward speed (thesis 5.4.1)"},
      {"turn_rate", "rad/s", 0.714, 0.05, 4.0,
       Fill<S>{[](S& s, double rate) { s.steering.turn_rate = s.avoidance.turn_rate = rate; }},
       "on the spot (2 * speed / wheel distance; calibrated)"},
      {"straight_within", "rad", 10.0 * kDegree, 0.0, kPi / 2.0,
       Into<&S::steering, &SteeringThresholds::straight>(),
       "a smaller bearing means straight on (released controller)"},
      {"hard_turn", "rad", 90.0 * kDegree, 0.2, kPi, Into<&S::steering, &SteeringThresholds::hard>(),
       "a larger bearing means a turn on the spot (released controller)"},
      {"wander_turn_probability", "", 0.003, 0.0, 1.0,
       Into<&S::wander, &RandomWalkParameters::turn_probability>(),
       "chance of a new heading per tick (calibrated)"},
      {"wander_turn_limit", "rad", 115.0 * kDegree, 0.0, kPi,
       Into<&S::wander, &RandomWalkParameters::turn_limit>(),
       "largest change of heading of the random walk (Buchanan's dps code)"},
      {"avoid_distance", "m", 0.06, 0.005, 0.095, Into<&S::avoidance, &TurnAsideSettings::near_distance>(),
       "something nearer to the body in front is turned away from (chosen)"},
      {"avoid_clear_distance", "m", 0.08, 0.005, 0.099, Fill<S>{[](S& s, double distance) {
         s.avoidance.clear_distance = std::max(s.avoidance.near_distance, distance);
       }},
       "the turn ends when nothing in front is nearer (chosen)"},
      {"avoid_front", "rad", 60.0 * kDegree, 0.15, kPi,
       Into<&S::avoidance, &TurnAsideSettings::front_angle>(), "to either side of the heading (chosen)"},
      {"avoid_time", "s", 2.0, 0.0, 60.0, IntoTicks<&S::avoidance, &TurnAsideSettings::escape_ticks>(),
       "straight on after the turn (chosen)"},
      {"food_memory", "s", 2.0, 0.0, 60.0, IntoTicks<&S::food_memory>(),
       "gathering ends when the food is unseen for longer (chosen)"},
  });
  return table;
}

const ParameterTable<ForagerSettings>& ForagerParameters() {
  using S = ForagerSettings;
  static const ParameterTable<S> table(
      BasicForagerParameters(),
      {
          {"pheromone_decay_time", "s", 300.0, 1.0, 1e6,
           Into<&S::beacons, &BeaconSettings::pheromone, &PheromoneSettings::decay_time>(),
           "a level falls to 1/e in this time (calibrated)"},
          {"pheromone_trail_time", "s", 60.0, 1.0, 1e6,
           Into<&S::beacons, &BeaconSettings::pheromone, &PheromoneSettings::trail_time>(),
           "a trip that took this much longer lays 1/e of the pheromone (calibrated)"},
          {"follow_level", "", 1e-3, 1e-300, 1.0,
           Fill<S>{[](S& s, double level) { s.beacons->follow_staleness = -sim::Log(level); }},
           "Following needs more pheromone towards the food (chosen)"},
          {"home_level", "", 1e-6, 1e-300, 1.0,
           Fill<S>{[](S& s, double level) { s.beacons->home_staleness = -sim::Log(level); }},
           "F-Homing needs more pheromone towards the nest (chosen)"},
          {"reached_distance", "m", 0.40, 0.18, 2.0, Into<&S::beacons, &BeaconSettings::reached_distance>(),
           "between centres: a beacon is reached (chosen)"},
          {"bar_time", "s", 20.0, 0.0, 600.0, IntoTicks<&S::beacons, &BeaconSettings::bar_ticks>(),
           "a robot that reached the best beacon in vain follows none for this long (calibrated)"},
          {"become_beacon_probability", "", 0.1, 0.0, 1.0,
           Into<&S::beacons, &BeaconSettings::become_chance>(),
           "per tick, when fewer than two beacons are in range (chosen: decisions of a tick are not seen in "
           "it)"},
          {"leave_beacon_rate", "1/s", 0.1, 0.0, 10.0,
           Fill<S>{[](S& s, double rate) { s.beacons->leave_chance = rate * sim::kTickSeconds; }},
           "P: a beacon with more than two others in range leaves (thesis 5.2.1; chosen)"},
      });
  return table;
}

const ParameterTable<ForagerSettings>& RandomSideForagerParameters() {
  static const ParameterTable<ForagerSettings> table = [] {
    ForagerSettings start;
    start.avoidance.random_side = true;
    return ForagerParameters().StartingFrom(start);
  }();
  return table;
}

const ParameterTable<ForagerSettings>& ImprovedForagerParameters() {
  using S = ForagerSettings;
  static const ParameterTable<S> table(
      RandomSideForagerParameters(),
      {
          {"field_least_push", "", 0.1, 0.0, 10.0, Into<&S::field, &PotentialFieldSettings::least_push>(),
           "a sum of proximity readings shorter than this repels nobody (chosen)"},
          {"field_analytic", "bool", 0, 0, 1, Into<&S::field, &PotentialFieldSettings::analytic>(),
           "Khatib's law of repulsion instead of a unit vector (option)"},
          {"field_reach", "m", 0.10, 0.02, 0.10, Into<&S::field, &PotentialFieldSettings::reach>(),
           "d0 of Khatib's law (range of the proximity ring)"},
          {"field_balance", "m", 0.05, 0.01, 0.0999, Into<&S::field, &PotentialFieldSettings::balance>(),
           "where Khatib's repulsion equals the attraction (chosen)"},
      });
  return table;
}

const ScenarioInfo& ForagingScenarioInfo() {
  static const ScenarioInfo info = ScenarioRow<ForagingScenario>(
      ForagingParameters(),
      {
          .name = "foraging",
          .description = "robots bring items from a source of food to the nest (thesis chapter 5)",
          .default_controller = "foraging",
          .style = {.lost = "trapped", .lost_is_failure = false, .annotations = kForagingAnnotations},
          .metrics = kForagingMetrics,
          .failing = "condition_2",  // condition 1 alone holds in 30 % of empty arenas
          .failures = {.axes = {{"mean_robots_beacon", 0.0, 10.0, 5}, {"spread_x", 0.5, 2.0, 5}},
                       .kinds = {{"condition_1", 0.0, "a path of beacons, but no item came home"},
                                 {"condition_1", 1.0, "never a path of beacons"}}},
          .failure_types = {.types = ForagingFailureTypes(),
                            .note = "condition 1 alone says little: it holds in 30 % of runs in an empty "
                                    "arena, condition 2 in none of 200"},
      });
  return info;
}

std::span<const ControllerInfo> ForagingControllers() {
  static const std::array rows = {
      ControllerRow(
          "foraging", "foraging",
          "the VP algorithm of thesis 5.2.1: beacons keep pheromone; avoids obstacles by turning left",
          ForagerParameters(), MakeForagers),
      ControllerRow("foraging-improved", "foraging",
                    "the improved VP of thesis 5.5.2.2: a potential field when a target is in range",
                    ImprovedForagerParameters(), MakeForagers),
      ControllerRow("foraging-random-side", "foraging",
                    "VP that avoids obstacles to a random side (thesis 5.5.2, found no better)",
                    RandomSideForagerParameters(), MakeForagers),
      ControllerRow("foraging-basic", "foraging",
                    "the basic algorithm of thesis 2.4.2.1: no beacons, no pheromone",
                    BasicForagerParameters(), MakeForagers),
  };
  return rows;
}

}  // namespace gauntlet::controllers
