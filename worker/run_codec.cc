#include "worker/run_codec.h"

#include <fmt/format.h>
#include <google/protobuf/arena.h>
#include <google/protobuf/stubs/logging.h>
#include <google/protobuf/unknown_field_set.h>

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>

#include "base/utf8.h"
#include "proto/run.pb.h"

namespace gauntlet::worker {
namespace {

namespace v1 = gauntlet::v1;

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

// What makes an obstacle move or shine.
void ReadExtras(const v1::Obstacle& wire, sim::ObstacleGene& gene, SpecReader& reader) {
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
  reader.Require(light.has_value(), fmt::format("an obstacle's light is '{}', no colour", wire.light()));
  gene.light = light.value_or(sim::Color::kBlack);
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
  reader.RequireAtMost(wire.obstacles(), kMaxObstacles, "obstacles");
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
    ReadExtras(obstacle, gene, reader);
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

void WritePose(const sim::Pose& pose, v1::Pose& wire) {
  wire.set_x(pose.position.x());
  wire.set_y(pose.position.y());
  wire.set_heading(pose.heading);
}

template <typename List>
void WritePoints(const std::vector<sim::Vec2>& points, List& wire) {
  wire.Reserve(static_cast<int>(2 * points.size()));
  for (const sim::Vec2& point : points) {
    wire.Add(point.x());
    wire.Add(point.y());
  }
}

const std::string& Utf8(const std::string& text) {
  GAUNTLET_CHECK(IsUtf8(text), fmt::format("a run result holds text that is not UTF-8: {}", ToUtf8(text)));
  return text;
}

void WriteTrajectory(const sim::RunResult& result, v1::Trajectory& wire) {
  if (result.trajectory.empty()) return;
  const std::size_t robots = result.trajectory.front().size();
  wire.set_robots(static_cast<int>(robots));
  wire.mutable_states()->Reserve(static_cast<int>(4 * robots * result.trajectory.size()));
  for (const auto& tick : result.trajectory) {
    GAUNTLET_CHECK(tick.size() == robots, "every tick of a trajectory holds every robot");
    for (const sim::RobotState& state : tick) {
      wire.add_states(state.x);
      wire.add_states(state.y);
      wire.add_states(state.heading);
      wire.add_states(state.speed);
    }
  }
}

}  // namespace

Result<sim::RunSpec> DecodeRunSpec(std::string_view bytes) {
  const google::protobuf::LogSilencer silencer;  // the error says enough
  alignas(std::max_align_t) std::array<char, kUsualSpecMemory> memory;
  google::protobuf::ArenaOptions in_memory;
  in_memory.initial_block = memory.data();
  in_memory.initial_block_size = memory.size();
  google::protobuf::Arena arena(in_memory);
  v1::RunSpec& wire = *google::protobuf::Arena::CreateMessage<v1::RunSpec>(&arena);
  if (bytes.size() > INT32_MAX || !wire.ParseFromArray(bytes.data(), static_cast<int>(bytes.size()))) {
    return InvalidInput(fmt::format("spec: {} bytes that are no RunSpec", bytes.size()));
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
  if (wire.physics() == v1::PHYSICS_RELAXATION) spec.physics = sim::PhysicsKind::kRelaxation;
  spec.disturbances = ReadDisturbances(wire, reader);
  if (!reader.ok()) return InvalidInput("spec: " + reader.error());
  return spec;
}

std::string DescribeResult(std::string_view encoded) {
  v1::RunResult wire;
  if (!wire.ParseFromArray(encoded.data(), static_cast<int>(encoded.size())))
    return "gave no readable result";
  if (wire.verdict() == v1::VERDICT_REFUSED) return "was refused: " + wire.message();
  return fmt::format("completed: fitness {}, hash {:016x}", wire.fitness(), wire.hash());
}

std::string EncodeRunResult(const sim::RunResult& result, TrajectoryEncoding trajectory) {
  v1::RunResult wire;
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
    WritePose(summary.start, *robot.mutable_start());
    WritePose(summary.end, *robot.mutable_end());
    robot.set_path_length(summary.path_length);
    robot.set_lost(summary.lost);
    WritePoints(summary.waypoints, *robot.mutable_waypoints());
  }
  for (const sim::Annotation& annotation : result.annotations) {
    v1::Annotation& mark = *wire.add_annotations();
    mark.set_kind(Utf8(annotation.kind));
    mark.set_label(Utf8(annotation.label));
    WritePoints(annotation.points, *mark.mutable_points());
    mark.set_radius(annotation.radius);
    mark.set_tick(annotation.tick);
    mark.mutable_robots()->Add(annotation.robots.begin(), annotation.robots.end());
  }
  wire.set_trajectory_hash(result.trajectory_hash);
  wire.set_hash(result.hash);
  if (trajectory == TrajectoryEncoding::kInclude) WriteTrajectory(result, *wire.mutable_trajectory());
  wire.set_cpu_seconds(result.cpu_seconds);
  return wire.SerializeAsString();
}

}  // namespace gauntlet::worker
