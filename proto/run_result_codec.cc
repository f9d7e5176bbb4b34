// The half of run_codec.h that speaks of results.
#include <fmt/format.h>
#include <google/protobuf/arena.h>
#include <google/protobuf/stubs/logging.h>

#include <algorithm>

#include "base/utf8.h"
#include "proto/run.pb.h"
#include "proto/run_codec.h"
#include "proto/run_wire.h"

namespace gauntlet::proto {
namespace {

template <typename Repeated>
void PointsToProto(const std::vector<sim::Vec2>& points, Repeated& message) {
  message.Reserve(static_cast<int>(2 * points.size()));
  for (const sim::Vec2& point : points) {
    message.Add(point.x());
    message.Add(point.y());
  }
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
    PoseToProto(summary.start, *robot.mutable_start());
    PoseToProto(summary.end, *robot.mutable_end());
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
  if (result.contacts >= 0) wire.set_contacts(result.contacts);
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
  google::protobuf::Arena arena;                 // a result has some hundred parts
  v1::RunResult& message = *google::protobuf::Arena::CreateMessage<v1::RunResult>(&arena);
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
    TRY(TrajectoryFromProto(message.trajectory(), result));
  }
  result.cpu_seconds = message.cpu_seconds();
  if (message.has_contacts()) result.contacts = message.contacts();
  result.without_ways = message.without_ways();
  result.hash_without_ways = message.hash_without_ways();
  if (result.without_ways && HasWays(result))
    return Corrupt("the run result has ways that it is said to be without");
  if (trust == Trust::kGuarded && result.without_ways) return result;
  TRY(CheckHash(result));
  return result;
}

}  // namespace

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
