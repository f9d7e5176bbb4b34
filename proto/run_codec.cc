#include "proto/run_codec.h"

#include <fmt/format.h>
#include <google/protobuf/stubs/logging.h>
#include <google/protobuf/util/json_util.h>

#include <utility>

#include "proto/json_message.h"
#include "proto/run.pb.h"

namespace gauntlet::master {
namespace {

void ToProto(const sim::TestCase& test_case, v1::TestCase& message) {
  message.set_name(test_case.name);
  message.set_side_x(test_case.side_x);
  message.set_side_y(test_case.side_y);
  message.set_wall_thickness(test_case.wall_thickness);
  for (const sim::ObstacleGene& gene : test_case.obstacles) {
    v1::Obstacle& obstacle = *message.add_obstacles();
    obstacle.set_x(gene.x);
    obstacle.set_y(gene.y);
    obstacle.set_length(gene.length);
    obstacle.set_width(gene.width);
    obstacle.set_orientation_deg(gene.orientation_deg);
    if (gene.speed != 0.0 || !gene.path.empty()) {
      obstacle.mutable_motion()->set_speed(gene.speed);
      for (const sim::Vec2& point : gene.path) {
        v1::Point& written = *obstacle.mutable_motion()->add_path();
        written.set_x(point.x());
        written.set_y(point.y());
      }
    }
    if (gene.Lit()) obstacle.set_light(std::string(sim::NameOf(gene.light)));
  }
  if (test_case.spawn_area) {
    v1::Rectangle& area = *message.mutable_spawn_area();
    area.set_min_x(test_case.spawn_area->min.x());
    area.set_min_y(test_case.spawn_area->min.y());
    area.set_max_x(test_case.spawn_area->max.x());
    area.set_max_y(test_case.spawn_area->max.y());
  }
  if (test_case.robots) message.set_robots(*test_case.robots);
}

Result<sim::TestCase> FromProto(const v1::TestCase& message) {
  sim::TestCase test_case;
  test_case.name = message.name();
  if (message.has_side_x()) test_case.side_x = message.side_x();
  if (message.has_side_y()) test_case.side_y = message.side_y();
  if (message.has_wall_thickness()) test_case.wall_thickness = message.wall_thickness();
  test_case.obstacles.reserve(static_cast<std::size_t>(message.obstacles_size()));
  for (const v1::Obstacle& obstacle : message.obstacles()) {
    sim::ObstacleGene& gene = test_case.obstacles.emplace_back(sim::ObstacleGene{
        obstacle.x(), obstacle.y(), obstacle.length(), obstacle.width(), obstacle.orientation_deg()});
    gene.speed = obstacle.motion().speed();
    for (const v1::Point& point : obstacle.motion().path()) gene.path.emplace_back(point.x(), point.y());
    if (!obstacle.has_light()) continue;
    const std::optional<sim::Color> light = sim::ColorNamed(obstacle.light());
    if (!light) {
      return InvalidInput(fmt::format("obstacle {}: '{}' is no colour of lights; known: {}",
                                      test_case.obstacles.size(), obstacle.light(),
                                      fmt::join(sim::kColorNames, ", ")));
    }
    gene.light = *light;
  }
  if (message.has_spawn_area()) {
    const v1::Rectangle& area = message.spawn_area();
    test_case.spawn_area = sim::Rectangle{{area.min_x(), area.min_y()}, {area.max_x(), area.max_y()}};
  }
  if (message.has_robots()) test_case.robots = message.robots();
  return test_case;
}

Error Corrupt(const std::string& what) {
  return {ErrorKind::kCorrupt, what};
}

void ToProto(const sim::Disturbances& disturbances, v1::RunSpec& message) {
  for (const auto& [device, noise] : disturbances.noise) {
    v1::DeviceNoise& written = *message.add_noise();
    written.set_device(sim::KeyOf(device));
    written.set_uniform(noise.uniform);
    written.set_gaussian(noise.gaussian);
    written.set_drop(noise.drop);
  }
  for (const sim::RobotFault& fault : disturbances.faults) {
    v1::RobotFault& written = *message.add_faults();
    written.set_robot(fault.robot);
    if (fault.device) written.set_device(sim::KeyOf(*fault.device));
    written.set_tick(fault.tick);
  }
}

Status FromProto(const v1::RunSpec& message, sim::Disturbances& disturbances) {
  for (const v1::DeviceNoise& noise : message.noise()) {
    const std::optional<sim::Device> device = sim::DeviceOfKey(noise.device());
    if (!device) return Corrupt(fmt::format("the run spec has noise of '{}', no device", noise.device()));
    disturbances.noise[*device] = {noise.uniform(), noise.gaussian(), noise.drop()};
  }
  for (const v1::RobotFault& fault : message.faults()) {
    const std::optional<sim::Device> device = sim::DeviceOfKey(fault.device());
    if (!device && !fault.device().empty()) {
      return Corrupt(fmt::format("the run spec has a fault of '{}', no device", fault.device()));
    }
    disturbances.faults.push_back({fault.robot(), device, fault.tick()});
  }
  return Ok{};
}

void ToProto(const sim::Pose& pose, v1::Pose& message) {
  message.set_x(pose.position.x());
  message.set_y(pose.position.y());
  message.set_heading(pose.heading);
}

sim::Pose FromProto(const v1::Pose& message) {
  return {{message.x(), message.y()}, message.heading()};
}

template <typename Repeated>
void PointsToProto(const std::vector<sim::Vec2>& points, Repeated& message) {
  message.Reserve(static_cast<int>(2 * points.size()));
  for (const sim::Vec2& point : points) {
    message.Add(point.x());
    message.Add(point.y());
  }
}

template <typename Repeated>
bool PointsFromProto(const Repeated& message, std::vector<sim::Vec2>& points) {
  if (message.size() % 2 != 0) return false;
  points.reserve(static_cast<std::size_t>(message.size() / 2));
  for (int i = 0; i < message.size(); i += 2) points.emplace_back(message.Get(i), message.Get(i + 1));
  return true;
}

Status TrajectoryFromProto(const v1::Trajectory& message, sim::RunResult& result) {
  const int robots = message.robots();
  const int numbers = message.states_size();
  if (robots == 0 && numbers == 0) return Ok{};  // of a run that was refused before its first tick
  if (robots < 1 || numbers % (4LL * robots) != 0) {
    return Corrupt(fmt::format("the trajectory's {} numbers do not divide among {} robots", numbers, robots));
  }
  for (int at = 0; at < numbers;) {
    std::vector<sim::RobotState>& tick = result.trajectory.emplace_back();
    tick.reserve(static_cast<std::size_t>(robots));
    for (int robot = 0; robot < robots; ++robot, at += 4) {
      tick.push_back(
          {message.states(at), message.states(at + 1), message.states(at + 2), message.states(at + 3)});
    }
  }
  return Ok{};
}

void ToProto(const sim::RunSpec& spec, v1::RunSpec& message) {
  ToProto(spec.test_case, *message.mutable_test_case());
  message.set_scenario(spec.scenario);
  for (const auto& [name, value] : spec.scenario_parameters) {
    v1::Parameter& parameter = *message.add_scenario_parameters();
    parameter.set_name(name);
    parameter.set_value(value);
  }
  message.set_controller(spec.controller);
  for (const auto& [name, value] : spec.controller_parameters) {
    v1::Parameter& parameter = *message.add_controller_parameters();
    parameter.set_name(name);
    parameter.set_value(value);
  }
  message.set_seed(spec.seed);
  message.set_record_trajectory(spec.record_trajectory);
  if (spec.physics == sim::PhysicsKind::kRelaxation) message.set_physics(v1::PHYSICS_RELAXATION);
  ToProto(spec.disturbances, message);
}

}  // namespace

std::string EncodeRunSpec(const sim::RunSpec& spec) {
  v1::RunSpec message;
  ToProto(spec, message);
  return message.SerializeAsString();
}

SeededSpecs::SeededSpecs(const sim::RunSpec& spec) : message_(std::make_unique<v1::RunSpec>()) {
  ToProto(spec, *message_);
}
SeededSpecs::~SeededSpecs() = default;

std::string SeededSpecs::Encode(std::uint64_t seed) {
  message_->set_seed(seed);
  return message_->SerializeAsString();
}

Result<sim::RunSpec> DecodeRunSpec(std::string_view bytes) {
  const google::protobuf::LogSilencer silencer;  // the error says enough
  v1::RunSpec message;
  if (!message.ParseFromArray(bytes.data(), static_cast<int>(bytes.size()))) {
    return Corrupt(fmt::format("the {} bytes of the run spec do not parse", bytes.size()));
  }
  sim::RunSpec spec;
  Result<sim::TestCase> test_case = FromProto(message.test_case());
  if (!test_case) return Corrupt("the run spec's " + test_case.error().message);
  spec.test_case = std::move(*test_case);
  spec.scenario = message.scenario();
  for (const v1::Parameter& parameter : message.scenario_parameters()) {
    spec.scenario_parameters[parameter.name()] = parameter.value();
  }
  spec.controller = message.controller();
  for (const v1::Parameter& parameter : message.controller_parameters()) {
    spec.controller_parameters[parameter.name()] = parameter.value();
  }
  spec.seed = message.seed();
  spec.record_trajectory = message.record_trajectory();
  if (message.physics() == v1::PHYSICS_RELAXATION) spec.physics = sim::PhysicsKind::kRelaxation;
  if (Status read = FromProto(message, spec.disturbances); !read) return read.error();
  return spec;
}

std::string EncodeRunResult(const sim::RunResult& result) {
  v1::RunResult message;
  message.set_verdict(static_cast<v1::Verdict>(result.verdict));
  message.set_message(result.message);
  message.set_fitness(result.fitness);
  for (const auto& [name, value] : result.metrics) {
    v1::Metric& metric = *message.add_metrics();
    metric.set_name(name);
    metric.set_value(value);
  }
  message.mutable_failure()->set_total(result.failure.total);
  message.mutable_failure()->set_type(result.failure.type);
  message.mutable_failure()->set_label(result.failure.label);
  message.set_ticks(result.ticks);
  for (const sim::RobotSummary& robot : result.robots) {
    v1::RobotSummary& summary = *message.add_robots();
    ToProto(robot.start, *summary.mutable_start());
    ToProto(robot.end, *summary.mutable_end());
    summary.set_path_length(robot.path_length);
    summary.set_lost(robot.lost);
    PointsToProto(robot.waypoints, *summary.mutable_waypoints());
  }
  for (const sim::Annotation& annotation : result.annotations) {
    v1::Annotation& mark = *message.add_annotations();
    mark.set_kind(annotation.kind);
    mark.set_label(annotation.label);
    PointsToProto(annotation.points, *mark.mutable_points());
    mark.set_radius(annotation.radius);
    mark.set_tick(annotation.tick);
    mark.mutable_robots()->Add(annotation.robots.begin(), annotation.robots.end());
  }
  message.set_trajectory_hash(result.trajectory_hash);
  message.set_hash(result.hash);
  if (!result.trajectory.empty()) {
    v1::Trajectory& trajectory = *message.mutable_trajectory();
    trajectory.set_robots(static_cast<int>(result.trajectory.front().size()));
    for (const std::vector<sim::RobotState>& tick : result.trajectory) {
      for (const sim::RobotState& state : tick) {
        for (const double number : {state.x, state.y, state.heading, state.speed}) {
          trajectory.add_states(number);
        }
      }
    }
  }
  message.set_cpu_seconds(result.cpu_seconds);
  return message.SerializeAsString();
}

Result<sim::RunResult> DecodeRunResult(std::string_view bytes) {
  const google::protobuf::LogSilencer silencer;  // the error says enough
  v1::RunResult message;
  if (!message.ParseFromArray(bytes.data(), static_cast<int>(bytes.size()))) {
    return Corrupt(fmt::format("the {} bytes of the run result do not parse", bytes.size()));
  }
  if (!v1::Verdict_IsValid(message.verdict()) || message.verdict() == v1::VERDICT_UNSPECIFIED) {
    return Corrupt(
        fmt::format("the run result has the unknown verdict {}", static_cast<int>(message.verdict())));
  }
  sim::RunResult result;
  result.verdict = static_cast<sim::Verdict>(message.verdict());
  result.message = message.message();
  result.fitness = message.fitness();
  result.metrics.reserve(static_cast<std::size_t>(message.metrics_size()));
  for (const v1::Metric& metric : message.metrics())
    result.metrics.emplace_back(metric.name(), metric.value());
  result.failure = {message.failure().total(), message.failure().type(), message.failure().label()};
  result.ticks = message.ticks();
  result.robots.reserve(static_cast<std::size_t>(message.robots_size()));
  for (const v1::RobotSummary& summary : message.robots()) {
    sim::RobotSummary& robot = result.robots.emplace_back();
    robot.start = FromProto(summary.start());
    robot.end = FromProto(summary.end());
    robot.path_length = summary.path_length();
    robot.lost = summary.lost();
    if (!PointsFromProto(summary.waypoints(), robot.waypoints)) {
      return Corrupt("a robot of the run result has half a waypoint");
    }
  }
  for (const v1::Annotation& mark : message.annotations()) {
    sim::Annotation& annotation = result.annotations.emplace_back();
    annotation.kind = mark.kind();
    annotation.label = mark.label();
    if (!PointsFromProto(mark.points(), annotation.points)) {
      return Corrupt("an annotation of the run result has half a point");
    }
    annotation.radius = mark.radius();
    annotation.tick = mark.tick();
    annotation.robots.assign(mark.robots().begin(), mark.robots().end());
  }
  result.trajectory_hash = message.trajectory_hash();
  result.hash = message.hash();
  if (message.has_trajectory()) {
    if (Status read = TrajectoryFromProto(message.trajectory(), result); !read) return read.error();
  }
  result.cpu_seconds = message.cpu_seconds();
  if (const std::uint64_t hash = sim::HashOf(result); hash != result.hash) {
    return Corrupt(
        fmt::format("the run result's hash is {:016x}, its content's hash is {:016x}", result.hash, hash));
  }
  return result;
}

Result<sim::TestCase> ParseCaseJson(const std::string& text, const std::string& file_name) {
  Result<JsonValue> json = ParseJson(text, file_name);
  if (!json) return json.error();
  v1::TestCase message;
  if (Status filled = FillMessage(*json, file_name, message); !filled) return filled.error();
  Result<sim::TestCase> test_case = FromProto(message);
  if (!test_case) return InvalidInput(file_name + ": " + test_case.error().message);
  return test_case;
}

std::string WriteCaseJson(const sim::TestCase& test_case) {
  v1::TestCase message;
  ToProto(test_case, message);
  google::protobuf::util::JsonPrintOptions options;
  options.add_whitespace = true;
  options.always_print_primitive_fields = true;  // an obstacle at x = 0 says so
  options.preserve_proto_field_names = true;     // as the schema writes them
  std::string text;
  const auto status = google::protobuf::util::MessageToJsonString(message, &text, options);
  GAUNTLET_CHECK(status.ok(), "a test case does not print as JSON: " + status.ToString());
  return text;
}

}  // namespace gauntlet::master
