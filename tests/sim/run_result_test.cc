#include "sim/run_result.h"

#include <gtest/gtest.h>

#include <functional>
#include <set>
#include <string_view>
#include <utility>
#include <vector>

namespace gauntlet::sim {
namespace {

RunResult Example() {
  RunResult result;
  result.message = "m";
  result.fitness = 0.5;
  result.metrics = {{"a", 1.0}, {"b", 2.0}};
  result.failure = {.total = true, .type = 3, .label = "slow"};
  result.ticks = 100;
  result.robots.resize(2);
  result.robots[1].waypoints = {{1.0, 2.0}};
  result.annotations = {{.kind = "path", .label = "prey", .points = {{0.0, 1.0}}, .robots = {4}}};
  result.trajectory_hash = 77;
  return result;
}

TEST(RunResultHash, CoversEveryField) {
  const std::vector<std::pair<const char*, std::function<void(RunResult&)>>> changes = {
      {"verdict", [](RunResult& r) { r.verdict = Verdict::kHung; }},
      {"message", [](RunResult& r) { r.message = "n"; }},
      {"fitness", [](RunResult& r) { r.fitness = 0.25; }},
      {"metric name", [](RunResult& r) { r.metrics[0].first = "c"; }},
      {"metric value", [](RunResult& r) { r.metrics[1].second = 3.0; }},
      {"metrics", [](RunResult& r) { r.metrics.pop_back(); }},
      {"failure total", [](RunResult& r) { r.failure.total = false; }},
      {"failure type", [](RunResult& r) { r.failure.type = 4; }},
      {"failure label", [](RunResult& r) { r.failure.label = "fast"; }},
      {"ticks", [](RunResult& r) { r.ticks = 101; }},
      {"start", [](RunResult& r) { r.robots[0].start.position.y() = 1.0; }},
      {"end", [](RunResult& r) { r.robots[0].end.heading = 1.0; }},
      {"path length", [](RunResult& r) { r.robots[0].path_length = 1.0; }},
      {"lost", [](RunResult& r) { r.robots[1].lost = true; }},
      {"waypoint", [](RunResult& r) { r.robots[1].waypoints[0].x() = 9.0; }},
      {"robots", [](RunResult& r) { r.robots.emplace_back(); }},
      {"annotation kind", [](RunResult& r) { r.annotations[0].kind = "disc"; }},
      {"annotation label", [](RunResult& r) { r.annotations[0].label = ""; }},
      {"annotation point", [](RunResult& r) { r.annotations[0].points[0].x() = 5.0; }},
      {"annotation radius", [](RunResult& r) { r.annotations[0].radius = 0.5; }},
      {"annotation tick", [](RunResult& r) { r.annotations[0].tick = 5; }},
      {"annotation robot", [](RunResult& r) { r.annotations[0].robots[0] = 5; }},
      {"trajectory hash", [](RunResult& r) { r.trajectory_hash = 78; }},
  };
  std::set<std::uint64_t> hashes = {HashOf(Example())};
  for (const auto& [name, change] : changes) {
    RunResult changed = Example();
    change(changed);
    EXPECT_TRUE(hashes.insert(HashOf(changed)).second) << name << " is not in the hash";
    const std::string_view part = name;
    const bool of_ways = part.starts_with("waypoint") || part.starts_with("annotation");
    EXPECT_EQ(HashWithoutWays(changed) == HashWithoutWays(Example()), of_ways) << name;
  }
}

TEST(RunResultHash, LeavesOutTrajectoryAndCost) {
  RunResult changed = Example();
  changed.hash = 5;
  changed.cpu_seconds = 3.0;
  changed.trajectory.resize(7);
  EXPECT_EQ(HashOf(changed), HashOf(Example()));
}

TEST(RunResultHash, IsStable) {
  // Stored results carry this hash: a change of the encoding must be noticed.
  EXPECT_EQ(HashOf(Example()), 9689415943226554658u);
}

}  // namespace
}  // namespace gauntlet::sim
