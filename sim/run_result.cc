#include "sim/run_result.h"

#include "base/hash.h"

namespace gauntlet::sim {
namespace {

void Encode(const Vec2& v, CanonicalEncoder& encoder) {
  encoder.Double(v.x());
  encoder.Double(v.y());
}

void Encode(const Pose& pose, CanonicalEncoder& encoder) {
  Encode(pose.position, encoder);
  encoder.Double(pose.heading);
}

void Encode(const std::vector<Vec2>& points, CanonicalEncoder& encoder) {
  encoder.Uint(points.size());
  for (const Vec2& point : points) Encode(point, encoder);
}

void Encode(const RobotSummary& robot, bool with_ways, CanonicalEncoder& encoder) {
  Encode(robot.start, encoder);
  Encode(robot.end, encoder);
  encoder.Double(robot.path_length);
  encoder.Bool(robot.lost);
  if (with_ways) Encode(robot.waypoints, encoder);
}

void Encode(const Annotation& annotation, CanonicalEncoder& encoder) {
  encoder.String(annotation.kind);
  encoder.String(annotation.label);
  Encode(annotation.points, encoder);
  encoder.Double(annotation.radius);
  encoder.Int(annotation.tick);
  encoder.Uint(annotation.robots.size());
  for (const RobotIndex robot : annotation.robots) encoder.Int(robot);
}

std::uint64_t Hash(const RunResult& result, bool with_ways) {
  CanonicalEncoder encoder;
  encoder.Int(static_cast<int>(result.verdict));
  encoder.String(result.message);
  encoder.Double(result.fitness);
  encoder.Uint(result.metrics.size());
  for (const auto& [name, value] : result.metrics) {
    encoder.String(name);
    encoder.Double(value);
  }
  encoder.Bool(result.failure.total);
  encoder.Int(result.failure.type);
  encoder.String(result.failure.label);
  encoder.Int(result.ticks);
  encoder.Uint(result.robots.size());
  for (const RobotSummary& robot : result.robots) Encode(robot, with_ways, encoder);
  if (with_ways) {
    encoder.Uint(result.annotations.size());
    for (const Annotation& annotation : result.annotations) Encode(annotation, encoder);
  }
  encoder.Uint(result.trajectory_hash);
  if (!with_ways) encoder.Uint(result.hash);

  Fnv1a64 hash;
  hash.AddBytes(encoder.bytes());
  return hash.value();
}

}  // namespace

std::uint64_t HashOf(const RunResult& result) {
  return Hash(result, /*with_ways=*/true);
}

std::uint64_t HashWithoutWays(const RunResult& result) {
  return Hash(result, /*with_ways=*/false);
}

void SetHashes(RunResult& result) {
  result.hash = HashOf(result);
  result.hash_without_ways = HashWithoutWays(result);
}

}  // namespace gauntlet::sim
