// Covers: controllers/common/clusters.cc
// Covers: sim/contacts.cc
#include "controllers/generic/measures.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>

#include "sim/geometry/trigonometry.h"

namespace gauntlet::controllers::generic {
namespace {

using Swarm = std::vector<sim::RobotState>;

MeasureSettings Settings(int robots) {
  return {.robots = robots,
          .goal = {2.0, 0.0},
          .goal_radius = 0.5,
          .link_range = 0.6,
          .trapped_window = 10,
          .trapped_radius = 0.05};
}

// A run whose robots are at `where` in each of its ticks.
class Watched {
 public:
  Watched(const sim::TestCase& test_case, const std::vector<Swarm>& where)
      : arena_(test_case),
        observer_(static_cast<int>(where.front().size()), static_cast<sim::Tick>(where.size())),
        measures_(arena_, Settings(static_cast<int>(where.front().size()))) {
    for (const Swarm& swarm : where) {
      observer_.Record(swarm);
      if (observer_.last_tick() > 0) measures_.Add(observer_);
    }
    values_ = measures_.Values(observer_, {.taken = 5, .brought = 3, .first = 25}, -1);
  }

  double operator[](std::string_view name) const {
    const auto found = std::ranges::find(Metrics(), name, &MetricInfo::name);
    EXPECT_NE(found, Metrics().end()) << name;
    return values_.at(static_cast<std::size_t>(found - Metrics().begin()));
  }

 private:
  sim::Arena arena_;
  sim::Observer observer_;
  Measures measures_;
  std::vector<double> values_;
};

TEST(Measures, TellOfTheEndAndOfAllSeconds) {
  // One robot, 0.1 m further in each tick, for two seconds: 1 m from the goal at the first, in it at the
  // second.
  std::vector<Swarm> where;
  for (int tick = 0; tick <= 20; ++tick)
    where.push_back({{.x = 0.1 * tick, .y = 0.0, .heading = 0.0, .speed = tick == 0 ? 0.0 : 1.0}});
  const Watched run(sim::TestCase{}, where);
  EXPECT_NEAR(run["center_x"], 2.0, 1e-12);
  EXPECT_NEAR(run["center_x_min"], 1.0, 1e-12);
  EXPECT_NEAR(run["goal_distance"], 0.0, 1e-12);
  EXPECT_NEAR(run["goal_distance_mean"], 0.5, 1e-12);
  EXPECT_NEAR(run["goal_distance_max"], 1.0, 1e-12);
  EXPECT_EQ(run["robots_in_goal"], 1.0);
  EXPECT_EQ(run["robots_in_goal_min"], 0.0);
  EXPECT_NEAR(run["displacement"], 2.0, 1e-12);
  EXPECT_NEAR(run["path_length"], 2.0, 1e-12);
  EXPECT_EQ(run["covered_area"], 9 * 0.0625);  // from x = 0 to x = 2, in squares of 0.25 m
  EXPECT_EQ(run["order"], 1.0);
  EXPECT_EQ(run["items_taken"], 5.0);
  EXPECT_EQ(run["items_brought"], 3.0);
  EXPECT_EQ(run["first_item_time"], 2.5);
  EXPECT_EQ(run["reached_time"], kNotMeasured);
}

TEST(Measures, CountClustersThatSeeEachOther) {
  const Swarm three = {{.x = -0.5, .y = 0.0, .heading = 0.0},
                       {.x = 0.0, .y = 0.0, .heading = sim::kPi},
                       {.x = 0.5, .y = 0.0, .heading = sim::kPi / 2.0}};
  const std::vector<Swarm> where(11, three);
  const Watched open(sim::TestCase{}, where);
  EXPECT_EQ(open["largest_cluster"], 3.0);
  EXPECT_EQ(open["clusters"], 1.0);
  EXPECT_NEAR(open["center_x"], 0.0, 1e-12);
  EXPECT_NEAR(open["dispersion"], 1.0 / 3.0, 1e-12);
  EXPECT_NEAR(open["order"], 1.0 / 3.0, 1e-9);  // two cancel out

  sim::TestCase wall;
  wall.obstacles = {{0.25, 0.0, 0.1, 1.0, 0.0}};
  const Watched apart(wall, where);
  EXPECT_EQ(apart["largest_cluster"], 2.0);
  EXPECT_EQ(apart["clusters"], 2.0);
}

TEST(Measures, CountContactsThatBegin) {
  constexpr double kFar = 0.3;
  constexpr double kTouch = 2.0 * sim::foot_bot::kRadius;
  std::vector<Swarm> where;
  for (const double distance : {kTouch, kTouch, kFar, kTouch, kTouch, kFar, kTouch, kFar, kFar, kFar, kFar})
    where.push_back({{.x = 0.0, .y = 0.0}, {.x = distance, .y = 0.0}});
  EXPECT_EQ(Watched(sim::TestCase{}, where)["collisions"], 2.0);

  // Against the wall at x = 2.95, once.
  where.clear();
  for (int tick = 0; tick <= 10; ++tick) where.push_back({{.x = tick < 5 ? 2.8 : 2.865, .y = 0.0}});
  EXPECT_EQ(Watched(sim::TestCase{}, where)["collisions"], 1.0);
}

TEST(Measures, CallTrappedWhoKeptToAPlace) {
  std::vector<Swarm> where;
  for (int tick = 0; tick <= 20; ++tick)
    where.push_back({{.x = tick < 8 ? 0.1 * tick : 0.8, .y = 0.0}, {.x = -0.1 * tick, .y = 0.0}});
  EXPECT_EQ(Watched(sim::TestCase{}, where)["trapped"], 1.0);
}

}  // namespace
}  // namespace gauntlet::controllers::generic
