// A plug-in to copy: a scenario of its own, and a controller for it. Robots have to come everywhere: the
// floor is cut into square patches, and a patch is patrolled once a robot's centre was in it. No formula over
// the robots' places says that, for it is about where nobody has been.
#include <algorithm>
#include <cmath>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "controllers/common/proximity.h"
#include "sdk/plugin.h"
#include "sim/arena/occupancy_grid.h"
#include "sim/arena/spawn.h"

namespace {

namespace sim = gauntlet::sim;
namespace controllers = gauntlet::controllers;
using controllers::Into;
using controllers::IntoTicks;
using gauntlet::Result;

constexpr int kMostRobots = 100;  // also the largest value of the parameter `robots`

struct PatrolSettings {
  int robots = 0;
  sim::Tick tick_limit = 0;
  double patch = 0.0;         // m, side of a patch
  double enough = 0.0;        // share of the patches; with less the swarm has failed
  double spawn_side = 0.0;    // m, of the square around the middle in which robots start
  double camera_range = 0.0;  // m, half side of the square that a robot sees

  // A way from the middle, where robots start, to the corner (-,-).
  sim::ArenaRequirements Requirements(const sim::TestCase& test_case) const {
    return {.start = sim::Vec2::Zero(), .goal = {0.5 - test_case.side_x / 2.0, 0.5 - test_case.side_y / 2.0}};
  }
};

// The floor in patches: those that a robot can come to, and which of them somebody has been in.
class Patches {
 public:
  Patches(const sim::Arena& arena, double side) : origin_(arena.interior_min()), side_(side) {
    const sim::Vec2 size = arena.interior_max() - arena.interior_min();
    columns_ = static_cast<int>(size.x() / side);
    rows_ = static_cast<int>(size.y() / side);
    const sim::OccupancyGrid grid(arena, sim::OccupancyGrid::kDefaultInflation);
    const std::vector<std::uint8_t> reachable = grid.Reachable(grid.CellAt(sim::Vec2::Zero()));
    for (int i = 0; i < columns_ * rows_; ++i)
      open_.push_back(reachable[grid.Index(grid.CellAt(CenterOf(i)))] != 0);
    visited_.assign(open_.size(), false);
  }

  void Visit(const sim::Vec2& place) {
    const int column = static_cast<int>(std::floor((place.x() - origin_.x()) / side_));
    const int row = static_cast<int>(std::floor((place.y() - origin_.y()) / side_));
    if (column < 0 || row < 0 || column >= columns_ || row >= rows_) return;
    const auto patch = static_cast<std::size_t>(row * columns_ + column);
    if (open_[patch]) visited_[patch] = true;
  }
  // Share of the open patches that somebody has been in.
  double Share() const {
    const auto open = std::ranges::count(open_, true);
    return open == 0 ? 1.0
                     : static_cast<double>(std::ranges::count(visited_, true)) / static_cast<double>(open);
  }
  // Centres of the open patches that nobody has been in.
  std::vector<sim::Vec2> Missed() const {
    std::vector<sim::Vec2> missed;
    for (std::size_t i = 0; i < open_.size(); ++i) {
      if (open_[i] && !visited_[i]) missed.push_back(CenterOf(static_cast<int>(i)));
    }
    return missed;
  }

 private:
  sim::Vec2 CenterOf(int patch) const {
    return origin_ + side_ * sim::Vec2(patch % columns_ + 0.5, patch / columns_ + 0.5);
  }

  sim::Vec2 origin_;  // of the first patch's corner
  double side_;
  int columns_ = 0;
  int rows_ = 0;
  std::vector<bool> open_;
  std::vector<bool> visited_;
};

class PatrolScenario : public sim::Scenario {
 public:
  PatrolScenario(const sim::TestCase& test_case, const PatrolSettings& settings,
                 controllers::ControllerFactory robots, std::uint64_t seed)
      : arena_(test_case),
        settings_(settings),
        robots_(std::move(robots)),
        seed_(seed),
        start_poses_(test_case.start_poses),
        patches_(arena_, settings.patch) {
    settings_.robots = test_case.robots.value_or(settings.robots);
    const sim::Vec2 half(settings.spawn_side / 2.0, settings.spawn_side / 2.0);
    spawn_area_ = test_case.spawn_area.value_or(sim::Rectangle{-half, half});
  }

  const sim::Arena& arena() const override { return arena_; }
  sim::Tick tick_limit() const override { return settings_.tick_limit; }

  Result<std::vector<sim::RobotSetup>> CreateSwarm(const sim::Headquarters&) override {
    TRY(robots_.Check(arena_));
    TRY(const std::vector<sim::Pose> poses, StartPoses());
    std::vector<sim::RobotSetup> swarm;
    for (const sim::Pose& pose : poses) {
      const auto robot = static_cast<sim::RobotIndex>(swarm.size());
      swarm.push_back({.pose = pose,
                       .beacon = sim::Color::kRed,
                       .camera_range = settings_.camera_range,
                       .controller = robots_.create({.robot = robot, .start = pose})});
    }
    return swarm;
  }

  bool Finished(const sim::Observer& observer) override {
    for (const sim::RobotState& robot : observer.Latest()) patches_.Visit(robot.position());
    return patches_.Share() == 1.0;
  }

  sim::Outcome Evaluate(const sim::Observer& observer) override {
    const std::vector<sim::Vec2> missed = patches_.Missed();
    sim::Vec2 middle(controllers::kNowhere, controllers::kNowhere);
    if (!missed.empty()) {
      middle = sim::Vec2::Zero();
      for (const sim::Vec2& place : missed) middle += place / static_cast<double>(missed.size());
    }
    sim::Outcome outcome;
    outcome.fitness = patches_.Share();
    outcome.failure.total = outcome.fitness < settings_.enough;
    outcome.metrics = {{"patrolled", outcome.fitness},
                       {"missed_patches", static_cast<double>(missed.size())},
                       {"missed_x", middle.x()},
                       {"missed_y", middle.y()}};
    outcome.lost.assign(static_cast<std::size_t>(observer.robots()), false);
    outcome.annotations.push_back({"area", "start of the robots", CornersOf(spawn_area_), 0.0, -1, {}});
    for (const sim::Vec2& place : missed)
      outcome.annotations.push_back({"disc", "missed", {place}, settings_.patch / 4.0, -1, {}});
    return outcome;
  }

 private:
  static std::vector<sim::Vec2> CornersOf(const sim::Rectangle& area) {
    return {area.min, {area.max.x(), area.min.y()}, area.max, {area.min.x(), area.max.y()}};
  }

  Result<std::vector<sim::Pose>> StartPoses() const {
    if (!start_poses_.empty()) return start_poses_;
    if (settings_.robots < 1 || settings_.robots > kMostRobots) {
      return gauntlet::InvalidInput("swarm-size: " + std::to_string(settings_.robots) +
                                    " robots; from 1 to " + std::to_string(kMostRobots) + " can be tested");
    }
    const sim::SpawnRequest request = {.count = settings_.robots,
                                       .area = spawn_area_,
                                       .robot_radius = sim::foot_bot::kRadius,
                                       .start = sim::Vec2::Zero()};
    sim::RandomStream random(seed_, sim::StreamPurpose::kSpawn);
    return sim::Spawn(request, sim::OccupancyGrid(arena_, sim::OccupancyGrid::kDefaultInflation), random);
  }

  sim::Arena arena_;
  PatrolSettings settings_;
  controllers::ControllerFactory robots_;
  std::uint64_t seed_;
  std::vector<sim::Pose> start_poses_;  // that the test case gives; empty: the seed decides
  sim::Rectangle spawn_area_;
  Patches patches_;
};

struct GuardSettings {
  double speed = 0.0;      // m/s
  double shyness = 0.0;    // weight of what is near
  double curiosity = 0.0;  // of a new heading, per tick
};

// Goes straight on, turns from what is near, and takes another heading now and then.
class Guard : public sim::Controller {
 public:
  explicit Guard(const GuardSettings& settings) : settings_(settings) {}

  sim::DeviceSet Devices() const override { return sim::Device::kWheels | sim::Device::kProximity; }

  void Step(const sim::ControlStep& step) override {
    if (step.random.Chance(settings_.curiosity)) turn_ = step.random.Uniform(-sim::kPi, sim::kPi);
    sim::Vec2 wish(sim::Cos(turn_), sim::Sin(turn_));
    const auto& directions = controllers::ProximityDirections();
    for (std::size_t i = 0; i < directions.size(); ++i)
      wish -= settings_.shyness * step.readings.proximity[i] * directions[i];
    const double turn = sim::AngleOf(wish);
    step.actuators.Drive(settings_.speed, turn);
    turn_ = sim::WrapAngle(turn_ - turn * sim::kTickSeconds);
  }

 private:
  GuardSettings settings_;
  double turn_ = 0.0;  // rad, still to be turned
};

controllers::ControllerFactory MakeGuards(const GuardSettings& settings) {
  return {.create =
              [settings](const controllers::ControllerContext&) { return std::make_unique<Guard>(settings); },
          .traits = {.link_range = 1.0}};
}

std::vector<controllers::ControllerInfo> MyControllers() {
  using S = GuardSettings;
  static const controllers::ParameterTable<S> table({
      {"speed", "m/s", 0.1, 0.0, 0.3, Into<&S::speed>(), "forward speed (chosen)"},
      {"shyness", "", 2.0, 0.0, 10.0, Into<&S::shyness>(), "weight of what is near (chosen)"},
      {"curiosity", "", 0.01, 0.0, 1.0, Into<&S::curiosity>(),
       "probability of a new heading, per tick (chosen)"},
  });
  return {
      controllers::ControllerRow("my-guard", "my-patrol", "wanders, turns from walls", table, MakeGuards)};
}

const std::vector<controllers::MetricInfo> kMetrics = {
    {"patrolled", "", {}, "share of the patches that a robot came to", true},
    {"missed_patches", "", {}, "patches that no robot came to"},
    {"missed_x", "m", controllers::kNowhere, "middle of the patches that no robot came to", true},
    {"missed_y", "m", controllers::kNowhere, "middle of the patches that no robot came to", true},
};
const std::vector<sim::AnnotationStyle> kAnnotations = {
    {"area", "", sim::Mark::kArea, "area the swarm starts in"},
    {"disc", "missed", sim::Mark::kGoal, "where nobody was"},
};

std::vector<controllers::ScenarioInfo> MyScenarios() {
  using S = PatrolSettings;
  static const controllers::ParameterTable<S> table({
      {"robots", "", 5, 1, kMostRobots, Into<&S::robots>(),
       "robots under test; a test case may override it (chosen)"},
      {"time_limit", "s", 300, 1, 3600, IntoTicks<&S::tick_limit>(),
       "length of a run that leaves something out (chosen)"},
      {"patch", "m", 0.5, 0.2, 3.0, Into<&S::patch>(), "side of a patch (chosen)"},
      {"enough", "", 0.7, 0.0, 1.0, Into<&S::enough>(),
       "share of the patches; with less the swarm has failed (chosen)"},
      {"spawn_side", "m", 1.5, 0.3, 6.0, Into<&S::spawn_side>(),
       "square around the middle that robots start in (chosen)"},
      {"camera_range", "m", 1.6373, 0.2, 10.0, Into<&S::camera_range>(),
       "half side of the square a robot sees (ARGoS: 0.2887 m * tan(80 degrees))"},
  });
  return {controllers::ScenarioRow<PatrolScenario>(
      table, {.name = "my-patrol",
              .description = "robots have to come to every patch of the floor",
              .default_controller = "my-guard",
              .style = {.lost_is_failure = false, .annotations = kAnnotations},
              .metrics = kMetrics,
              .failures = {.axes = {{"missed_x", -3.0, 3.0, 6}, {"missed_y", -3.0, 3.0, 6}},
                           .place = {{"missed_x", "missed_y", 1.0}}},
              .any_controller = true})};
}

}  // namespace

GAUNTLET_SCENARIO_PLUGIN(MyControllers, MyScenarios)
