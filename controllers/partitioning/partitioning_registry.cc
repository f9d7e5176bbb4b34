#include "controllers/partitioning/partitioning_registry.h"

#include <algorithm>
#include <array>

#include "base/number_text.h"
#include "sim/geometry/trigonometry.h"

namespace gauntlet::controllers {
namespace {

using sim::kDegree;
using sim::kPi;

constexpr double kPickupMargin = 0.025;  // m: an item is handed out 0.36 m from the source's centre

const std::vector<MetricInfo> kPartitioningMetrics = {
    {"food_taken", "", {}, "items taken from the source", true},
    {"food_carried", "", {}, "items in the robots' hands at the end"},
    {"food_lost", "", {}, "items that a robot lost on its way"},
    {"first_item_time", "s", kNotMeasured, "when the first item was dropped in the nest"},
    {"transfers", "", {}, "items handed over from robot to robot", true},
    {"broken_transfers", "", {}, "hand-overs that were begun and not finished"},
    {"waits", "", {}, "how often a robot stopped to offer an item", true},
    {"wait_timeouts", "", {}, "how often it carried on because nobody came"},
    {"mean_waiting_time", "s", kNotMeasured, "from stopping to the beginning of a hand-over or carrying on"},
    {"transfer_time", "s", {}, "spent in hand-overs, sum over the givers"},
    {"trapped_robots", "", {}, "robots that stayed within a small place for the last 120 s", true},
    {"partition_length", "m", {}, "mean of the robots at the end"},
    {"median_x", "m", {}, "of the robots' places in every second of the run", true},
    {"median_y", "m", {}, "of the robots' places in every second of the run", true},
    {"spread_x", "m", {}, "standard deviation of the robots' places over the run", true},
    {"spread_y", "m", {}, "standard deviation of the robots' places over the run", true},
    {"food_window_*", "", {}, "items dropped in each 120 s"},
    {"partition_length_window_*",
     "m",
     {},
     "mean of the robots at the end of each 120 s, of the dynamic strategy"},
    {"mean_robots_*", "", {}, "robots in that state, mean over the run"},
};

const std::vector<sim::AnnotationStyle> kPartitioningAnnotations = {
    {"transfer", "", sim::Mark::kTransfer, "transfer"},
    {"disc", "nest", sim::Mark::kNest, ""},
    {"disc", "food", sim::Mark::kFood, ""},
    {"disc", "light", sim::Mark::kGoal, ""},
};

Status CheckLengths(const PartitionLengthSettings& length, const sim::Arena& arena) {
  const sim::Vec2 size = arena.interior_max() - arena.interior_min();
  const double longest = std::max(size.x(), size.y());
  const bool learns = length.rule != PartitionLengthSettings::Rule::kStatic;
  for (const double metres : {length.start, learns ? length.most : length.start}) {
    if (metres <= longest) continue;
    return InvalidInput("partition-length: " + NumberText(metres) + " m is longer than the arena, which is " +
                        NumberText(longest) + " m");
  }
  if (learns && !(length.least <= length.start && length.start <= length.most)) {
    return InvalidInput("partition-length: it starts at " + NumberText(length.start) +
                        " m (start_partition_length), which is not from least_partition_length = " +
                        NumberText(length.least) +
                        " m to most_partition_length = " + NumberText(length.most) + " m");
  }
  return Ok{};
}

ControllerFactory MakePartitioners(const PartitionerSettings& settings) {
  return {
      .create =
          [settings](const ControllerContext& context) {
            return std::make_unique<PartitioningController>(settings, context);
          },
      .traits = {.learns_partition_length = settings.length.rule != PartitionLengthSettings::Rule::kStatic,
                 .handover_reach = settings.handover.keep_reach},
      .check = [settings](const sim::Arena& arena) { return CheckLengths(settings.length, arena); }};
}

// What all three strategies have.
const ParameterTable<PartitionerSettings>& CommonParameters() {
  using S = PartitionerSettings;
  static const ParameterTable<S> table({
      {"speed", "m/s", 0.05, 0.005, 0.3, Into<&S::speed>(), "forward speed (thesis 5.4.1 by 6.4)"},
      {"turn_rate", "rad/s", 0.0, 0.0, 4.0, Fill<S>{[](S& s, double rate) {
         s.steering.turn_rate = rate > 0.0 ? rate : 2.0 * s.speed / sim::foot_bot::kWheelDistance;
       }},
       "on the spot; 0 = 2 * speed / wheel distance, one wheel each way at full speed"},
      {"straight_within", "rad", 5.0 * kDegree, 0.0, kPi / 2.0,
       Into<&S::steering, &SteeringThresholds::straight>(), "a smaller bearing means straight on (dps)"},
      {"hard_turn", "rad", 70.0 * kDegree, 0.2, kPi, Into<&S::steering, &SteeringThresholds::hard>(),
       "a larger bearing means a turn on the spot (dps)"},
      {"wander_turn_probability", "", 0.05, 0.0, 1.0,
       Into<&S::wander, &RandomWalkParameters::turn_probability>(), "chance of a new heading per tick (dps)"},
      {"wander_turn_limit", "rad", 115.0 * kDegree, 0.0, kPi,
       Into<&S::wander, &RandomWalkParameters::turn_limit>(),
       "largest change of heading of the random walk (dps)"},
      {"bounce_distance", "m", 0.05, 0.005, 0.095, Into<&S::bounce_distance>(),
       "wandering turns to a random heading when something in front is nearer (thesis 6.5.3.1; chosen)"},
      {"bounce_front", "rad", 60.0 * kDegree, 0.15, kPi, Into<&S::bounce_front>(),
       "to either side of the heading (chosen)"},
      {"grab_distance", "m", 0.45, 0.1, 10.0, Into<&S::grab_distance>(),
       "drives straight to an item that is nearer (dps)"},
      {"least_handover_distance", "m", 1.1, 0.0, 100.0, Into<&S::least_handover_distance>(),
       "offers no item nearer to the nest than this (dps)"},
      {"wait_time", "s", 180.0, 0.0, 36000.0, IntoTicks<&S::wait>(),
       "offers an item for this long, then carries it home; 0 = never waits (dps: 1800 ticks)"},
      {"transfer_time", "s", 15.0, 0.0, 600.0, IntoTicks<&S::handover, &HandoverSettings::transfer>(),
       "both stand during a hand-over (dps: 150 ticks)"},
      {"transfer_reach", "m", 0.25, 0.18, 1.0, Into<&S::handover, &HandoverSettings::begin_reach>(),
       "a receiver stops this near to a carrier (dps, adapted)"},
      {"transfer_slack", "m", 0.05, 0.0, 1.0,
       Fill<S>{[](S& s, double slack) { s.handover.keep_reach = s.handover.begin_reach + slack; }},
       "pushed farther apart than this, they give up (chosen)"},
      {"transfer_silence", "s", 0.5, 0.0, 60.0, IntoTicks<&S::handover, &HandoverSettings::silence>(),
       "a partner that is unheard for longer is gone (chosen)"},
      {"transfer_answer", "s", 2.0, 0.1, 60.0, IntoTicks<&S::handover, &HandoverSettings::answer>(),
       "a receiver waits this long for an answer (chosen)"},
      {"transfer_bar", "s", 30.0, 0.0, 600.0, IntoTicks<&S::handover, &HandoverSettings::bar>(),
       "after no answer a robot takes no notice of carriers for this long (chosen)"},
      {"arrive_distance", "m", 0.10, 0.01, 1.0, Into<&S::arrive_distance>(),
       "the estimated source position is reached (dps: 0.05)"},
      {"neighbourhood_radius", "m", 0.45, 0.1, 5.0, Into<&S::neighbourhood_radius>(),
       "searched around the estimate (dps)"},
      {"neighbourhood_time", "s", 60.0, 0.0, 3600.0, IntoTicks<&S::neighbourhood>(),
       "searched for this long (dps)"},
      {"odometry_drift", "", 0.0, 0.0, 0.5, Into<&S::odometry_drift>(),
       "scale of the error of one wheel per trip, a share, that displaces the estimated source position; dps "
       "and Pini et al. 2014: 0.0027 (thesis 3.3.2: none)"},
  });
  return table;
}

// Rows that two strategies share.
constexpr Parameter<PartitionerSettings> kPartitionLength = {
    "partition_length",
    "m",
    2.0,
    0.05,
    1000.0,
    Into<&PartitionerSettings::length, &PartitionLengthSettings::start>(),
    "straight-line way towards the nest before a robot offers its item (half of 4 m; thesis 6.2)"};
constexpr Parameter<PartitionerSettings> kNoProgress = {
    "no_progress_time",
    "s",
    30.0,
    1.0,
    3600.0,
    IntoTicks<&PartitionerSettings::no_progress>(),
    "gives the estimate up when it came no nearer to it for this long (dps)"};

}  // namespace

const ParameterTable<PartitioningSettings>& PartitioningParameters() {
  using S = PartitioningSettings;
  static const ParameterTable<S> table({
      {"robots", "", 6, 1, 100, Into<&S::robots>(), "swarm size; a test case may override it (thesis 6.4)"},
      {"time_limit", "s", 800, 1, 36000, IntoTicks<&S::tick_limit>(),
       "items are counted until then (thesis 5.4.1 by 6.4)"},
      {"start_mode", "", 0, 0, 1, Into<&S::start>(),
       "0 = steady state, half the swarm at the centre and half at the source; 1 = all in the nest (thesis "
       "6.4)"},
      {"nest_food_distance", "m", 4.0, 1.5, 20.0, Into<&S::nest_food_distance>(),
       "between the centres of nest and source, on the y axis (thesis 5.4.1)"},
      {"nest_radius", "m", 0.5, 0.2, 2.0, Into<&S::nest_radius>(), "dark floor (as in foraging)"},
      {"food_radius", "m", 0.25, 0.05, 1.0, Fill<S>{[](S& s, double radius) {
         s.food_radius = radius;
         s.pickup_distance = radius + sim::foot_bot::kRadius + kPickupMargin;
       }},
       "the source is no body; robots stop at its edge (chosen)"},
      {"spawn_radius", "m", 0.5, 0.2, 5.0, Into<&S::spawn_radius>(),
       "of the discs where robots start (chosen)"},
      {"clearance", "m", 0.30, 0.0, 1.0, Into<&S::clearance>(),
       "no obstacle nearer than this to the centres of nest and source (chosen)"},
      {"item_visible_range", "m", 0.75, 0.1, 10.0, Into<&S::camera_range>(),
       "half side of the square in which a robot sees the source and waiting carriers (dps)"},
      {"communication_range", "m", 3.0, 0.1, 10.0, Into<&S::communication_range>(),
       "of range-and-bearing (default of ARGoS)"},
      {"light_offset_x", "m", 0.0, -100.0, 100.0,
       Fill<S>{[](S& s, double offset) { s.lamp_offset.x() = offset; }},
       "of the light from the nest's centre (thesis 6.3.1)"},
      {"light_offset_y", "m", 0.0, -100.0, 100.0,
       Fill<S>{[](S& s, double offset) { s.lamp_offset.y() = offset; }},
       "of the light from the nest's centre (thesis 6.3.1)"},
      {"light_height", "m", 1.0, 0.0, 10.0, Into<&S::lamp, &Lamp::height>(),
       "of the light above the floor (dps)"},
      {"light_intensity", "", 3.0, 0.1, 1000.0, Into<&S::lamp, &Lamp::intensity>(),
       "at least; stronger where the arena needs it to be seen everywhere (dps)"},
      {"pickup_time", "s", 2.0, 0.0, 60.0, IntoTicks<&S::pickup>(),
       "a robot stops at the source for this long (chosen)"},
      {"trapped_window", "s", 120.0, 10.0, 3600.0, IntoTicks<&S::trapped_window>(),
       "trapped: kept within trapped_radius for this long at the end, not standing by its own rules "
       "(chosen)"},
      {"trapped_radius", "m", 0.5, 0.05, 5.0, Into<&S::trapped_radius>(),
       "around the robot's mean position (chosen)"},
  });
  return table;
}

const ParameterTable<PartitionerSettings>& StaticPartitionerParameters() {
  static const ParameterTable<PartitionerSettings> table(CommonParameters(), {kNoProgress, kPartitionLength});
  return table;
}

const ParameterTable<PartitionerSettings>& BugPartitionerParameters() {
  using S = PartitionerSettings;
  static const ParameterTable<S> table(
      CommonParameters(),
      {
          {"no_progress_time", "s", 120.0, 1.0, 3600.0, IntoTicks<&S::no_progress>(),
           "gives the estimate up when it came no nearer to it for this long (chosen: detours need it)"},
          {"bug_goal_angle", "rad", 25.0 * kDegree, 0.05, kPi, Into<&S::bug, &BugSettings::goal_angle>(),
           "to either side of the goal's bearing: what is there is in the way (chosen)"},
          {"bug_meet_distance", "m", 0.10, 0.02, 0.10, Into<&S::bug, &BugSettings::meet_distance>(),
           "an obstacle this near in the way is followed (chosen)"},
          {"bug_wall_distance", "m", 0.08, 0.02, 0.20, Into<&S::bug, &BugSettings::wall_distance>(),
           "kept to the obstacle on the right (chosen)"},
          {"bug_wall_gain", "rad/(s m)", 4.0, 0.1, 100.0, Into<&S::bug, &BugSettings::wall_gain>(),
           "of keeping it (chosen)"},
          {"bug_wall_turn", "rad/s", 0.5, 0.05, 4.0, Into<&S::bug, &BugSettings::wall_turn>(),
           "limit of keeping it (chosen)"},
          {"bug_front_distance", "m", 0.06, 0.005, 0.095, Into<&S::bug, &BugSettings::front_distance>(),
           "an obstacle nearer in front is turned away from, left on the spot (chosen)"},
          {"bug_front_angle", "rad", 35.0 * kDegree, 0.05, kPi, Into<&S::bug, &BugSettings::front_angle>(),
           "to either side of the heading (chosen)"},
          {"bug_lost_turn", "rad/s", 0.6, 0.05, 4.0, Into<&S::bug, &BugSettings::lost_turn>(),
           "to the right when the obstacle's end is passed (chosen)"},
          {"bug_clear_time", "s", 0.3, 0.1, 60.0, IntoTicks<&S::bug, &BugSettings::clear_ticks>(),
           "the way must be seen clear for this long (chosen)"},
          kPartitionLength,
      });
  return table;
}

const ParameterTable<PartitionerSettings>& DynamicPartitionerParameters() {
  using S = PartitionerSettings;
  static const ParameterTable<S> table(
      CommonParameters(),
      {
          kNoProgress,
          {"start_partition_length", "m", 0.5, 0.05, 1000.0,
           Into<&S::length, &PartitionLengthSettings::start>(), "of every robot (dps)"},
          {"least_partition_length", "m", 0.5, 0.05, 100.0,
           Into<&S::length, &PartitionLengthSettings::least>(), "never shorter (dps)"},
          {"most_partition_length", "m", 3.5, 0.05, 1000.0,
           Fill<S>{[](S& s, double length) { s.length.most = std::max(s.length.least, length); }},
           "never longer (dps)"},
          {"partition_gain", "", 20.0, 0.0, 1000.0, Into<&S::length, &PartitionLengthSettings::gain>(),
           "G: steps of G * alpha / 10000 m (dps)"},
          {"partition_balance", "%", 50.0, 0.0, 100.0, Into<&S::length, &PartitionLengthSettings::balance>(),
           "alpha: down by this share after a failure, up by the rest after a success (dps)"},
          {"partition_exponential", "bool", 0, 0, 1,
           Fill<S>{[](S& s, double flag) {
                     using Rule = PartitionLengthSettings::Rule;
                     s.length.rule = flag != 0.0 ? Rule::kExponential : Rule::kSigned;
                   },
                   true},
           "DPS-E: steps of G / 100 * exp(-decay * successes in a row) instead"},
          {"partition_decay", "", 0.16, 0.0, 10.0, Into<&S::length, &PartitionLengthSettings::decay>(),
           "of DPS-E (dps)"},
      });
  return table;
}

const ScenarioInfo& PartitioningScenarioInfo() {
  static const ScenarioInfo info = ScenarioRow<PartitioningScenario>(
      PartitioningParameters(),
      {
          .name = "task-partitioning",
          .description = "robots bring items to the nest and hand them over on the way (thesis chapter 6)",
          .default_controller = "task-partitioning",
          .style = {.lost = "trapped", .lost_is_failure = false, .annotations = kPartitioningAnnotations},
          .metrics = kPartitioningMetrics,
          .failures = {.axes = {{"median_x", -1.5, 1.5, 5}, {"median_y", -2.5, 2.5, 5}},
                       .place = {{"median_x", "median_y", 0.6}}},  // chosen: a tenth of the arena
          .failure_types = {.types = PartitioningFailureTypes()},
      });
  return info;
}

std::span<const ControllerInfo> PartitioningControllers() {
  static const std::array rows = {
      ControllerRow("task-partitioning", "task-partitioning",
                    "the static partitioning strategy of thesis 6.2: a potential field towards the light",
                    StaticPartitionerParameters(), MakePartitioners),
      ControllerRow("task-partitioning-improved", "task-partitioning",
                    "the static partitioning strategy with the path planner BugS of thesis 6.5.2.1",
                    BugPartitionerParameters(), MakePartitioners),
      ControllerRow(
          "task-partitioning-dynamic", "task-partitioning",
          "the dynamic partitioning strategy (Buchanan et al. 2016): robots learn how far to carry an item",
          DynamicPartitionerParameters(), MakePartitioners),
  };
  return rows;
}

}  // namespace gauntlet::controllers
