#include "controllers/partitioning/partitioning_scenario.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <string>
#include <utility>

#include "base/number_text.h"
#include "controllers/common/stillness.h"

namespace gauntlet::controllers {
namespace {

constexpr double kLampReach = 2.5;  // m per unit of intensity (ARGoS light sensor)

// A lamp that every place of the arena sees: A-19, the light is always detectable.
double IntensityFor(const sim::Arena& arena, const sim::Vec2& lamp, double height, double least) {
  double farthest = 0.0;
  for (const double x : {arena.interior_min().x(), arena.interior_max().x()}) {
    for (const double y : {arena.interior_min().y(), arena.interior_max().y()}) {
      farthest = std::max(farthest, (sim::Vec2(x, y) - lamp).squaredNorm());
    }
  }
  return std::max(least, 1.01 * std::sqrt(farthest + height * height) / kLampReach);
}

}  // namespace

std::span<const FailureType> PartitioningFailureTypes() {
  static const std::array<FailureType, 1> types = {{{1, "no food"}}};
  return types;
}

PartitioningScenario::PartitioningScenario(const sim::TestCase& test_case,
                                           const PartitioningSettings& settings,
                                           const PartitionerSettings& robot, std::uint64_t seed)
    : arena_(test_case),
      settings_(settings),
      robot_(robot),
      seed_(seed),
      nest_(NestOf(settings)),
      food_(FoodOf(settings)),
      spawn_area_(test_case.spawn_area),
      lights_(2),
      source_({food_, settings.pickup_distance, settings.pickup, 0},
              test_case.robots.value_or(settings.robots)) {
  settings_.robots = test_case.robots.value_or(settings.robots);
  sim::Light& lamp = lights_[0];
  lamp.position = nest_ + settings.lamp_offset;
  lamp.height = settings.lamp_height;
  lamp.intensity = IntensityFor(arena_, lamp.position, lamp.height, settings.lamp_intensity);
  lamp.occludable = false;
  robot_.lamp = {lamp.height, lamp.intensity};
  sim::Light& source = lights_[1];
  source.position = food_;
  source.height = sim::foot_bot::kBeaconHeight;
  source.color = PartitioningController::kSourceColor;
}

bool PartitioningScenario::InNest(const sim::Vec2& point) const {
  return (point - nest_).squaredNorm() <= settings_.nest_radius * settings_.nest_radius;
}

double PartitioningScenario::FloorGrey(const sim::Vec2& point) const {
  return InNest(point) ? 0.0 : 1.0;
}

Status PartitioningScenario::CheckSettings() const {
  if (Status checked = CheckNestAndFood(settings_, "source"); !checked.ok()) return checked;
  const sim::Vec2& lamp = lights_[0].position;
  if (!arena_.InInterior(lamp)) {
    return InvalidInput("light-outside: the light is at " + PointText(lamp.x(), lamp.y()) +
                        " m, outside the walls; it belongs above the nest");
  }
  const sim::Vec2 size = arena_.interior_max() - arena_.interior_min();
  const double longest = std::max(size.x(), size.y());
  const PartitionLengthSettings& length = robot_.length;
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
  if (spawn_area_ && settings_.start == StartMode::kSteadyState) {
    return InvalidInput(
        "start-mode: the test case brings its own spawn area, but robots of the steady state (start_mode = "
        "0) "
        "begin at the centre and at the source; start_mode = 1 takes the area");
  }
  return Ok{};
}

Result<std::vector<sim::Pose>> PartitioningScenario::StartPoses() const {
  const sim::OccupancyGrid grid(arena_, sim::OccupancyGrid::kDefaultInflation);
  sim::RandomStream random(seed_, sim::StreamPurpose::kSpawn);
  const sim::Vec2 half_side(settings_.spawn_radius, settings_.spawn_radius);
  sim::SpawnRequest request;
  request.robot_radius = sim::foot_bot::kRadius;
  request.start = nest_;
  const auto around = [&](const sim::Vec2& center, int count) {
    request.count = count;
    request.disc = true;
    request.area = {center - half_side, center + half_side};
  };
  if (settings_.start == StartMode::kNest) {
    around(nest_, settings_.robots);
    if (spawn_area_) {
      request.disc = false;
      request.area = *spawn_area_;
    }
    return sim::Spawn(request, grid, random);
  }
  std::vector<sim::Pose> poses;
  if (const int at_center = settings_.robots / 2; at_center > 0) {
    around((nest_ + food_) / 2.0, at_center);
    auto spawned = sim::Spawn(request, grid, random);
    if (!spawned.ok()) return spawned.error();
    poses = *std::move(spawned);
  }
  around(food_, settings_.robots - static_cast<int>(poses.size()));
  for (const sim::Pose& pose : poses) request.occupied.push_back(pose.position);
  auto spawned = sim::Spawn(request, grid, random);
  if (!spawned.ok()) return spawned.error();
  poses.insert(poses.end(), spawned->begin(), spawned->end());
  return poses;
}

Result<std::vector<sim::RobotSetup>> PartitioningScenario::CreateSwarm(
    const sim::Headquarters& headquarters) {
  if (const Status checked = CheckSettings(); !checked.ok()) return checked.error();
  const auto poses = StartPoses();
  if (!poses.ok()) return poses.error();

  const PartitioningState state = settings_.start == StartMode::kSteadyState
                                      ? PartitioningState::kNeighbourhood
                                      : PartitioningState::kExplore;
  std::vector<sim::RobotSetup> swarm;
  swarm.reserve(poses->size());
  for (std::size_t i = 0; i < poses->size(); ++i) {
    const auto index = static_cast<sim::RobotIndex>(i);
    sim::RobotSetup robot;
    robot.pose = (*poses)[i];
    robot.camera_range = settings_.camera_range;
    robot.radio_range = settings_.communication_range;
    robot.controller = std::make_unique<PartitioningController>(
        robot_, static_cast<std::uint8_t>(i), state,
        std::make_unique<BodyOdometer>(headquarters, index, robot.pose));
    swarm.push_back(std::move(robot));
  }
  record_.Begin(settings_.robots, state, settings_.tick_limit);
  carrying_.assign(swarm.size(), 0);
  last_served_.assign(swarm.size(), -1);
  return swarm;
}

void PartitioningScenario::Interact(const sim::Interaction& interaction) {
  const sim::Tick tick = interaction.observer.last_tick();
  DropItems(interaction);
  HandItemsOver(interaction);
  if (source_.Serve(tick, interaction.observer.Latest(), interaction.grippers)) record_.food().Take();
  record_.Hear(tick, interaction.signals);
  for (std::size_t i = 0; i < carrying_.size(); ++i) {
    const auto robot = static_cast<sim::RobotIndex>(i);
    carrying_[i] = interaction.grippers.Holds(robot) ? 1 : 0;
    if (source_.Waits(robot)) last_served_[i] = tick;
  }
}

// An opened gripper loses its item: into the nest's store there, for good elsewhere.
void PartitioningScenario::DropItems(const sim::Interaction& interaction) {
  const auto robots = interaction.observer.Latest();
  for (std::size_t i = 0; i < robots.size(); ++i) {
    const auto robot = static_cast<sim::RobotIndex>(i);
    if (!interaction.grippers.Holds(robot) || interaction.grippers.Closed(robot)) continue;
    interaction.grippers.Take(robot);
    record_.food().Drop(interaction.observer.last_tick(), InNest(robots[i].position()));
  }
}

// The one step of a hand-over in which the item moves; see handover.h.
void PartitioningScenario::HandItemsOver(const sim::Interaction& interaction) {
  const auto robots = interaction.observer.Latest();
  for (std::size_t i = 0; i < robots.size(); ++i) {
    if (StepIn(interaction.signals[i].message) != HandoverStep::kRelease) continue;
    const PartitionMessage offer = DecodePartition(interaction.signals[i].message);
    if (!offer.from_robot || offer.partner >= robots.size()) continue;
    const auto giver = static_cast<sim::RobotIndex>(i);
    const auto receiver = static_cast<sim::RobotIndex>(offer.partner);
    if (!MayHandOver(interaction, giver, receiver)) continue;
    interaction.grippers.HandOver(giver, receiver);
    const sim::Vec2 place = (robots[i].position() + robots[offer.partner].position()) / 2.0;
    record_.HandOver({interaction.observer.last_tick(), giver, receiver, place});
  }
}

bool PartitioningScenario::MayHandOver(const sim::Interaction& interaction, sim::RobotIndex giver,
                                       sim::RobotIndex receiver) const {
  const sim::Grippers& grippers = interaction.grippers;
  if (giver == receiver || !grippers.Holds(giver) || grippers.Holds(receiver) || !grippers.Closed(receiver)) {
    return false;
  }
  const PartitionMessage request =
      DecodePartition(interaction.signals[static_cast<std::size_t>(receiver)].message);
  if (request.step != HandoverStep::kRequest || request.partner != static_cast<std::uint8_t>(giver)) {
    return false;
  }
  const auto robots = interaction.observer.Latest();
  const sim::Vec2 from = robots[static_cast<std::size_t>(giver)].position();
  const sim::Vec2 to = robots[static_cast<std::size_t>(receiver)].position();
  const double reach = robot_.handover.keep_reach;
  const auto obstacles = interaction.observer.ObstaclesAt(interaction.observer.last_tick());
  return (from - to).squaredNorm() <= reach * reach && arena_.LineOfSight(from, to, obstacles);
}

bool PartitioningScenario::Finished(const sim::Observer& observer) {
  return observer.last_tick() >= settings_.tick_limit;
}

bool PartitioningScenario::Trapped(const sim::Observer& observer, sim::RobotIndex robot) const {
  const sim::Tick first = observer.last_tick() - settings_.trapped_window;
  if (first < 0) return false;
  if (std::max(record_.last_at_rest(robot), last_served_[static_cast<std::size_t>(robot)]) >= first) {
    return false;
  }
  return KeptWithin(observer, robot, settings_.trapped_window, settings_.trapped_radius);
}

sim::Outcome PartitioningScenario::Evaluate(const sim::Observer& observer) {
  sim::Outcome outcome;
  outcome.fitness = record_.food().dropped();
  for (sim::RobotIndex robot = 0; robot < settings_.robots; ++robot) {
    outcome.lost.push_back(Trapped(observer, robot));
  }
  outcome.failure.total = record_.food().dropped() == 0;
  if (outcome.failure.total) {
    const FailureType& no_food = PartitioningFailureTypes().front();
    outcome.failure.type = no_food.type;
    outcome.failure.label = no_food.name;
  }
  const auto trapped = static_cast<int>(std::count(outcome.lost.begin(), outcome.lost.end(), true));
  const auto carried = static_cast<int>(std::count(carrying_.begin(), carrying_.end(), 1));
  outcome.metrics =
      record_.Metrics(carried, trapped, robot_.length.rule != PartitionLengthSettings::Rule::kStatic);
  outcome.annotations = Annotate(observer, outcome.lost);
  return outcome;
}

std::vector<sim::Annotation> PartitioningScenario::Annotate(const sim::Observer& observer,
                                                            const std::vector<bool>& trapped) const {
  std::vector<sim::Annotation> annotations = {
      {"disc", "nest", {nest_}, settings_.nest_radius, -1, {}},
      {"disc", "food", {food_}, settings_.food_radius, -1, {}},
  };
  if (settings_.lamp_offset != sim::Vec2::Zero()) {
    annotations.push_back({"disc", "light", {lights_[0].position}, 0.0, -1, {}});
  }
  for (const PartitioningRecord::Transfer& transfer : record_.transfers()) {
    annotations.push_back(
        {"transfer", "transfer", {transfer.place}, 0.0, transfer.tick, {transfer.giver, transfer.receiver}});
  }
  std::string names;
  for (int state = 0; state < kPartitioningStates; ++state) {
    names.append(state == 0 ? "" : ",").append(NameOf(static_cast<PartitioningState>(state)));
  }
  for (sim::RobotIndex robot = 0; robot < settings_.robots; ++robot) {
    const auto index = static_cast<std::size_t>(robot);
    if (trapped[index]) {
      const std::string label = carrying_[index] != 0 ? "trapped with an item" : "trapped";
      const sim::Tick since = StillSince(observer, robot, settings_.trapped_window, settings_.trapped_radius);
      annotations.push_back({"trapped", label, {}, 0.0, since, {robot}});
    }
    annotations.push_back(record_.states().Line(robot, names, std::nullopt));
  }
  return annotations;
}

}  // namespace gauntlet::controllers
