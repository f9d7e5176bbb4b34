#include "controllers/foraging/foraging_scenario.h"

#include <algorithm>
#include <array>
#include <string>
#include <utility>

#include "base/number_text.h"
#include "controllers/common/stillness.h"
#include "sim/arena/spawn.h"

namespace gauntlet::controllers {
namespace {

constexpr sim::Tick kPathSampling = sim::kTicksPerSecond;  // how often a path is looked for (spec 3.6)

FoodSourceSettings SourceSettings(const ForagingSettings& settings) {
  return {FoodOf(settings), settings.pickup_distance, settings.pickup, settings.serving_interval};
}

}  // namespace

std::span<const FailureType> ForagingFailureTypes() {
  static const std::array<FailureType, 3> types = {{{1, "no path"}, {2, "no food"}, {3, "no path, no food"}}};
  return types;
}

ForagingScenario::ForagingScenario(const sim::TestCase& test_case, const ForagingSettings& settings,
                                   const ForagerSettings& forager, std::uint64_t seed)
    : arena_(test_case),
      settings_(settings),
      forager_(forager),
      seed_(seed),
      ends_{NestOf(settings), FoodOf(settings)},
      spawn_disc_(!test_case.spawn_area.has_value()),
      source_(SourceSettings(settings), test_case.robots.value_or(settings.robots)) {
  settings_.robots = test_case.robots.value_or(settings.robots);
  const sim::Vec2 half_side(settings.spawn_radius, settings.spawn_radius);
  spawn_area_ = test_case.spawn_area.value_or(sim::Rectangle{ends_.nest - half_side, ends_.nest + half_side});
  food_light_.position = ends_.food;
  food_light_.height = sim::foot_bot::kBeaconHeight;
  food_light_.color = ForagingController::kFoodColor;
  nest_beacon_.position = ends_.nest;
  nest_beacon_.range = settings.communication_range;
  nest_beacon_.payload = Encode({.sender = RadioMessage::Sender::kNest});
}

bool ForagingScenario::InNest(const sim::Vec2& point) const {
  return (point - ends_.nest).squaredNorm() <= settings_.nest_radius * settings_.nest_radius;
}

double ForagingScenario::FloorGrey(const sim::Vec2& point) const {
  return InNest(point) ? 0.0 : 1.0;
}

Result<std::vector<sim::RobotSetup>> ForagingScenario::CreateSwarm(
    const sim::Headquarters& /*headquarters*/) {
  if (const Status checked = CheckNestAndFood(settings_, "food"); !checked.ok()) return checked.error();
  if (forager_.field && forager_.field->analytic && forager_.field->balance >= forager_.field->reach) {
    return InvalidInput("field-law: field_balance = " + NumberText(forager_.field->balance) +
                        " m must be below field_reach = " + NumberText(forager_.field->reach) + " m");
  }
  sim::SpawnRequest request;
  request.count = settings_.robots;
  request.area = spawn_area_;
  request.disc = spawn_disc_;
  request.robot_radius = sim::foot_bot::kRadius;
  request.start = ends_.nest;
  sim::RandomStream random(seed_, sim::StreamPurpose::kSpawn);
  const sim::OccupancyGrid grid(arena_, sim::OccupancyGrid::kDefaultInflation);
  const auto poses = sim::Spawn(request, grid, random);
  if (!poses.ok()) return poses.error();

  const auto robots = static_cast<std::size_t>(settings_.robots);
  std::vector<sim::RobotSetup> swarm;
  swarm.reserve(robots);
  for (const sim::Pose& pose : *poses) {
    sim::RobotSetup robot;
    robot.pose = pose;
    robot.camera_range = settings_.camera_range;
    robot.radio_range = settings_.communication_range;
    robot.bodies_block_radio = settings_.bodies_block_radio;
    robot.controller = std::make_unique<ForagingController>(forager_);
    swarm.push_back(std::move(robot));
  }

  states_.Begin(settings_.robots, settings_.tick_limit, static_cast<std::uint8_t>(ForagingState::kWandering));
  last_at_rest_.assign(robots, -1);
  carrying_.assign(robots, 0);
  food_.Begin(settings_.tick_limit);
  return swarm;
}

void ForagingScenario::Interact(const sim::Interaction& interaction) {
  const sim::Tick tick = interaction.observer.last_tick();
  DropItems(interaction);
  if (source_.Serve(tick, interaction.observer.Latest(), interaction.grippers)) food_.Take();
  RecordStates(interaction);
  if (first_path_ < 0 && tick % kPathSampling == 0) FindFirstPath(interaction.observer);
}

// An opened gripper loses its item: into the nest's store there, for good elsewhere.
void ForagingScenario::DropItems(const sim::Interaction& interaction) {
  const sim::Tick tick = interaction.observer.last_tick();
  const auto robots = interaction.observer.Latest();
  for (std::size_t i = 0; i < robots.size(); ++i) {
    const auto robot = static_cast<sim::RobotIndex>(i);
    if (!interaction.grippers.Holds(robot) || interaction.grippers.Closed(robot)) continue;
    interaction.grippers.Take(robot);
    food_.Drop(tick, InNest(robots[i].position()));
  }
}

// Robots say over the radio what they are doing; one that has said nothing yet wanders.
void ForagingScenario::RecordStates(const sim::Interaction& interaction) {
  const sim::Tick tick = interaction.observer.last_tick();
  for (std::size_t i = 0; i < interaction.signals.size(); ++i) {
    const auto robot = static_cast<sim::RobotIndex>(i);
    const ForagingState state = StateIn(interaction.signals[i].message);
    states_.Add(static_cast<std::uint8_t>(state));
    if (state == ForagingState::kBeacon || source_.Waits(robot)) last_at_rest_[i] = tick;
    carrying_[i] = interaction.grippers.Holds(robot) ? 1 : 0;
  }
}

ForagingState ForagingScenario::StateOf(sim::RobotIndex robot, sim::Tick tick) const {
  return static_cast<ForagingState>(states_.At(robot, tick));
}

std::vector<sim::Vec2> ForagingScenario::BeaconsAt(const sim::Observer& observer, sim::Tick tick) const {
  std::vector<sim::Vec2> beacons;
  for (sim::RobotIndex robot = 0; robot < settings_.robots; ++robot) {
    if (StateOf(robot, tick) != ForagingState::kBeacon) continue;
    beacons.push_back(observer.At(tick)[static_cast<std::size_t>(robot)].position());
  }
  return beacons;
}

void ForagingScenario::FindFirstPath(const sim::Observer& observer) {
  const sim::Tick tick = observer.last_tick();
  first_chain_ = FindBeaconChain(arena_, ends_, BeaconsAt(observer, tick), settings_.communication_range,
                                 observer.ObstaclesAt(tick));
  if (!first_chain_.empty()) first_path_ = tick;
}

bool ForagingScenario::Finished(const sim::Observer& observer) {
  return observer.last_tick() >= settings_.tick_limit;
}

bool ForagingScenario::Trapped(const sim::Observer& observer, sim::RobotIndex robot) const {
  const sim::Tick first = observer.last_tick() - settings_.trapped_window;
  if (first < 0 || last_at_rest_[static_cast<std::size_t>(robot)] >= first) return false;
  return KeptWithin(observer, robot, settings_.trapped_window, settings_.trapped_radius);
}

sim::Outcome ForagingScenario::Evaluate(const sim::Observer& observer) {
  sim::Outcome outcome;
  outcome.fitness = food_.dropped();
  for (sim::RobotIndex robot = 0; robot < settings_.robots; ++robot) {
    outcome.lost.push_back(Trapped(observer, robot));
  }
  const auto trapped = static_cast<int>(std::count(outcome.lost.begin(), outcome.lost.end(), true));
  const bool no_path = forager_.beacons && first_path_ < 0;
  const bool no_food = food_.dropped() == 0;
  outcome.failure.total = no_path || no_food;
  if (outcome.failure.total) {
    outcome.failure.type = (no_path ? 1 : 0) + (no_food ? 2 : 0);
    outcome.failure.label = ForagingFailureTypes()[static_cast<std::size_t>(outcome.failure.type) - 1].name;
  }
  outcome.metrics = Metrics(trapped);
  outcome.annotations = Annotate(observer, outcome.lost);
  return outcome;
}

std::vector<std::pair<std::string, double>> ForagingScenario::Metrics(int trapped) const {
  const auto carried = static_cast<int>(std::count(carrying_.begin(), carrying_.end(), 1));
  std::vector<std::pair<std::string, double>> metrics = food_.Metrics(carried);
  metrics.insert(metrics.end(),
                 {{"first_path_time", first_path_ < 0 ? -1.0 : first_path_ * sim::kTickSeconds},
                  {"condition_1", forager_.beacons && first_path_ < 0 ? 1.0 : 0.0},
                  {"condition_2", food_.dropped() == 0 ? 1.0 : 0.0},
                  {"trapped_robots", trapped}});
  food_.AddWindows(metrics);
  const std::vector<double> means = states_.MeanRobots(kForagingStates);
  for (int state = 0; state < kForagingStates; ++state) {
    metrics.emplace_back("mean_robots_" + std::string(NameOf(static_cast<ForagingState>(state))),
                         means[static_cast<std::size_t>(state)]);
  }
  return metrics;
}

std::vector<sim::Annotation> ForagingScenario::Annotate(const sim::Observer& observer,
                                                        const std::vector<bool>& trapped) const {
  const sim::Tick last = observer.last_tick();
  std::vector<sim::Annotation> annotations = {
      {"disc", "nest", {ends_.nest}, settings_.nest_radius, -1, {}},
      {"disc", "food", {ends_.food}, settings_.food_radius, -1, {}},
  };
  if (!first_chain_.empty()) {
    annotations.push_back({"chain", "first path of beacons", first_chain_, 0.0, first_path_, {}});
  }
  for (sim::RobotIndex robot = 0; robot < settings_.robots; ++robot) {
    const auto index = static_cast<std::size_t>(robot);
    if (StateOf(robot, last) == ForagingState::kBeacon) {
      annotations.push_back({"beacon", "beacon", {observer.Latest()[index].position()}, 0.0, last, {robot}});
    }
    if (trapped[index]) {
      const std::string label = carrying_[index] != 0 ? "trapped with an item" : "trapped";
      annotations.push_back({"trapped", label, {}, 0.0, last - settings_.trapped_window, {robot}});
    }
  }
  std::string names;
  for (int state = 0; state < kForagingStates; ++state) {
    names.append(state == 0 ? "" : ",").append(NameOf(static_cast<ForagingState>(state)));
  }
  for (sim::RobotIndex robot = 0; robot < settings_.robots; ++robot) {
    annotations.push_back(states_.Line(robot, names, static_cast<std::uint8_t>(ForagingState::kDropping)));
  }
  return annotations;
}

}  // namespace gauntlet::controllers
