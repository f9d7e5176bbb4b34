#include "controllers/partitioning/partitioning_scenario.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "base/number_text.h"
#include "sim/arena/spawn.h"

namespace gauntlet::controllers {
namespace {

constexpr double kLampReach = 2.5;  // m per unit of intensity (ARGoS light sensor)

// A lamp that every place of the arena sees: in thesis 6.2.1 it is always in range.
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

const std::vector<FailureType>& PartitioningFailureTypes() {
  static const std::vector<FailureType> types = {{1, "no food"}};
  return types;
}

PartitioningScenario::PartitioningScenario(const sim::TestCase& test_case,
                                           const PartitioningSettings& settings, ControllerFactory controller,
                                           std::uint64_t seed)
    : NestAndFoodScenario(test_case, settings, std::move(controller), kPartitioningStateNames),
      start_(settings.start),
      seed_(seed),
      spawn_area_(test_case.spawn_area),
      lights_{
          sim::Light{
              .position = nest_ + settings.lamp_offset, .height = settings.lamp.height, .occludable = false},
          sim::Light{.position = food_, .height = sim::foot_bot::kBeaconHeight, .color = kSourceColor}} {
  lights_[0].intensity =
      IntensityFor(arena_, lights_[0].position, settings.lamp.height, settings.lamp.intensity);
}

Status PartitioningScenario::CheckSettings() const {
  TRY(CheckSite("source"));
  const sim::Vec2& lamp = lights_[0].position;
  if (!arena_.InInterior(lamp)) {
    return InvalidInput("light-outside: the light is at " + PointText(lamp.x(), lamp.y()) +
                        " m, outside the walls; it belongs above the nest");
  }
  TRY(controller_.Check(arena_));
  if (spawn_area_ && start_ == StartMode::kSteadyState) {
    return InvalidInput(
        "start-mode: the test case brings its own spawn area, but robots of the steady state (start_mode = "
        "0) begin at the centre and at the source; start_mode = 1 takes the area");
  }
  return Ok{};
}

Result<std::vector<sim::Pose>> PartitioningScenario::StartPoses() const {
  if (!start_poses_.empty()) return start_poses_;
  const sim::OccupancyGrid grid(arena_, sim::OccupancyGrid::kDefaultInflation);
  sim::RandomStream random(seed_, sim::StreamPurpose::kSpawn);
  const sim::Vec2 half_side(site_.spawn_radius, site_.spawn_radius);
  sim::SpawnRequest request;
  request.robot_radius = sim::foot_bot::kRadius;
  request.start = nest_;
  const auto around = [&](const sim::Vec2& center, int count) {
    request.count = count;
    request.disc = true;
    request.area = {center - half_side, center + half_side};
  };
  if (start_ == StartMode::kNest) {
    around(nest_, site_.robots);
    if (spawn_area_) {
      request.disc = false;
      request.area = *spawn_area_;
    }
    return sim::Spawn(request, grid, random);
  }
  std::vector<sim::Pose> poses;
  if (const int at_center = site_.robots / 2; at_center > 0) {
    around((nest_ + food_) / 2.0, at_center);
    TRY(poses, sim::Spawn(request, grid, random));
  }
  around(food_, site_.robots - static_cast<int>(poses.size()));
  for (const sim::Pose& pose : poses) request.occupied.push_back(pose.position);
  TRY(auto spawned, sim::Spawn(request, grid, random));
  poses.insert(poses.end(), spawned.begin(), spawned.end());
  return poses;
}

Result<std::vector<sim::RobotSetup>> PartitioningScenario::CreateSwarm(
    const sim::Headquarters& headquarters) {
  TRY(CheckSettings());
  TRY(const auto poses, StartPoses());

  const bool in_relay = start_ == StartMode::kSteadyState;
  std::vector<sim::RobotSetup> swarm;
  swarm.reserve(poses.size());
  for (const sim::Pose& pose : poses) {
    const auto robot = static_cast<sim::RobotIndex>(swarm.size());
    swarm.push_back(SetUp(pose, {.robot = robot,
                                 .nest_lamp = {lights_[0].height, lights_[0].intensity},
                                 .starts_in_relay = in_relay,
                                 .odometer = OdometerOf(headquarters, robot, pose)}));
  }
  const PartitioningState state = in_relay ? PartitioningState::kNeighbourhood : PartitioningState::kExplore;
  record_.Begin(site_.robots, state, site_.tick_limit);
  Begin(static_cast<std::uint8_t>(state));
  return swarm;
}

void PartitioningScenario::Interact(const sim::Interaction& interaction) {
  DropItems(interaction);
  HandItemsOver(interaction);
  ServeItems(interaction);
  record_.Hear(interaction.observer.last_tick(), interaction.signals);
  for (std::size_t i = 0; i < interaction.signals.size(); ++i) {
    Record(interaction, static_cast<sim::RobotIndex>(i), static_cast<std::uint8_t>(record_.state(i)),
           record_.at_rest(i));
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
  const double reach = controller_.traits.handover_reach;
  const auto obstacles = interaction.observer.ObstaclesAt(interaction.observer.last_tick());
  return (from - to).squaredNorm() <= reach * reach && arena_.LineOfSight(from, to, obstacles);
}

sim::Outcome PartitioningScenario::Evaluate(const sim::Observer& observer) {
  sim::Outcome outcome = Judge(observer);
  if (outcome.failure.total) {
    const FailureType& no_food = PartitioningFailureTypes().front();
    outcome.failure.type = no_food.type;
    outcome.failure.label = no_food.name;
  }
  const auto trapped = static_cast<int>(std::count(outcome.lost.begin(), outcome.lost.end(), true));
  outcome.metrics = ItemMetrics();
  record_.AddMetrics(trapped, outcome.metrics);
  AddWhereabouts(observer, outcome.metrics);
  items_.AddWindows(outcome.metrics);
  if (controller_.traits.learns_partition_length) record_.AddWindows(outcome.metrics);
  states_.AddMeans(outcome.metrics);
  outcome.annotations = Annotate(observer, outcome.lost);
  return outcome;
}

std::vector<sim::Annotation> PartitioningScenario::Annotate(const sim::Observer& observer,
                                                            const std::vector<bool>& trapped) const {
  std::vector<sim::Annotation> annotations = Places();
  if (lights_[0].position != nest_) {
    annotations.push_back({"disc", "light", {lights_[0].position}, 0.0, -1, {}});
  }
  for (const PartitioningRecord::Transfer& transfer : record_.transfers()) {
    annotations.push_back(
        {"transfer", "transfer", {transfer.place}, 0.0, transfer.tick, {transfer.giver, transfer.receiver}});
  }
  for (sim::RobotIndex robot = 0; robot < site_.robots; ++robot) {
    if (trapped[static_cast<std::size_t>(robot)]) {
      annotations.push_back(
          TrappedMark(robot, StillSince(observer, robot, site_.trapped_window, site_.trapped_radius)));
    }
    annotations.push_back(states_.Line(robot, std::nullopt));
  }
  return annotations;
}

}  // namespace gauntlet::controllers
