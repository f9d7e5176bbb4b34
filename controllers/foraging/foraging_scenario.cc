#include "controllers/foraging/foraging_scenario.h"

#include <algorithm>
#include <array>
#include <utility>

#include "controllers/foraging/beacon_chain.h"
#include "sim/arena/spawn.h"

namespace gauntlet::controllers {
namespace {

constexpr sim::Tick kPathSampling = sim::kTicksPerSecond;  // how often a path is looked for

}  // namespace

const std::vector<FailureType>& ForagingFailureTypes() {
  static const std::vector<FailureType> types = {{1, "no path"}, {2, "no food"}, {3, "no path, no food"}};
  return types;
}

ForagingScenario::ForagingScenario(const sim::TestCase& test_case, const ForagingSettings& settings,
                                   ControllerFactory controller, std::uint64_t seed)
    : NestAndFoodScenario(test_case, settings, std::move(controller), kForagingStateNames),
      bodies_block_radio_(settings.bodies_block_radio),
      seed_(seed),
      spawn_disc_(!test_case.spawn_area.has_value()),
      food_light_({.position = food_, .height = sim::foot_bot::kBeaconHeight, .color = kFoodColor}),
      nest_beacon_({nest_, settings.communication_range, Encode({.sender = RadioMessage::Sender::kNest})}) {
  const sim::Vec2 half_side(settings.spawn_radius, settings.spawn_radius);
  spawn_area_ = test_case.spawn_area.value_or(sim::Rectangle{nest_ - half_side, nest_ + half_side});
}

Result<std::vector<sim::RobotSetup>> ForagingScenario::CreateSwarm(
    const sim::Headquarters& /*headquarters*/) {
  TRY(CheckSite("food"));
  TRY(controller_.Check(arena_));
  const sim::SpawnRequest request = {.count = site_.robots,
                                     .area = spawn_area_,
                                     .disc = spawn_disc_,
                                     .robot_radius = sim::foot_bot::kRadius,
                                     .start = nest_};
  TRY(const auto poses, start_poses_.empty() ? sim::Spawn(request, arena_, seed_) : start_poses_);

  std::vector<sim::RobotSetup> swarm;
  swarm.reserve(poses.size());
  for (const sim::Pose& pose : poses) {
    swarm.push_back(SetUp(pose, {.robot = static_cast<sim::RobotIndex>(swarm.size())}));
    swarm.back().bodies_block_radio = bodies_block_radio_;
  }
  Begin(static_cast<std::uint8_t>(ForagingState::kWandering));
  return swarm;
}

void ForagingScenario::Interact(const sim::Interaction& interaction) {
  DropItems(interaction);
  ServeItems(interaction);
  // Robots say over the radio what they are doing; one that says nothing wanders.
  for (std::size_t i = 0; i < interaction.signals.size(); ++i) {
    const ForagingState state = StateIn(interaction.signals[i].message);
    Record(interaction, static_cast<sim::RobotIndex>(i), static_cast<std::uint8_t>(state),
           state == ForagingState::kBeacon);
  }
  const bool look = interaction.observer.last_tick() % kPathSampling == 0;
  if (first_path_ < 0 && look) FindFirstPath(interaction.observer);
}

bool ForagingScenario::IsBeacon(sim::RobotIndex robot, sim::Tick tick) const {
  return states_.At(robot, tick) == static_cast<std::uint8_t>(ForagingState::kBeacon);
}

void ForagingScenario::FindFirstPath(const sim::Observer& observer) {
  const sim::Tick tick = observer.last_tick();
  std::vector<sim::Vec2> beacons;
  for (sim::RobotIndex robot = 0; robot < site_.robots; ++robot) {
    if (!IsBeacon(robot, tick)) continue;
    beacons.push_back(observer.At(tick)[static_cast<std::size_t>(robot)].position());
  }
  first_chain_ =
      FindBeaconChain(arena_, {nest_, food_}, beacons, site_.communication_range, observer.ObstaclesAt(tick));
  if (!first_chain_.empty()) first_path_ = tick;
}

sim::Outcome ForagingScenario::Evaluate(const sim::Observer& observer) {
  sim::Outcome outcome = Judge(observer);
  const bool no_food = outcome.failure.total;
  outcome.failure.total = no_food || NoPath();
  if (outcome.failure.total) {
    const int type = (NoPath() ? 1 : 0) + (no_food ? 2 : 0);
    outcome.failure.type = type;
    outcome.failure.label = ForagingFailureTypes()[static_cast<std::size_t>(type) - 1].name;
  }
  const auto trapped = static_cast<int>(std::count(outcome.lost.begin(), outcome.lost.end(), true));
  outcome.metrics = ItemMetrics();
  outcome.metrics.insert(outcome.metrics.end(),
                         {{"first_path_time", first_path_ < 0 ? -1.0 : first_path_ * sim::kTickSeconds},
                          {"condition_1", NoPath() ? 1.0 : 0.0},
                          {"condition_2", no_food ? 1.0 : 0.0},
                          {"trapped_robots", trapped}});
  AddWhereabouts(observer, outcome.metrics);
  items_.AddWindows(outcome.metrics);
  states_.AddMeans(outcome.metrics);
  outcome.annotations = Annotate(observer, outcome.lost);
  return outcome;
}

std::vector<sim::Annotation> ForagingScenario::Annotate(const sim::Observer& observer,
                                                        const std::vector<bool>& trapped) const {
  const sim::Tick last = observer.last_tick();
  std::vector<sim::Annotation> annotations = Places();
  if (!first_chain_.empty()) {
    annotations.push_back({"chain", "first path of beacons", first_chain_, 0.0, first_path_, {}});
  }
  for (sim::RobotIndex robot = 0; robot < site_.robots; ++robot) {
    const auto index = static_cast<std::size_t>(robot);
    if (IsBeacon(robot, last)) {
      annotations.push_back({"beacon", "beacon", {observer.Latest()[index].position()}, 0.0, last, {robot}});
    }
    if (trapped[index]) annotations.push_back(TrappedMark(robot, last - site_.trapped_window));
  }
  for (sim::RobotIndex robot = 0; robot < site_.robots; ++robot) {
    annotations.push_back(states_.Line(robot, static_cast<std::uint8_t>(ForagingState::kDropping)));
  }
  return annotations;
}

}  // namespace gauntlet::controllers
