#include "controllers/coverage/coverage_scenario.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "controllers/common/clusters.h"
#include "controllers/common/corners.h"  // CornersOf
#include "controllers/coverage/coverage_metrics.h"
#include "sim/geometry/trigonometry.h"

namespace gauntlet::controllers::coverage {
namespace {

// Chosen.
constexpr double kExploreRadius = 0.30;  // m, a robot has explored what it saw up to here
constexpr double kLinkRange = 1.5;       // m, robots nearer than this that see each other are linked
constexpr double kJamRange = 0.30;       // m, the same of robots in a jam

}  // namespace

int FailureTypeOf(int place, double hole_area, bool jam) {
  return 6 * place + (hole_area < 4.0 ? 0 : hole_area <= 8.0 ? 2 : 4) + (jam ? 1 : 0);
}

const FailureTypes& CoverageFailureTypes() {
  static const FailureTypes types = [] {
    constexpr std::array<const char*, 6> kRows = {"below 4 m^2", "below 4 m^2, a jam",
                                                  "4 to 8 m^2",  "4 to 8 m^2, a jam",
                                                  "above 8 m^2", "above 8 m^2, a jam"};
    FailureTypes all{.columns = "where the largest hole is",
                     .rows = "its area, and whether robots are jammed",
                     .untyped = "without a hole at the end"};
    for (int type = 0; type < 6 * kPlaces; ++type) {
      const std::string place(NameOfPlace(type / 6));
      const std::string row = kRows.at(static_cast<std::size_t>(type % 6));
      all.types.push_back({type, "hole " + place + ", " + row, place, row});
    }
    return all;
  }();
  return types;
}

CoverageScenario::CoverageScenario(const sim::TestCase& test_case, const CoverageScenarioSettings& settings,
                                   ControllerFactory robots, std::uint64_t seed)
    : test_case_(test_case), arena_(test_case), settings_(settings), robots_(std::move(robots)), seed_(seed) {
  const sim::Vec2& corner = arena_.interior_max();
  const sim::Vec2 size(settings.spawn_side, settings.spawn_side);
  area_ = test_case.spawn_area.value_or(sim::Rectangle{corner - size, corner});
}

Result<std::vector<sim::RobotSetup>> CoverageScenario::CreateSwarm(const sim::Headquarters&) {
  TRY(robots_.Check(arena_));
  const sim::Vec2 start = settings_.Requirements(test_case_).start;
  TRY(const auto poses, StartPoses(test_case_, settings_.robots, area_, start, seed_));
  std::vector<sim::RobotSetup> swarm;
  for (const sim::Pose& pose : poses) {
    const auto robot = static_cast<sim::RobotIndex>(swarm.size());
    swarm.push_back(
        {.pose = pose, .controller = robots_.create({.robot = robot, .seed = seed_, .start = pose})});
  }
  last_stood_.assign(swarm.size(), -1);
  return swarm;
}

void CoverageScenario::Interact(const sim::Interaction& interaction) {
  for (std::size_t robot = 0; robot < last_stood_.size(); ++robot) {
    if (interaction.signals[robot].message == kStandingMessage)
      last_stood_[robot] = interaction.observer.last_tick();
  }
}

sim::Outcome CoverageScenario::Evaluate(const sim::Observer& observer) {
  const sim::Tick last = observer.last_tick();
  const CoverageMap map(arena_, settings_.Requirements(test_case_).start);
  CellMarks explored = map.NothingSeen();
  double path_length = 0.0;
  for (sim::Tick tick = 0; tick <= last; ++tick) {
    for (const sim::RobotState& state : observer.At(tick)) path_length += state.speed * sim::kTickSeconds;
    if (tick % sim::kTicksPerSecond != 0) continue;
    map.See(PositionsAt(observer, tick), kExploreRadius, observer.ObstaclesAt(tick), explored);
  }
  CellMarks covered;
  double covered_sum = 0.0;
  const std::vector<sim::Tick> window = LastSeconds(observer, 30 * sim::kTicksPerSecond);
  for (const sim::Tick tick : window) {
    covered = map.NothingSeen();
    map.See(PositionsAt(observer, tick), settings_.coverage_radius, observer.ObstaclesAt(tick), covered);
    covered_sum += map.ShareOf(covered);
  }

  sim::Outcome outcome;
  for (sim::RobotIndex robot = 0; robot < observer.robots(); ++robot) {
    const bool stood = last_stood_[static_cast<std::size_t>(robot)] >= last - kStuckTicks;
    outcome.lost.push_back(!stood && IsStuck(observer, robot));
  }
  const std::vector<sim::Vec2> end = PositionsAt(observer, last);
  Clusters clusters;
  const auto group = [&](double range) {
    return std::ranges::max(clusters.SizesOf(end, arena_, range, observer.ObstaclesAt(last)));
  };
  const auto stuck = std::ranges::count(outcome.lost, true);
  const Hole hole = map.LargestHole(covered);
  outcome.fitness = covered_sum / static_cast<double>(window.size());
  outcome.failure.total = outcome.fitness < settings_.least_covered;
  outcome.annotations = {{"area", "start of the robots", CornersOf(area_), 0.0, -1, {}}};
  if (hole.area > 0.0) {
    const double radius = std::sqrt(hole.area / sim::kPi);
    outcome.annotations.push_back({"disc", "largest hole", {hole.centroid}, radius, last, {}});
    if (outcome.failure.total) {
      const bool jam = stuck >= 3 || group(kJamRange) >= 3;
      outcome.failure.type = FailureTypeOf(PlaceOf(hole.centroid, arena_), hole.area, jam);
      outcome.failure.label = CoverageFailureTypes().Find(outcome.failure.type)->name;
    }
  }
  outcome.metrics = {
      {"covered", outcome.fitness},
      {"explored", map.ShareOf(explored)},
      {"neighbour_distance", NearestNeighbourDistance(end)},
      {"connected_share", group(kLinkRange) / static_cast<double>(end.size())},
      {"path_length", path_length / static_cast<double>(end.size())},
      {"stuck_robots", static_cast<double>(stuck)},
      {"largest_hole", hole.area},
      {"hole_x", hole.centroid.x()},
      {"hole_y", hole.centroid.y()},
  };
  return outcome;
}

}  // namespace gauntlet::controllers::coverage
