#include "controllers/aggregation/aggregation_scenario.h"

#include <algorithm>
#include <string>
#include <utility>

#include "base/check.h"
#include "controllers/common/nest_and_food.h"  // AddWhereabouts

namespace gauntlet::controllers::aggregation {
namespace {

constexpr sim::Tick kJudgedTicks = 30 * sim::kTicksPerSecond;
constexpr double kMajority = 0.5;  // fitness below it: total failure
constexpr double kGathered = 0.9;  // share of the robots in one cluster that counts as having gathered
constexpr double kLargeShare = 0.25;

// Whether a robot of one of the clusters that `at_end` tells apart is in one cluster with a robot of the
// other.
bool AreOne(const Groups& groups, const Groups& at_end) {
  std::vector<bool> has_first(groups.sizes.size(), false);
  for (std::size_t i = 0; i < groups.members.size(); ++i) {
    if (at_end.members[i] == at_end.first) has_first[static_cast<std::size_t>(groups.members[i])] = true;
  }
  for (std::size_t i = 0; i < groups.members.size(); ++i) {
    if (at_end.members[i] == at_end.second && has_first[static_cast<std::size_t>(groups.members[i])])
      return true;
  }
  return false;
}

sim::Annotation Disc(const std::string& label, const std::vector<sim::Vec2>& robots) {
  const sim::Vec2 center = Centroid(robots);
  double radius = sim::foot_bot::kRadius;
  for (const sim::Vec2& robot : robots)
    radius = std::max(radius, (robot - center).norm() + sim::foot_bot::kRadius);
  return {"disc", label, {center}, radius, -1, {}};
}

}  // namespace

int FailureTypeOf(int place, double second_share, bool in_sight) {
  return place * 4 + (second_share >= kLargeShare ? 2 : 0) + (in_sight ? 1 : 0);
}

std::string FailureDivision(int type) {
  GAUNTLET_CHECK(type >= 0 && type < kFailureTypes, "no failure type " + std::to_string(type));
  return std::string(type % 4 >= 2 ? "another large cluster" : "small clusters") +
         (type % 2 == 1 ? " in sight" : " out of sight");
}

std::string FailureLabel(int type) {
  return FailureDivision(type) + ", the largest " + std::string(NameOfPlace(type / 4));
}

AggregationScenario::AggregationScenario(const sim::TestCase& test_case,
                                         const AggregationScenarioSettings& settings,
                                         ControllerFactory robots, std::uint64_t seed)
    : test_case_(test_case),
      arena_(test_case),
      settings_(settings),
      robots_(std::move(robots)),
      seed_(seed) {}

Result<std::vector<sim::RobotSetup>> AggregationScenario::CreateSwarm(const sim::Headquarters&) {
  TRY(robots_.Check(arena_));
  const sim::Rectangle everywhere{arena_.interior_min(), arena_.interior_max()};
  TRY(const auto poses,
      StartPoses(test_case_, settings_.robots, everywhere, settings_.Requirements(test_case_).start, seed_));
  std::vector<sim::RobotSetup> swarm;
  for (const sim::Pose& pose : poses) {
    const auto robot = static_cast<sim::RobotIndex>(swarm.size());
    swarm.push_back({.pose = pose,
                     .beacon = kBeaconColor,
                     .camera_range = settings_.camera_range,
                     .controller = robots_.create({.robot = robot, .start = pose})});
  }
  return swarm;
}

Groups AggregationScenario::GroupsAt(const sim::Observer& observer, sim::Tick tick) {
  return FindGroups(clusters_, PositionsAt(observer, tick), arena_, settings_.link_range,
                    observer.ObstaclesAt(tick));
}

sim::Outcome AggregationScenario::Evaluate(const sim::Observer& observer) {
  const sim::Tick last = observer.last_tick();
  const std::vector<sim::Vec2> robots = PositionsAt(observer, last);
  const Groups at_end = GroupsAt(observer, last);
  sim::Outcome outcome;
  const auto judged = static_cast<double>(LastSeconds(observer, kJudgedTicks).size());
  double gathered = kNotMeasured;
  double apart = kNotMeasured;
  for (const sim::Tick tick : LastSeconds(observer, last)) {
    const Groups groups = GroupsAt(observer, tick);
    const double largest = groups.Share(groups.first);
    if (gathered == kNotMeasured && largest >= kGathered) gathered = tick * sim::kTickSeconds;
    if (at_end.second >= 0 && AreOne(groups, at_end)) apart = tick * sim::kTickSeconds;
    if (tick >= last - kJudgedTicks) outcome.fitness += largest / judged;
  }
  outcome.failure.total = outcome.fitness < kMajority;

  double stuck = 0.0;
  for (sim::RobotIndex robot = 0; robot < observer.robots(); ++robot) {
    const int cluster = at_end.members[static_cast<std::size_t>(robot)];
    outcome.lost.push_back(cluster != at_end.first);
    if (at_end.sizes[static_cast<std::size_t>(cluster)] == 1 && IsStuck(observer, robot)) stuck += 1.0;
  }

  const std::vector<sim::Vec2> first = at_end.Robots(at_end.first, robots);
  const sim::Vec2 place = Centroid(first);
  outcome.annotations = {Disc("largest cluster", first)};
  sim::Vec2 second_place(kNowhere, kNowhere);
  double in_sight = kNotMeasured;
  if (at_end.second >= 0) {
    const std::vector<sim::Vec2> second = at_end.Robots(at_end.second, robots);
    second_place = Centroid(second);
    in_sight = InSight(first, second, arena_, settings_.camera_range, observer.ObstaclesAt(last)) ? 1.0 : 0.0;
    outcome.annotations.push_back(Disc("second cluster", second));
  }
  if (outcome.failure.total) {
    outcome.failure.type =
        FailureTypeOf(PlaceOf(place, arena_), at_end.Share(at_end.second), in_sight == 1.0);
    outcome.failure.label = FailureLabel(outcome.failure.type);
  }
  outcome.metrics = {
      {"largest_cluster", at_end.Share(at_end.first)},
      {"second_cluster", at_end.Share(at_end.second)},
      {"clusters", static_cast<double>(at_end.sizes.size())},
      {"expected_cluster_size", ExpectedClusterSize(at_end.sizes)},
      {"dispersion", Dispersion(robots)},
      {"total_distance", TotalDistance(robots)},
      {"time_to_90", gathered},
      {"split_time", apart},
      {"clusters_in_sight", in_sight},
      {"stuck_robots", stuck},
      {"largest_x", place.x()},
      {"largest_y", place.y()},
      {"second_x", second_place.x()},
      {"second_y", second_place.y()},
  };
  AddWhereabouts(observer, outcome.metrics);
  return outcome;
}

}  // namespace gauntlet::controllers::aggregation
