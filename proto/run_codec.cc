#include "proto/run_codec.h"

#include <fmt/format.h>
#include <google/protobuf/arena.h>
#include <google/protobuf/stubs/logging.h>
#include <google/protobuf/unknown_field_set.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <utility>

#include "base/system/sha256.h"
#include "base/utf8.h"
#include "proto/run.pb.h"
#include "sim/arena/validity.h"

namespace gauntlet::proto {
namespace {

Error Corrupt(std::string what) {
  return {ErrorKind::kCorrupt, std::move(what)};
}

// --- Writing ---

void ToProto(const sim::Pose& pose, v1::Pose& message) {
  message.set_x(pose.position.x());
  message.set_y(pose.position.y());
  message.set_heading(pose.heading);
}

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
  for (const sim::Pose& pose : test_case.start_poses) ToProto(pose, *message.add_start_poses());
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

template <typename Repeated>
void PointsToProto(const std::vector<sim::Vec2>& points, Repeated& message) {
  message.Reserve(static_cast<int>(2 * points.size()));
  for (const sim::Vec2& point : points) {
    message.Add(point.x());
    message.Add(point.y());
  }
}

template <typename Repeated>
void ToProto(const sim::Parameters& parameters, Repeated& message) {
  for (const auto& [name, value] : parameters) {
    v1::Parameter& parameter = *message.Add();
    parameter.set_name(name);
    parameter.set_value(value);
  }
}

void ToProto(const sim::RunSpec& spec, v1::RunSpec& message) {
  ToProto(spec.test_case, *message.mutable_test_case());
  message.set_scenario(spec.scenario);
  ToProto(spec.scenario_parameters, *message.mutable_scenario_parameters());
  message.set_controller(spec.controller);
  ToProto(spec.controller_parameters, *message.mutable_controller_parameters());
  message.set_seed(spec.seed);
  message.set_record_trajectory(spec.record_trajectory);
  if (spec.physics == sim::PhysicsKind::kRelaxation) message.set_physics(v1::PHYSICS_RELAXATION);
  if (spec.physics == sim::PhysicsKind::kImpulse) message.set_physics(v1::PHYSICS_IMPULSE);
  ToProto(spec.disturbances, message);
  message.set_plugin(spec.plugin);
  message.set_definition(spec.definition);
  message.set_scenario_plugin(spec.scenario_plugin);
}

const std::string& Utf8(const std::string& text) {
  GAUNTLET_CHECK(IsUtf8(text), fmt::format("a run result holds text that is not UTF-8: {}", ToUtf8(text)));
  return text;
}

void TrajectoryToProto(const sim::RunResult& result, v1::Trajectory& message) {
  const std::size_t robots = result.trajectory.front().size();
  message.set_robots(static_cast<int>(robots));
  message.mutable_states()->Reserve(static_cast<int>(4 * robots * result.trajectory.size()));
  for (const std::vector<sim::RobotState>& tick : result.trajectory) {
    GAUNTLET_CHECK(tick.size() == robots, "every tick of a trajectory holds every robot");
    for (const sim::RobotState& state : tick) {
      for (const double number : {state.x, state.y, state.heading, state.speed}) message.add_states(number);
    }
  }
}

// --- Reading specs ---

// A decoded spec of today's scenarios takes half of it; what does not fit is allocated.
constexpr std::size_t kUsualSpecMemory = 16 * 1024;

// The first complaint about a spec wins; later ones are not computed.
class SpecReader {
 public:
  bool ok() const { return error_.empty(); }
  const std::string& error() const { return error_; }

  void Require(bool condition, const std::string& complaint) {
    if (ok() && !condition) error_ = complaint;
  }
  double Finite(double value, const char* name) {
    if (ok() && !std::isfinite(value))
      error_ = fmt::format("{} is {}, a finite number is needed", name, value);
    return value;
  }
  template <typename Message>
  void RequireKnownFields(const Message& message, const char* name) {
    static const auto* const reflection = Message::default_instance().GetReflection();
    if (ok() && !reflection->GetUnknownFields(message).empty()) {
      error_ = fmt::format("{} has fields that this version does not know", name);
    }
  }
  template <typename List>
  void RequireAtMost(const List& list, int limit, const char* name) {
    if (ok() && list.size() > limit) {
      error_ = fmt::format("{} {}, {} are possible", list.size(), name, limit);
    }
  }
  const std::string& Name(const std::string& name, const char* what) {
    if (ok() && name.size() > kMaxNameBytes) {
      error_ = fmt::format("{} of {} bytes, {} are possible", what, name.size(), kMaxNameBytes);
    }
    return name;
  }

 private:
  std::string error_;
};

// What makes an obstacle move or shine. `number` counts obstacles from 1.
void ReadExtras(const v1::Obstacle& wire, std::size_t number, sim::ObstacleGene& gene, SpecReader& reader) {
  reader.RequireKnownFields(wire.motion(), "motion");
  gene.speed = reader.Finite(wire.motion().speed(), "an obstacle's speed");
  reader.RequireAtMost(wire.motion().path(), static_cast<int>(sim::kMaxObstaclePath), "points of a path");
  if (!reader.ok()) return;
  for (const v1::Point& point : wire.motion().path()) {
    reader.RequireKnownFields(point, "point");
    const double x = reader.Finite(point.x(), "x of a path");
    gene.path.emplace_back(x, reader.Finite(point.y(), "y of a path"));
  }
  if (!wire.has_light()) return;
  const std::optional<sim::Color> light = sim::ColorNamed(wire.light());
  gene.light = light.value_or(sim::Color::kBlack);
  if (light) return;
  reader.Require(false, fmt::format("obstacle {}: '{}' is no colour of lights; known: {}", number,
                                    wire.light(), fmt::join(sim::kColorNames, ", ")));
}

sim::TestCase ReadTestCase(const v1::TestCase& wire, SpecReader& reader) {
  sim::TestCase test_case;
  reader.RequireKnownFields(wire, "test_case");
  test_case.name = reader.Name(wire.name(), "a test case's name");
  if (wire.has_side_x()) test_case.side_x = reader.Finite(wire.side_x(), "side_x");
  if (wire.has_side_y()) test_case.side_y = reader.Finite(wire.side_y(), "side_y");
  if (wire.has_wall_thickness()) {
    test_case.wall_thickness = reader.Finite(wire.wall_thickness(), "wall_thickness");
  }
  reader.RequireAtMost(wire.obstacles(), static_cast<int>(sim::kMaxObstacles), "obstacles");
  if (!reader.ok()) return test_case;
  test_case.obstacles.reserve(static_cast<std::size_t>(wire.obstacles_size()));
  for (const v1::Obstacle& obstacle : wire.obstacles()) {
    reader.RequireKnownFields(obstacle, "obstacle");
    sim::ObstacleGene& gene = test_case.obstacles.emplace_back(sim::ObstacleGene{
        .x = reader.Finite(obstacle.x(), "an obstacle's x"),
        .y = reader.Finite(obstacle.y(), "an obstacle's y"),
        .length = reader.Finite(obstacle.length(), "an obstacle's length"),
        .width = reader.Finite(obstacle.width(), "an obstacle's width"),
        .orientation_deg = reader.Finite(obstacle.orientation_deg(), "an obstacle's orientation_deg")});
    ReadExtras(obstacle, test_case.obstacles.size(), gene, reader);
  }
  if (wire.has_spawn_area()) {
    const v1::Rectangle& area = wire.spawn_area();
    reader.RequireKnownFields(area, "spawn_area");
    test_case.spawn_area = sim::Rectangle{.min = {reader.Finite(area.min_x(), "spawn_area.min_x"),
                                                  reader.Finite(area.min_y(), "spawn_area.min_y")},
                                          .max = {reader.Finite(area.max_x(), "spawn_area.max_x"),
                                                  reader.Finite(area.max_y(), "spawn_area.max_y")}};
  }
  if (wire.has_robots()) test_case.robots = wire.robots();
  reader.RequireAtMost(wire.start_poses(), sim::kMaxRobots, "start poses");
  if (!reader.ok()) return test_case;
  for (const v1::Pose& pose : wire.start_poses()) {
    reader.RequireKnownFields(pose, "start_pose");
    test_case.start_poses.push_back(
        {{reader.Finite(pose.x(), "start_poses.x"), reader.Finite(pose.y(), "start_poses.y")},
         reader.Finite(pose.heading(), "start_poses.heading")});
  }
  return test_case;
}

template <typename List>
sim::Parameters ReadParameters(const List& wire, const char* owner, SpecReader& reader) {
  sim::Parameters parameters;
  reader.RequireAtMost(wire, kMaxParameters, "parameters");
  for (const v1::Parameter& parameter : wire) {
    if (!reader.ok()) break;
    reader.RequireKnownFields(parameter, "parameter");
    const std::string& name = reader.Name(parameter.name(), "a parameter's name");
    reader.Finite(parameter.value(), name.c_str());
    const std::size_t before = parameters.size();
    parameters.emplace_hint(parameters.end(), name, parameter.value());  // they come in order
    if (reader.ok() && parameters.size() == before) {
      reader.Require(false, fmt::format("{} parameter '{}' is given twice", owner, name));
    }
  }
  return parameters;
}

sim::PhysicsKind PhysicsOf(v1::Physics wire) {
  if (wire == v1::PHYSICS_RELAXATION) return sim::PhysicsKind::kRelaxation;
  if (wire == v1::PHYSICS_IMPULSE) return sim::PhysicsKind::kImpulse;
  return sim::PhysicsKind::kBox2d;
}

sim::Disturbances ReadDisturbances(const v1::RunSpec& wire, SpecReader& reader) {
  sim::Disturbances disturbances;
  for (const v1::DeviceNoise& noise : wire.noise()) {
    reader.RequireKnownFields(noise, "noise");
    const std::optional<sim::Device> device = sim::DeviceOfKey(noise.device());
    reader.Require(device.has_value(), fmt::format("noise of '{}', which is no device", noise.device()));
    if (!reader.ok()) return disturbances;
    const bool first =
        disturbances.noise
            .emplace(*device, sim::DeviceNoise{reader.Finite(noise.uniform(), "uniform noise"),
                                               reader.Finite(noise.gaussian(), "Gaussian noise"),
                                               reader.Finite(noise.drop(), "a drop probability")})
            .second;
    reader.Require(first, fmt::format("noise of {} is given twice", noise.device()));
  }
  reader.RequireAtMost(wire.faults(), kMaxFaults, "faults");
  if (!reader.ok()) return disturbances;
  for (const v1::RobotFault& fault : wire.faults()) {
    reader.RequireKnownFields(fault, "fault");
    const std::optional<sim::Device> device = sim::DeviceOfKey(fault.device());
    reader.Require(device || fault.device().empty(),
                   fmt::format("a fault of '{}', which is no device", fault.device()));
    disturbances.faults.push_back({.robot = fault.robot(), .device = device, .tick = fault.tick()});
  }
  return disturbances;
}

// --- Reading results ---

sim::Pose FromProto(const v1::Pose& message) {
  return {{message.x(), message.y()}, message.heading()};
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

enum class Ways { kLeaveOut, kInclude };

bool HasWays(const sim::RunResult& result) {
  return !result.annotations.empty() ||
         std::ranges::any_of(result.robots, [](const auto& robot) { return !robot.waypoints.empty(); });
}

// Without the trajectory; waypoints and annotations as asked for, if they are there.
void ToProto(const sim::RunResult& result, Ways ways, v1::RunResult& wire) {
  wire.set_verdict(static_cast<v1::Verdict>(result.verdict));
  wire.set_message(Utf8(result.message));
  wire.set_fitness(result.fitness);
  for (const auto& [name, value] : result.metrics) {
    v1::Metric& metric = *wire.add_metrics();
    metric.set_name(Utf8(name));
    metric.set_value(value);
  }
  wire.mutable_failure()->set_total(result.failure.total);
  wire.mutable_failure()->set_type(result.failure.type);
  wire.mutable_failure()->set_label(Utf8(result.failure.label));
  wire.set_ticks(result.ticks);
  for (const sim::RobotSummary& summary : result.robots) {
    v1::RobotSummary& robot = *wire.add_robots();
    ToProto(summary.start, *robot.mutable_start());
    ToProto(summary.end, *robot.mutable_end());
    robot.set_path_length(summary.path_length);
    robot.set_lost(summary.lost);
    if (ways == Ways::kInclude) PointsToProto(summary.waypoints, *robot.mutable_waypoints());
  }
  for (const sim::Annotation& annotation : result.annotations) {
    if (ways == Ways::kLeaveOut) break;
    v1::Annotation& mark = *wire.add_annotations();
    mark.set_kind(Utf8(annotation.kind));
    mark.set_label(Utf8(annotation.label));
    PointsToProto(annotation.points, *mark.mutable_points());
    mark.set_radius(annotation.radius);
    mark.set_tick(annotation.tick);
    mark.mutable_robots()->Add(annotation.robots.begin(), annotation.robots.end());
  }
  wire.set_trajectory_hash(result.trajectory_hash);
  wire.set_hash(result.hash);
  wire.set_cpu_seconds(result.cpu_seconds);
  if (!result.without_ways && (ways == Ways::kInclude || !HasWays(result))) return;
  wire.set_without_ways(true);
  wire.set_hash_without_ways(result.hash_without_ways);
}

enum class Trust { kGuarded, kAnyone };

// Whether the content is that of the result's hashes.
Status CheckHash(const sim::RunResult& result) {
  const std::uint64_t said = result.without_ways ? result.hash_without_ways : result.hash;
  const std::uint64_t hash = result.without_ways ? sim::HashWithoutWays(result) : sim::HashOf(result);
  if (hash == said) return Ok{};
  return Corrupt(fmt::format("the run result's hash is {:016x}, its content's hash is {:016x}", said, hash));
}

Result<sim::RunResult> Decode(std::string_view bytes, Trust trust) {
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
  result.without_ways = message.without_ways();
  result.hash_without_ways = message.hash_without_ways();
  if (result.without_ways && HasWays(result))
    return Corrupt("the run result has ways that it is said to be without");
  if (trust == Trust::kGuarded && result.without_ways) return result;
  if (const Status right = CheckHash(result); !right) return right.error();
  return result;
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
  alignas(std::max_align_t) std::array<char, kUsualSpecMemory> memory;
  google::protobuf::ArenaOptions in_memory;
  in_memory.initial_block = memory.data();
  in_memory.initial_block_size = memory.size();
  google::protobuf::Arena arena(in_memory);
  v1::RunSpec& wire = *google::protobuf::Arena::CreateMessage<v1::RunSpec>(&arena);
  if (bytes.size() > INT32_MAX || !wire.ParseFromArray(bytes.data(), static_cast<int>(bytes.size()))) {
    return Corrupt(fmt::format("{} bytes that are no RunSpec", bytes.size()));
  }
  SpecReader reader;
  reader.RequireKnownFields(wire, "spec");
  sim::RunSpec spec;
  spec.test_case = ReadTestCase(wire.test_case(), reader);
  spec.scenario = reader.Name(wire.scenario(), "a scenario's name");
  spec.scenario_parameters = ReadParameters(wire.scenario_parameters(), "scenario", reader);
  spec.controller = reader.Name(wire.controller(), "a controller's name");
  spec.controller_parameters = ReadParameters(wire.controller_parameters(), "controller", reader);
  spec.seed = wire.seed();
  spec.record_trajectory = wire.record_trajectory();
  reader.Require(v1::Physics_IsValid(wire.physics()),
                 fmt::format("physics {} is none that this version knows", static_cast<int>(wire.physics())));
  spec.physics = PhysicsOf(wire.physics());
  spec.disturbances = ReadDisturbances(wire, reader);
  spec.plugin = wire.plugin();
  spec.scenario_plugin = wire.scenario_plugin();
  for (const std::string& plugin : {spec.plugin, spec.scenario_plugin})
    reader.Require(plugin.empty() || IsSha256(plugin), "a plug-in that is named by no SHA-256");
  spec.definition = wire.definition();
  if (!reader.ok()) return Corrupt(reader.error());
  return spec;
}

std::string EncodeRunResult(const sim::RunResult& result, TrajectoryEncoding trajectory) {
  v1::RunResult wire;
  ToProto(result, Ways::kInclude, wire);
  if (trajectory == TrajectoryEncoding::kInclude && !result.trajectory.empty()) {
    TrajectoryToProto(result, *wire.mutable_trajectory());
  }
  return wire.SerializeAsString();
}

std::string EncodeWithoutWays(const sim::RunResult& result) {
  v1::RunResult wire;
  ToProto(result, Ways::kLeaveOut, wire);
  return wire.SerializeAsString();
}

Result<sim::RunResult> DecodeRunResult(std::string_view bytes) {
  return Decode(bytes, Trust::kAnyone);
}

Result<sim::RunResult> DecodeStoredResult(std::string_view bytes) {
  return Decode(bytes, Trust::kGuarded);
}
}  // namespace gauntlet::proto
