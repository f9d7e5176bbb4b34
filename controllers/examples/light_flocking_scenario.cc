#include "controllers/examples/light_flocking_scenario.h"

#include <algorithm>
#include <string>
#include <utility>

#include "controllers/common/open_arena.h"  // PositionsAt
#include "controllers/examples/light_flocking_metrics.h"
#include "sim/arena/spawn.h"

namespace gauntlet::controllers::light_flocking {
namespace {

constexpr int kMaxRobots = 100;  // also the largest value of the parameter `robots`

}  // namespace

LightFlockingScenario::LightFlockingScenario(const sim::TestCase& test_case,
                                             const LightFlockingScenarioSettings& settings,
                                             ControllerFactory robots, std::uint64_t seed)
    : arena_(test_case),
      settings_(settings),
      robots_(std::move(robots)),
      seed_(seed),
      start_(settings.Requirements(test_case).start),
      light_({.position = -start_, .height = settings.light_height, .intensity = settings.light_intensity}),
      spawn_area_(settings.StartArea(test_case)),
      given_poses_(test_case.start_poses) {
  settings_.robots = test_case.robots.value_or(settings.robots);
}

LightFlockingScenario::LightFlockingScenario(const sim::TestCase& test_case,
                                             const LightFlockingScenarioSettings& settings,
                                             ControllerFactory robots, std::vector<sim::Pose> start_poses)
    : LightFlockingScenario(test_case, settings, std::move(robots), 0) {
  given_poses_ = std::move(start_poses);
}

Result<std::vector<sim::Pose>> LightFlockingScenario::StartPoses() const {
  if (!given_poses_.empty()) return given_poses_;
  if (settings_.robots < 1 || settings_.robots > kMaxRobots) {
    return InvalidInput("swarm-size: " + std::to_string(settings_.robots) + " robots; from 1 to " +
                        std::to_string(kMaxRobots) + " can be tested");
  }
  const sim::SpawnRequest request = {.count = settings_.robots,
                                     .area = spawn_area_,
                                     .robot_radius = sim::foot_bot::kRadius,
                                     .start = start_};
  return sim::Spawn(request, arena_, seed_);
}

Result<std::vector<sim::RobotSetup>> LightFlockingScenario::CreateSwarm(const sim::Headquarters&) {
  TRY(robots_.Check(arena_));
  TRY(const auto poses, StartPoses());
  std::vector<sim::RobotSetup> swarm;
  for (const sim::Pose& pose : poses) {
    const auto robot = static_cast<sim::RobotIndex>(swarm.size());
    swarm.push_back({.pose = pose,
                     .beacon = kFlockmateColor,
                     .camera_range = settings_.camera_range,
                     .controller = robots_.create({.robot = robot, .start = pose})});
  }
  return swarm;
}

sim::Outcome LightFlockingScenario::Evaluate(const sim::Observer& observer) {
  const sim::Tick last = observer.last_tick();
  const std::vector<sim::Vec2> end = PositionsAt(observer, last);
  std::vector<std::vector<sim::Vec2>> late;
  for (sim::Tick tick = std::max(0, last - kStoppedTicks); tick <= last; tick += kStoppedSampleTicks) {
    late.push_back(PositionsAt(observer, tick));
  }
  const double start_distance = MeanDistance(PositionsAt(observer, 0), light_.position);
  const double end_distance = MeanDistance(end, light_.position);

  sim::Outcome outcome;
  outcome.fitness = std::max(0.0, 1.0 - end_distance / start_distance);
  outcome.failure.total = outcome.fitness < 0.5;
  outcome.metrics = {
      {"light_distance", end_distance},
      {"stopped", ShareStopped(late, kStopped)},
      {"clusters", static_cast<double>(CountClusters(end, arena_, robots_.traits.link_range,
                                                     observer.ObstaclesAt(observer.last_tick())))},
  };
  outcome.lost.assign(end.size(), false);
  outcome.annotations = {{"area", "start of the robots", CornersOf(spawn_area_), 0.0, -1, {}},
                         {"disc", "light", {light_.position}, 0.1, -1, {}}};
  return outcome;
}

}  // namespace gauntlet::controllers::light_flocking
