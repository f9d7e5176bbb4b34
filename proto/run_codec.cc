#include "proto/run_codec.h"

#include <fmt/format.h>
#include <google/protobuf/arena.h>
#include <google/protobuf/stubs/logging.h>
#include <google/protobuf/unknown_field_set.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "base/system/sha256.h"
#include "base/utf8.h"
#include "proto/run.pb.h"
#include "proto/run_wire.h"
#include "sim/arena/validity.h"

namespace gauntlet::proto {
namespace {

// --- Writing ---

void ToProto(const sim::TestCase& test_case, v1::TestCase& message) {
  message.set_name(test_case.name);
  message.set_side_x(test_case.side_x);
  message.set_side_y(test_case.side_y);
  message.set_wall_thickness(test_case.wall_thickness);
  if (test_case.center.x() != 0.0) message.set_center_x(test_case.center.x());
  if (test_case.center.y() != 0.0) message.set_center_y(test_case.center.y());
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
  for (const sim::Pose& pose : test_case.start_poses) PoseToProto(pose, *message.add_start_poses());
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
  const sim::RandomFaults& random = disturbances.random_faults;
  if (random.count == 0) return;
  v1::RandomFaults& written = *message.mutable_random_faults();
  written.set_count(random.count);
  if (random.device) written.set_device(sim::KeyOf(*random.device));
  written.set_tick(random.tick);
  written.set_also_of_scenario(random.role == sim::FaultyRole::kAll);
}

template <typename Repeated>
void ToProto(const sim::Parameters& parameters, Repeated& message) {
  for (const auto& [name, value] : parameters) {
    v1::Parameter& parameter = *message.Add();
    parameter.set_name(name);
    parameter.set_value(value);
  }
}

// The fields before the seed, and those after it: a message is written in the order of their numbers.
void HeadToProto(const sim::RunSpec& spec, v1::RunSpec& message) {
  ToProto(spec.test_case, *message.mutable_test_case());
  message.set_scenario(spec.scenario);
  ToProto(spec.scenario_parameters, *message.mutable_scenario_parameters());
  message.set_controller(spec.controller);
  ToProto(spec.controller_parameters, *message.mutable_controller_parameters());
}

void TailToProto(const sim::RunSpec& spec, v1::RunSpec& message) {
  message.set_record_trajectory(spec.record_trajectory);
  if (spec.physics == sim::PhysicsKind::kRelaxation) message.set_physics(v1::PHYSICS_RELAXATION);
  if (spec.physics == sim::PhysicsKind::kImpulse) message.set_physics(v1::PHYSICS_IMPULSE);
  ToProto(spec.disturbances, message);
  message.set_plugin(spec.plugin);
  message.set_definition(spec.definition);
  message.set_scenario_plugin(spec.scenario_plugin);
  message.set_count_contacts(spec.count_contacts);
  message.set_requirements(spec.requirements);
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
  test_case.center.x() = reader.Finite(wire.center_x(), "center_x");
  test_case.center.y() = reader.Finite(wire.center_y(), "center_y");
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

// Of a fault; nothing is the whole robot.
std::optional<sim::Device> ReadFaulty(const std::string& device, SpecReader& reader) {
  const std::optional<sim::Device> known = sim::DeviceOfKey(device);
  reader.Require(known || device.empty(), fmt::format("a fault of '{}', which is no device", device));
  return known;
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
    disturbances.faults.push_back(
        {.robot = fault.robot(), .device = ReadFaulty(fault.device(), reader), .tick = fault.tick()});
  }
  if (!wire.has_random_faults()) return disturbances;
  const v1::RandomFaults& random = wire.random_faults();
  reader.RequireKnownFields(random, "random_faults");
  disturbances.random_faults = {
      .count = random.count(),
      .device = ReadFaulty(random.device(), reader),
      .tick = random.tick(),
      .role = random.also_of_scenario() ? sim::FaultyRole::kAll : sim::FaultyRole::kTested};
  return disturbances;
}

}  // namespace

std::string EncodeRunSpec(const sim::RunSpec& spec) {
  v1::RunSpec message;
  HeadToProto(spec, message);
  message.set_seed(spec.seed);
  TailToProto(spec, message);
  return message.SerializeAsString();
}

SeededSpecs::SeededSpecs(const sim::RunSpec& spec) {
  v1::RunSpec head;
  HeadToProto(spec, head);
  head_ = head.SerializeAsString();
  v1::RunSpec tail;
  TailToProto(spec, tail);
  tail_ = tail.SerializeAsString();
}

std::string SeededSpecs::Encode(std::uint64_t seed) const {
  v1::RunSpec seeded;
  seeded.set_seed(seed);
  std::string bytes;
  bytes.reserve(head_.size() + seeded.ByteSizeLong() + tail_.size());
  bytes += head_;
  seeded.AppendToString(&bytes);
  return bytes += tail_;
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
  spec.requirements = wire.requirements();
  spec.count_contacts = wire.count_contacts();
  if (!reader.ok()) return Corrupt(reader.error());
  return spec;
}

}  // namespace gauntlet::proto
