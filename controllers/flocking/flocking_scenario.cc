#include "controllers/flocking/flocking_scenario.h"

#include <string>
#include <utility>

#include "controllers/flocking/flocking_metrics.h"
#include "sim/arena/spawn.h"
#include "sim/geometry/trigonometry.h"

namespace gauntlet::controllers {
namespace {

constexpr int kMaxBirds = 100;  // also the largest value of the parameter `birds`

double Length(const std::vector<sim::Vec2>& path) {
  double length = 0.0;
  for (std::size_t i = 1; i < path.size(); ++i) length += (path[i] - path[i - 1]).norm();
  return length;
}

sim::Vec2 MeanPosition(const sim::Observer& observer, const std::vector<sim::RobotIndex>& robots,
                       sim::Tick tick) {
  sim::Vec2 sum = sim::Vec2::Zero();
  for (const sim::RobotIndex robot : robots) {
    sum += observer.At(tick)[static_cast<std::size_t>(robot)].position();
  }
  return sum / static_cast<double>(robots.size());
}

}  // namespace

std::vector<sim::Vec2> FlockingSettings::Passages(const sim::TestCase& test_case) const {
  const sim::Vec2 start = Requirements(test_case).start;
  std::vector<sim::Vec2> path = PlanPreyPath(sim::Arena(test_case), start, -start, prey.inflation);
  if (path.size() <= 2) return path;
  return {path.begin() + 1, path.end() - 1};
}

FlockingScenario::FlockingScenario(const sim::TestCase& test_case, const FlockingSettings& settings,
                                   ControllerFactory birds, std::uint64_t seed)
    : arena_(test_case),
      settings_(settings),
      birds_(std::move(birds)),
      seed_(seed),
      start_(settings.Requirements(test_case).start),
      goal_(-start_),
      spawn_area_(settings.StartArea(test_case)),
      start_poses_(test_case.start_poses) {
  settings_.birds = test_case.robots.value_or(settings.birds);
}

Result<std::vector<sim::RobotSetup>> FlockingScenario::CreateSwarm(const sim::Headquarters& headquarters) {
  TRY(birds_.Check(arena_));
  if (settings_.birds < settings_.min_swarm || settings_.birds > kMaxBirds) {
    return InvalidInput("swarm-size: " + std::to_string(settings_.birds) +
                        " birds; from min_swarm = " + std::to_string(settings_.min_swarm) + " to " +
                        std::to_string(kMaxBirds) + " can be tested");
  }
  prey_path_ = PlanPreyPath(arena_, start_, goal_, settings_.prey.inflation);
  if (prey_path_.empty()) {
    return InvalidInput(std::string(NameOf(sim::ValidityRule::kNoPath)) + ": the prey finds no path");
  }

  const sim::SpawnRequest request = {.count = settings_.birds,
                                     .area = spawn_area_,
                                     .robot_radius = sim::foot_bot::kRadius,
                                     .occupied = {start_},
                                     .start = start_};
  TRY(const auto poses, start_poses_.empty() ? sim::Spawn(request, arena_, seed_) : start_poses_);

  std::vector<sim::RobotSetup> swarm;
  swarm.reserve(static_cast<std::size_t>(settings_.birds) + 1);
  for (const sim::Pose& pose : poses) {
    const auto bird = static_cast<sim::RobotIndex>(swarm.size());
    swarm.push_back(
        {pose, kBirdColor, settings_.camera_range, birds_.create({.robot = bird, .start = pose})});
  }
  const sim::Pose prey_pose{start_, sim::AngleOf(goal_ - start_)};
  swarm.push_back({prey_pose, kPreyColor, 0.0,
                   std::make_unique<PreyController>(headquarters, prey(), prey_path_, settings_.prey)});
  swarm.back().under_test = false;
  return swarm;
}

bool FlockingScenario::Finished(const sim::Observer& observer) {
  const sim::Vec2 position = observer.Latest()[static_cast<std::size_t>(prey())].position();
  return (position - goal_).squaredNorm() <= settings_.goal_radius * settings_.goal_radius;
}

sim::Outcome FlockingScenario::Evaluate(const sim::Observer& observer) {
  const SplitHistory history = FindSplits(observer, arena_, prey(), settings_.split);
  sim::Outcome outcome;
  std::vector<double> headings;
  for (sim::RobotIndex bird = 0; bird < settings_.birds; ++bird) {
    const auto index = static_cast<std::size_t>(bird);
    const bool remains = history.main_cluster[index] != 0;
    outcome.lost.push_back(!remains);
    if (remains) headings.push_back(observer.Latest()[index].heading);
  }
  outcome.lost.push_back(false);  // the prey

  const int remaining = static_cast<int>(headings.size());
  const double order = AngularOrder(headings);
  outcome.fitness = FlockingFitness(order, remaining, settings_.birds, settings_.min_swarm);
  outcome.failure.total = remaining < settings_.min_swarm;

  outcome.annotations = {
      {"area", "start of the birds", CornersOf(spawn_area_), 0.0, -1, {}},
      {"path", "planned path of the prey", prey_path_, 0.0, -1, {}},
      {"disc", "goal", {goal_}, settings_.goal_radius, -1, {}},
  };

  double split_time = kNotMeasured;
  double split_angle = kNotMeasured;
  double split_speed_ratio = kNotMeasured;
  sim::Vec2 split_place(kNowhere, kNowhere);
  if (const SplitEvent* split = LastSplit(history.events)) {
    const RelativeMotion motion = CompareMotion(observer, *split, settings_.split.half_window);
    const int type = FailureTypeOf(motion);
    if (outcome.failure.total) {
      outcome.failure.type = type;
      outcome.failure.label = FailureLabel(type);
    }
    split_place = MeanPosition(observer, split->birds, split->tick);
    outcome.annotations.push_back(
        {"split", FailureLabel(type), {split_place}, 0.0, split->tick, split->birds});
    split_time = split->tick * sim::kTickSeconds;
    split_angle = motion.angle;
    split_speed_ratio = motion.speed_ratio;
  }

  outcome.metrics = {
      {"angular_order", order},
      {"birds_left", remaining},
      {"proportion_left", static_cast<double>(remaining) / settings_.birds},
      {"arrival_time", observer.last_tick() * sim::kTickSeconds},
      {"timeout", Finished(observer) ? 0.0 : 1.0},
      {"prey_path_length", Length(prey_path_)},
      {"splits", static_cast<double>(history.events.size())},
      {"split_time", split_time},
      {"split_angle", split_angle},
      {"split_speed_ratio", split_speed_ratio},
      {"split_x", split_place.x()},
      {"split_y", split_place.y()},
  };
  return outcome;
}

}  // namespace gauntlet::controllers
