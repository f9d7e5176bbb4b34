#include "controllers/examples/light_flocking_scenario.h"

#include <algorithm>
#include <memory>
#include <string>
#include <utility>

#include "controllers/examples/light_flocking_metrics.h"
#include "sim/arena/spawn.h"

namespace gauntlet::controllers {
namespace {

constexpr int kMaxRobots = 100;  // also the largest value of the parameter `robots`

std::vector<sim::Vec2> PositionsAt(const sim::Observer& observer, sim::Tick tick) {
  std::vector<sim::Vec2> positions;
  for (const sim::RobotState& state : observer.At(tick)) positions.push_back(state.position());
  return positions;
}

}  // namespace

LightFlockingScenario::LightFlockingScenario(const sim::TestCase& test_case,
                                             const LightFlockingScenarioSettings& settings,
                                             const LightFlockingSettings& robot, std::uint64_t seed)
    : arena_(test_case),
      settings_(settings),
      robot_(robot),
      seed_(seed),
      start_(test_case.side_x / 2.0 - settings.corner_distance,
             test_case.side_y / 2.0 - settings.corner_distance),
      light_({.position = -start_, .height = settings.light_height, .intensity = settings.light_intensity}) {
  settings_.robots = test_case.robots.value_or(settings.robots);
  const sim::Vec2 corner(test_case.side_x / 2.0, test_case.side_y / 2.0);
  const sim::Vec2 side(settings.spawn_side, settings.spawn_side);
  spawn_area_ = test_case.spawn_area.value_or(sim::Rectangle{corner - side, corner});
}

LightFlockingScenario::LightFlockingScenario(const sim::TestCase& test_case,
                                             const LightFlockingScenarioSettings& settings,
                                             const LightFlockingSettings& robot,
                                             std::vector<sim::Pose> start_poses)
    : LightFlockingScenario(test_case, settings, robot, 0) {
  given_poses_ = std::move(start_poses);
}

Result<std::vector<sim::Pose>> LightFlockingScenario::StartPoses() const {
  if (!given_poses_.empty()) return given_poses_;
  if (settings_.robots < 1 || settings_.robots > kMaxRobots) {
    return InvalidInput("swarm-size: " + std::to_string(settings_.robots) + " robots; from 1 to " +
                        std::to_string(kMaxRobots) + " can be tested");
  }
  sim::SpawnRequest request;
  request.count = settings_.robots;
  request.area = spawn_area_;
  request.robot_radius = sim::foot_bot::kRadius;
  request.start = start_;
  sim::RandomStream random(seed_, sim::StreamPurpose::kSpawn);
  const sim::OccupancyGrid grid(arena_, sim::OccupancyGrid::kDefaultInflation);
  return sim::Spawn(request, grid, random);
}

Result<std::vector<sim::RobotSetup>> LightFlockingScenario::CreateSwarm(const sim::Headquarters&) {
  const auto poses = StartPoses();
  if (!poses.ok()) return poses.error();
  std::vector<sim::RobotSetup> swarm;
  for (const sim::Pose& pose : *poses) {
    swarm.push_back({.pose = pose,
                     .beacon = LightFlockingController::kColor,
                     .camera_range = settings_.camera_range,
                     .controller = std::make_unique<LightFlockingController>(robot_)});
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
      {"clusters", static_cast<double>(CountClusters(end, arena_, robot_.cutoff * robot_.target_distance,
                                                     observer.ObstaclesAt(observer.last_tick())))},
  };
  outcome.lost.assign(end.size(), false);
  const std::vector<sim::Vec2> corners = {spawn_area_.min,
                                          {spawn_area_.max.x(), spawn_area_.min.y()},
                                          spawn_area_.max,
                                          {spawn_area_.min.x(), spawn_area_.max.y()}};
  outcome.annotations = {{"area", "start of the robots", corners, 0.0, -1, {}},
                         {"disc", "light", {light_.position}, 0.1, -1, {}}};
  return outcome;
}

}  // namespace gauntlet::controllers
