#include "study/sets/failure_mechanism.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "search/given/given_search.h"

namespace gauntlet {
namespace {

// Of the waypoints of one robot, at least one interval.
struct Stay {
  bool stood = false;
  bool at_obstacles = false;
  bool near_start = false;
};

Stay StayOf(const sim::RobotSummary& robot, const sim::TestCase& test_case) {
  const std::vector<sim::Vec2>& waypoints = robot.waypoints;
  std::size_t stood = 0;
  double farthest = 0.0;
  for (std::size_t i = 1; i < waypoints.size(); ++i) {
    if (StaysBetween(waypoints[i - 1], waypoints[i])) ++stood;
    farthest = std::max(farthest, (waypoints[i] - waypoints.front()).norm());
  }
  std::uint64_t visits = 0;
  for (const sim::ObstacleGene& obstacle : test_case.obstacles) visits += CountVisits(robot, obstacle);
  return {.stood = 2 * stood > waypoints.size() - 1,
          .at_obstacles = 2 * visits > waypoints.size(),
          .near_start = 4.0 * farthest < std::max(test_case.side_x, test_case.side_y)};
}

}  // namespace

bool StaysBetween(const sim::Vec2& before, const sim::Vec2& after) {
  constexpr double kStays = 0.05;  // m: a robot that drives covers five times as much between two waypoints
  return (after - before).norm() < kStays;
}

std::string MechanismOf(const controllers::ScenarioInfo& scenario, const sim::TestCase& test_case,
                        controllers::MetricValues metrics, std::span<const sim::RobotSummary> robots) {
  const controllers::FailureDescriptor& declared = scenario.failures;
  if (const std::size_t kind = declared.KindOf(metrics); kind < declared.kinds.size())
    return declared.kinds[kind].what;
  const bool of_lost =
      scenario.style.lost_is_failure && std::ranges::any_of(robots, &sim::RobotSummary::lost);
  std::vector<Stay> stays;
  for (const sim::RobotSummary& robot : robots) {
    if (of_lost && !robot.lost) continue;
    if (robot.waypoints.size() < 2) return "";
    stays.push_back(StayOf(robot, test_case));
  }
  if (stays.empty()) return "";
  const auto most = [&](bool Stay::*did) {
    return 2 * std::ranges::count(stays, true, did) > static_cast<std::ptrdiff_t>(stays.size());
  };
  if (most(&Stay::stood))
    return most(&Stay::at_obstacles) ? "stood still at obstacles" : "stood still in the open";
  if (most(&Stay::near_start)) return "stayed near the start";
  return of_lost ? "lost far from the start" : "kept driving";
}

}  // namespace gauntlet
