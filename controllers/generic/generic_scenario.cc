#include "controllers/generic/generic_scenario.h"

#include <algorithm>
#include <utility>

#include "base/number_text.h"
#include "controllers/common/corners.h"
#include "controllers/common/odometer.h"
#include "sim/arena/spawn.h"
#include "sim/geometry/trigonometry.h"

namespace gauntlet::controllers::generic {
namespace {

constexpr int kMaxRobots = 100;  // also the largest value of the parameter `robots`

GenericSettings WithRobots(GenericSettings settings, std::optional<int> robots) {
  settings.robots = robots.value_or(settings.robots);
  return settings;
}

// Of a definition that was checked.
Formula Compiled(const std::string& text, const std::vector<std::string>& names) {
  return *Formula::Compile(text, names);
}

std::string Complaint(std::string_view name, const std::string& formula, const std::string& why) {
  return std::string(name).append(" = \"").append(formula).append("\": ").append(why);
}

std::vector<sim::Vec2> CornersOf(const Area& area) {
  const sim::Vec2 center(area.x, area.y);
  return controllers::CornersOf(sim::Rectangle{center - area.HalfExtents(), center + area.HalfExtents()});
}

}  // namespace

sim::Rectangle GenericSettings::StartArea(const sim::TestCase& test_case) const {
  const sim::Vec2 center(spawn_x, spawn_y);
  const sim::Vec2 half(spawn_length / 2.0, spawn_width / 2.0);
  return test_case.spawn_area.value_or(sim::Rectangle{center - half, center + half});
}

sim::ArenaRequirements GenericSettings::Requirements(const sim::TestCase& test_case) const {
  const sim::Rectangle area = StartArea(test_case);
  return {.start = (area.min + area.max) / 2.0, .goal = goal, .clearance = clearance};
}

GenericScenario::GenericScenario(const sim::TestCase& test_case, const GenericSettings& settings,
                                 Definition definition, ControllerFactory robots, std::uint64_t seed)
    : arena_(test_case),
      settings_(WithRobots(settings, test_case.robots)),
      definition_(std::move(definition)),
      robots_(std::move(robots)),
      seed_(seed),
      start_(settings.Requirements(test_case).start),
      spawn_area_(settings.StartArea(test_case)),
      start_poses_(test_case.start_poses),
      items_(definition_.sources, definition_.nests),
      measures_(arena_, settings_),
      fitness_(Compiled(definition_.fitness, NamesAtTheEnd())),
      failure_(Compiled(definition_.failure, NamesAtTheEnd())) {
  if (!definition_.reached.empty()) reached_ = Compiled(definition_.reached, NamesAtAMoment());
}

double GenericScenario::FloorGrey(const sim::Vec2& point) const {
  for (const std::vector<Area>* areas : {&definition_.nests, &definition_.sources, &definition_.ground}) {
    for (const Area& area : *areas) {
      if (area.Holds(point)) return area.grey;
    }
  }
  return 1.0;
}

std::vector<sim::GroundArea> GenericScenario::ground_areas() const {
  std::vector<sim::GroundArea> all;
  for (const auto& [what, areas] : {std::pair{"nest", &definition_.nests},
                                    {"source", &definition_.sources},
                                    {"ground", &definition_.ground}}) {
    for (const Area& area : *areas)
      all.push_back({what, {area.x, area.y}, area.radius, area.HalfExtents(), area.grey});
  }
  return all;
}

Status GenericScenario::Check() const {
  if (settings_.robots < 1 || settings_.robots > kMaxRobots) {
    return InvalidInput("swarm-size: " + std::to_string(settings_.robots) + " robots; from 1 to " +
                        std::to_string(kMaxRobots) + " can be tested");
  }
  const auto inside = [&](const char* what, std::size_t index, const sim::Vec2& place) -> Status {
    if (arena_.InInterior(place)) return Ok{};
    return InvalidInput("outside-arena: " + std::string(what) + "." + std::to_string(index + 1) + " at " +
                        PointText(place.x(), place.y()) +
                        " m is outside the walls, whose inner faces are at " +
                        PointText(arena_.interior_min().x(), arena_.interior_min().y()) + " and " +
                        PointText(arena_.interior_max().x(), arena_.interior_max().y()) + " m");
  };
  for (std::size_t i = 0; i < definition_.lights.size(); ++i) {
    TRY(inside("light", i, definition_.lights[i].position));
  }
  for (const auto& [what, areas] : {std::pair{"ground", &definition_.ground},
                                    {"source", &definition_.sources},
                                    {"nest", &definition_.nests}}) {
    for (std::size_t i = 0; i < areas->size(); ++i) {
      TRY(inside(what, i, {(*areas)[i].x, (*areas)[i].y}));
    }
  }
  return Ok{};
}

Result<std::vector<sim::Pose>> GenericScenario::StartPoses() const {
  if (!start_poses_.empty()) return start_poses_;
  const sim::SpawnRequest request = {.count = settings_.robots,
                                     .area = spawn_area_,
                                     .robot_radius = sim::foot_bot::kRadius,
                                     .start = start_};
  TRY(std::vector<sim::Pose> poses, sim::Spawn(request, arena_, seed_));
  for (sim::Pose& pose : poses) {
    pose.heading = sim::WrapAngle(settings_.heading + pose.heading * (settings_.heading_spread / sim::kPi));
  }
  return poses;
}

Result<std::vector<sim::RobotSetup>> GenericScenario::CreateSwarm(const sim::Headquarters& headquarters) {
  TRY(Check());
  TRY(robots_.Check(arena_));
  TRY(const auto poses, StartPoses());
  const double pickup_distance =
      definition_.sources.empty() ? 0.0 : definition_.sources.front().HalfExtents().minCoeff();
  std::vector<sim::RobotSetup> swarm;
  std::vector<bool> grips;
  for (const sim::Pose& pose : poses) {
    const auto robot = static_cast<sim::RobotIndex>(swarm.size());
    sim::RobotSetup setup;
    setup.pose = pose;
    setup.camera_range = settings_.camera_range;
    setup.radio_range = settings_.communication_range;
    setup.controller = robots_.create({.robot = robot,
                                       .start = pose,
                                       .communication_range = settings_.communication_range,
                                       .pickup_distance = pickup_distance,
                                       .odometer = OdometerOf(headquarters, robot, pose)});
    grips.push_back(setup.controller->Devices().Has(sim::Device::kGripper));
    swarm.push_back(std::move(setup));
  }
  items_.Begin(std::move(grips));
  return swarm;
}

void GenericScenario::LookWhetherReached(const sim::Observer& observer) {
  const sim::Tick tick = observer.last_tick();
  at_the_moment_.assign({static_cast<double>(settings_.robots), tick * sim::kTickSeconds,
                         static_cast<double>(items_.count().brought)});
  const Moment& moment = measures_.moment();
  at_the_moment_.insert(at_the_moment_.end(), moment.begin(), moment.end());
  const Result<double> value = reached_->Evaluate(at_the_moment_);
  if (!value.ok()) {
    complaint_ = Complaint("reached", definition_.reached, value.error().message);
  } else if (*value != 0.0) {
    reached_at_ = tick;
  }
}

bool GenericScenario::Finished(const sim::Observer& observer) {
  const bool second = measures_.Add(observer);
  if (second && reached_ && reached_at_ < 0) LookWhetherReached(observer);
  return !complaint_.empty() || (settings_.end_when_reached && reached_at_ >= 0);
}

sim::Outcome GenericScenario::Evaluate(const sim::Observer& observer) {
  sim::Outcome outcome;
  outcome.complaint = complaint_;
  if (!complaint_.empty()) return outcome;
  const std::vector<double> values = measures_.Values(observer, items_.count(), reached_at_);
  std::vector<double> named = {static_cast<double>(settings_.robots),
                               observer.last_tick() * sim::kTickSeconds};
  named.insert(named.end(), values.begin(), values.end());
  const Result<double> fitness = fitness_.Evaluate(named);
  const Result<double> failure = failure_.Evaluate(named);
  if (!fitness.ok()) {
    outcome.complaint = Complaint("fitness", definition_.fitness, fitness.error().message);
  } else if (!failure.ok()) {
    outcome.complaint = Complaint("failure", definition_.failure, failure.error().message);
  }
  if (!outcome.complaint.empty()) return outcome;

  outcome.fitness = *fitness;
  outcome.failure.total = *failure != 0.0;
  for (std::size_t i = 0; i < values.size(); ++i) outcome.metrics.emplace_back(Metrics()[i].name, values[i]);
  outcome.annotations = Places();
  for (const sim::Tick since : measures_.TrappedSince(observer)) {
    const auto robot = static_cast<sim::RobotIndex>(outcome.lost.size());
    outcome.lost.push_back(since >= 0);
    if (since >= 0) outcome.annotations.push_back({"trapped", "trapped", {}, 0.0, since, {robot}});
  }
  return outcome;
}

std::vector<sim::Annotation> GenericScenario::Places() const {
  std::vector<sim::Annotation> places = {
      {"area", "start of the robots", controllers::CornersOf(spawn_area_), 0.0, -1, {}},
      {"disc", "goal", {settings_.goal}, settings_.goal_radius, -1, {}}};
  for (const sim::Light& light : definition_.lights)
    places.push_back({"disc", "light", {light.position}, 0.1, -1, {}});
  for (const auto& [what, areas] : {std::pair{"ground", &definition_.ground},
                                    {"source", &definition_.sources},
                                    {"nest", &definition_.nests}}) {
    for (const Area& area : *areas) {
      if (area.radius > 0.0) {
        places.push_back({"disc", what, {{area.x, area.y}}, area.radius, -1, {}});
      } else {
        places.push_back({"area", what, CornersOf(area), 0.0, -1, {}});
      }
    }
  }
  return places;
}

}  // namespace gauntlet::controllers::generic
