#include "controllers/partitioning/partitioning_registry.h"

#include <algorithm>
#include <memory>

#include "controllers/common/parameters.h"
#include "sim/geometry/trigonometry.h"

namespace gauntlet::controllers {
namespace {

using sim::kDegree;
using sim::kPi;

constexpr std::string_view kStatic = "task-partitioning";
constexpr std::string_view kImproved = "task-partitioning-improved";
constexpr std::string_view kDynamic = "task-partitioning-dynamic";

constexpr std::array kScenarioParameters = std::to_array<ParameterInfo>({
    {"robots", "", 6, 1, 100, true, "swarm size; a test case may override it (thesis 6.4)"},
    {"time_limit", "s", 800, 1, 36000, false, "items are counted until then (thesis 5.4.1 by 6.4)"},
    {"start_mode", "", 0, 0, 1, true,
     "0 = steady state, half the swarm at the centre and half at the source; 1 = all in the nest (thesis "
     "6.4)"},
    {"nest_food_distance", "m", 4.0, 1.5, 20.0, false,
     "between the centres of nest and source, on the y axis (thesis 5.4.1)"},
    {"nest_radius", "m", 0.5, 0.2, 2.0, false, "dark floor (as in foraging)"},
    {"food_radius", "m", 0.25, 0.05, 1.0, false, "the source is no body; robots stop at its edge (chosen)"},
    {"spawn_radius", "m", 0.5, 0.2, 5.0, false, "of the discs where robots start (chosen)"},
    {"clearance", "m", 0.30, 0.0, 1.0, false,
     "no obstacle nearer than this to the centres of nest and source (chosen)"},
    {"item_visible_range", "m", 0.75, 0.1, 10.0, false,
     "half side of the square in which a robot sees the source and waiting carriers (dps)"},
    {"communication_range", "m", 3.0, 0.1, 10.0, false, "of range-and-bearing (default of ARGoS)"},
    {"light_offset_x", "m", 0.0, -100.0, 100.0, false, "of the light from the nest's centre (thesis 6.3.1)"},
    {"light_offset_y", "m", 0.0, -100.0, 100.0, false, "of the light from the nest's centre (thesis 6.3.1)"},
    {"light_height", "m", 1.0, 0.0, 10.0, false, "of the light above the floor (dps)"},
    {"light_intensity", "", 3.0, 0.1, 1000.0, false,
     "at least; stronger where the arena needs it to be seen everywhere (dps)"},
    {"pickup_time", "s", 2.0, 0.0, 60.0, false, "a robot stops at the source for this long (chosen)"},
    {"trapped_window", "s", 120.0, 10.0, 3600.0, false,
     "trapped: kept within trapped_radius for this long at the end, not standing by its own rules (chosen)"},
    {"trapped_radius", "m", 0.5, 0.05, 5.0, false, "around the robot's mean position (chosen)"},
});

constexpr std::array kMetrics = std::to_array<MetricInfo>({
    {"food_taken", "", false, "items taken from the source"},
    {"food_carried", "", false, "items in the robots' hands at the end"},
    {"food_lost", "", false, "items that a robot lost on its way"},
    {"first_item_time", "s", true, "when the first item was dropped in the nest"},
    {"transfers", "", false, "items handed over from robot to robot", true},
    {"broken_transfers", "", false, "hand-overs that were begun and not finished"},
    {"waits", "", false, "how often a robot stopped to offer an item"},
    {"wait_timeouts", "", false, "how often it carried on because nobody came"},
    {"mean_waiting_time", "s", true, "from stopping to the beginning of a hand-over or carrying on"},
    {"transfer_time", "s", false, "spent in hand-overs, sum over the givers"},
    {"trapped_robots", "", false, "robots that stayed within a small place for the last 120 s", true},
    {"partition_length", "m", false, "mean of the robots at the end"},
    {"food_window_*", "", false, "items dropped in each 120 s"},
    {"partition_length_window_*", "m", false,
     "mean of the robots at the end of each 120 s, of the dynamic strategy"},
    {"mean_robots_*", "", false, "robots in that state, mean over the run"},
});

constexpr std::array kRobotParameters = std::to_array<ParameterInfo>({
    {"speed", "m/s", 0.05, 0.005, 0.3, false, "forward speed (thesis 5.4.1 by 6.4)"},
    {"turn_rate", "rad/s", 0.0, 0.0, 4.0, false,
     "on the spot; 0 = 2 * speed / wheel distance, one wheel each way at full speed"},
    {"straight_within", "rad", 5.0 * kDegree, 0.0, kPi / 2.0, false,
     "a smaller bearing means straight on (dps)"},
    {"hard_turn", "rad", 70.0 * kDegree, 0.2, kPi, false, "a larger bearing means a turn on the spot (dps)"},
    {"wander_turn_probability", "", 0.05, 0.0, 1.0, false, "chance of a new heading per tick (dps)"},
    {"wander_turn_limit", "rad", 115.0 * kDegree, 0.0, kPi, false,
     "largest change of heading of the random walk (dps)"},
    {"bounce_distance", "m", 0.05, 0.005, 0.095, false,
     "wandering turns to a random heading when something in front is nearer (thesis 6.5.3.1; chosen)"},
    {"bounce_front", "rad", 60.0 * kDegree, 0.15, kPi, false, "to either side of the heading (chosen)"},
    {"grab_distance", "m", 0.45, 0.1, 10.0, false, "drives straight to an item that is nearer (dps)"},
    {"least_handover_distance", "m", 1.1, 0.0, 100.0, false,
     "offers no item nearer to the nest than this (dps)"},
    {"wait_time", "s", 180.0, 0.0, 36000.0, false,
     "offers an item for this long, then carries it home; 0 = never waits (dps: 1800 ticks)"},
    {"transfer_time", "s", 15.0, 0.0, 600.0, false, "both stand during a hand-over (dps: 150 ticks)"},
    {"transfer_reach", "m", 0.25, 0.18, 1.0, false, "a receiver stops this near to a carrier (dps, adapted)"},
    {"transfer_slack", "m", 0.05, 0.0, 1.0, false, "pushed farther apart than this, they give up (chosen)"},
    {"transfer_silence", "s", 0.5, 0.0, 60.0, false, "a partner that is unheard for longer is gone (chosen)"},
    {"transfer_answer", "s", 2.0, 0.1, 60.0, false, "a receiver waits this long for an answer (chosen)"},
    {"transfer_bar", "s", 30.0, 0.0, 600.0, false,
     "after no answer a robot takes no notice of carriers for this long (chosen)"},
    {"arrive_distance", "m", 0.10, 0.01, 1.0, false, "the estimated source position is reached (dps: 0.05)"},
    {"neighbourhood_radius", "m", 0.45, 0.1, 5.0, false, "searched around the estimate (dps)"},
    {"neighbourhood_time", "s", 60.0, 0.0, 3600.0, false, "searched for this long (dps)"},
    {"odometry_drift", "", 0.0, 0.0, 0.5, false,
     "scale of the error of one wheel per trip, a share, that displaces the estimated source position; dps "
     "and Pini et al. 2014: 0.0027 (thesis 3.3.2: none)"},
});

constexpr std::array kStaticParameters = std::to_array<ParameterInfo>({
    {"partition_length", "m", 2.0, 0.05, 1000.0, false,
     "straight-line way towards the nest before a robot offers its item (half of 4 m; thesis 6.2)"},
});

constexpr std::array kFieldPlanParameters = std::to_array<ParameterInfo>({
    {"no_progress_time", "s", 30.0, 1.0, 3600.0, false,
     "gives the estimate up when it came no nearer to it for this long (dps)"},
});

constexpr std::array kBugPlanParameters = std::to_array<ParameterInfo>({
    {"no_progress_time", "s", 120.0, 1.0, 3600.0, false,
     "gives the estimate up when it came no nearer to it for this long (chosen: detours need it)"},
    {"bug_goal_angle", "rad", 25.0 * kDegree, 0.05, kPi, false,
     "to either side of the goal's bearing: what is there is in the way (chosen)"},
    {"bug_meet_distance", "m", 0.10, 0.02, 0.10, false,
     "an obstacle this near in the way is followed (chosen)"},
    {"bug_wall_distance", "m", 0.08, 0.02, 0.20, false, "kept to the obstacle on the right (chosen)"},
    {"bug_wall_gain", "rad/(s m)", 4.0, 0.1, 100.0, false, "of keeping it (chosen)"},
    {"bug_wall_turn", "rad/s", 0.5, 0.05, 4.0, false, "limit of keeping it (chosen)"},
    {"bug_front_distance", "m", 0.06, 0.005, 0.095, false,
     "an obstacle nearer in front is turned away from, left on the spot (chosen)"},
    {"bug_front_angle", "rad", 35.0 * kDegree, 0.05, kPi, false, "to either side of the heading (chosen)"},
    {"bug_lost_turn", "rad/s", 0.6, 0.05, 4.0, false,
     "to the right when the obstacle's end is passed (chosen)"},
    {"bug_clear_time", "s", 0.3, 0.1, 60.0, false, "the way must be seen clear for this long (chosen)"},
});

constexpr std::array kDynamicParameters = std::to_array<ParameterInfo>({
    {"start_partition_length", "m", 0.5, 0.05, 1000.0, false, "of every robot (dps)"},
    {"least_partition_length", "m", 0.5, 0.05, 100.0, false, "never shorter (dps)"},
    {"most_partition_length", "m", 3.5, 0.05, 1000.0, false, "never longer (dps)"},
    {"partition_gain", "", 20.0, 0.0, 1000.0, false, "G: steps of G * alpha / 10000 m (dps)"},
    {"partition_balance", "%", 50.0, 0.0, 100.0, false,
     "alpha: down by this share after a failure, up by the rest after a success (dps)"},
    {"partition_exponential", "bool", 0, 0, 1, true,
     "DPS-E: steps of G / 100 * exp(-decay * successes in a row) instead"},
    {"partition_decay", "", 0.16, 0.0, 10.0, false, "of DPS-E (dps)"},
});

constexpr auto kStaticAll = Joined(Joined(kRobotParameters, kFieldPlanParameters), kStaticParameters);
constexpr auto kImprovedAll = Joined(Joined(kRobotParameters, kBugPlanParameters), kStaticParameters);
constexpr auto kDynamicAll = Joined(Joined(kRobotParameters, kFieldPlanParameters), kDynamicParameters);

constexpr double kScannerShortRange = 0.26;  // m beyond the body (ARGoS)
constexpr double kWallSpeed = 0.9;           // share of the speed along an obstacle (spec 4.4)
constexpr double kLostSpeed = 0.6;           // share of the speed round its end (spec 4.4)

sim::ArenaRequirements Requirements(const sim::Parameters& parameters, const sim::TestCase& /*test_case*/) {
  return RequirementsOf(PartitioningSettingsFrom(parameters), parameters);
}

std::unique_ptr<sim::Scenario> Create(const sim::RunSpec& spec) {
  const PartitioningSettings settings = PartitioningSettingsFrom(spec.scenario_parameters);
  return std::make_unique<PartitioningScenario>(
      spec.test_case, settings,
      PartitionerSettingsFrom(spec.controller, spec.controller_parameters, settings), spec.seed);
}

BugSettings BugSettingsFrom(const sim::Parameters& parameters, double speed, double turn_rate) {
  const auto get = [&](const char* name) { return GetParameter(parameters, name); };
  BugSettings bug;
  bug.speed = speed;
  bug.goal_angle = get("bug_goal_angle");
  bug.meet_distance = get("bug_meet_distance");
  bug.wall_distance = get("bug_wall_distance");
  bug.wall_gain = get("bug_wall_gain");
  bug.wall_turn = get("bug_wall_turn");
  bug.wall_speed = kWallSpeed * speed;
  bug.front_angle = get("bug_front_angle");
  bug.front_distance = get("bug_front_distance");
  bug.turn_rate = turn_rate;
  bug.lost_speed = kLostSpeed * speed;
  bug.lost_turn = get("bug_lost_turn");
  bug.scanner_range = kScannerShortRange;
  bug.clear_ticks = std::max(1, ToTicks(get("bug_clear_time")));
  return bug;
}

PartitionLengthSettings LengthSettingsFrom(std::string_view controller, const sim::Parameters& parameters) {
  const auto get = [&](const char* name) { return GetParameter(parameters, name); };
  PartitionLengthSettings length;
  if (controller != kDynamic) {
    length.start = get("partition_length");
    return length;
  }
  length.rule = get("partition_exponential") != 0.0 ? PartitionLengthSettings::Rule::kExponential
                                                    : PartitionLengthSettings::Rule::kSigned;
  length.start = get("start_partition_length");
  length.least = get("least_partition_length");
  length.most = std::max(get("least_partition_length"), get("most_partition_length"));
  length.gain = get("partition_gain");
  length.balance = get("partition_balance");
  length.decay = get("partition_decay");
  return length;
}

}  // namespace

PartitioningSettings PartitioningSettingsFrom(const sim::Parameters& parameters) {
  const auto get = [&](const char* name) { return GetParameter(parameters, name); };
  PartitioningSettings settings;
  ReadNestAndFood(parameters, settings);
  settings.start = get("start_mode") != 0.0 ? StartMode::kNest : StartMode::kSteadyState;
  settings.camera_range = get("item_visible_range");
  settings.lamp_offset = {get("light_offset_x"), get("light_offset_y")};
  settings.lamp_height = get("light_height");
  settings.lamp_intensity = get("light_intensity");
  settings.pickup_distance = settings.food_radius + sim::foot_bot::kRadius + 0.025;  // 0.36 m, spec 4.2
  return settings;
}

PartitionerSettings PartitionerSettingsFrom(std::string_view controller, const sim::Parameters& parameters,
                                            const PartitioningSettings& scenario) {
  const auto get = [&](const char* name) { return GetParameter(parameters, name); };
  PartitionerSettings settings;
  settings.speed = get("speed");
  const double turn_rate =
      get("turn_rate") > 0.0 ? get("turn_rate") : 2.0 * settings.speed / sim::foot_bot::kWheelDistance;
  settings.steering = {get("straight_within"), get("hard_turn"), turn_rate};
  settings.wander = {get("wander_turn_probability"), get("wander_turn_limit")};
  settings.bounce_distance = get("bounce_distance");
  settings.bounce_front = get("bounce_front");
  settings.pickup_distance = scenario.pickup_distance;
  settings.grab_distance = get("grab_distance");
  settings.length = LengthSettingsFrom(controller, parameters);
  settings.least_handover_distance = get("least_handover_distance");
  settings.wait = ToTicks(get("wait_time"));
  settings.handover.begin_reach = get("transfer_reach");
  settings.handover.keep_reach = get("transfer_reach") + get("transfer_slack");
  settings.handover.transfer = ToTicks(get("transfer_time"));
  settings.handover.silence = ToTicks(get("transfer_silence"));
  settings.handover.answer = ToTicks(get("transfer_answer"));
  settings.handover.bar = ToTicks(get("transfer_bar"));
  settings.arrive_distance = get("arrive_distance");
  settings.neighbourhood_radius = get("neighbourhood_radius");
  settings.neighbourhood = ToTicks(get("neighbourhood_time"));
  settings.no_progress = ToTicks(get("no_progress_time"));
  settings.odometry_drift = get("odometry_drift");
  if (controller == kImproved) settings.bug = BugSettingsFrom(parameters, settings.speed, turn_rate);
  return settings;
}

const ScenarioInfo& PartitioningScenarioInfo() {
  static const ScenarioInfo info = {
      .name = "task-partitioning",
      .description = "robots bring items to the nest and hand them over on the way (thesis chapter 6)",
      .default_controller = "task-partitioning",
      .words = {.lost = "trapped", .lost_is_failure = false},
      .parameters = kScenarioParameters,
      .time_limit = "time_limit",
      .metrics = kMetrics,
      .failure_types = PartitioningFailureTypes(),
      .requirements = Requirements,
      .create = Create,
  };
  return info;
}

const std::array<ControllerInfo, 3>& PartitioningControllerInfos() {
  static const std::array<ControllerInfo, 3> infos = {{
      {kStatic, "task-partitioning",
       "the static partitioning strategy of thesis 6.2: a potential field towards the light", kStaticAll},
      {kImproved, "task-partitioning",
       "the static partitioning strategy with the path planner BugS of thesis 6.5.2.1", kImprovedAll},
      {kDynamic, "task-partitioning",
       "the dynamic partitioning strategy (Buchanan et al. 2016): robots learn how far to carry an item",
       kDynamicAll},
  }};
  return infos;
}

}  // namespace gauntlet::controllers
