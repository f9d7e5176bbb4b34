// Scenarios in which robots carry items from a source of food to a nest (thesis chapters 5 and 6): the place,
// the items, and what is recorded of the robots. Foraging and task partitioning are two.
#pragma once

#include <cmath>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "base/result.h"
#include "controllers/behaviour.h"
#include "controllers/common/state_log.h"
#include "sim/arena/validity.h"
#include "sim/scenario.h"

namespace gauntlet::controllers {

struct NestAndFood {
  int robots = 0;
  sim::Tick tick_limit = 0;
  double nest_radius = 0.0;          // m
  double food_radius = 0.0;          // m; for pictures, and part of the pick-up distance
  double nest_food_distance = 0.0;   // m between the centres, which lie on the y axis, the nest below
  double spawn_radius = 0.0;         // m, of the discs where robots begin
  double clearance = 0.0;            // m kept free of obstacles around the centres
  double camera_range = 0.0;         // m, half side of the square in which a robot sees food and items
  double communication_range = 0.0;  // m, of range-and-bearing
  double pickup_distance = 0.0;      // m from the food's centre to a robot's
  sim::Tick pickup = 0;              // a robot stops at the food for this long
  sim::Tick serving_interval = 0;    // from one item to the next
  sim::Tick trapped_window = 0;      // a robot is trapped when it kept within trapped_radius for this long
  double trapped_radius = 0.0;       // m around its mean position

  sim::Vec2 Nest() const { return {0.0, -nest_food_distance / 2.0}; }
  sim::Vec2 Food() const { return {0.0, nest_food_distance / 2.0}; }
  // A way from the nest to the food, and their clearance.
  sim::ArenaRequirements Requirements(const sim::TestCase& /*test_case*/) const {
    return {.start = Nest(), .goal = Food(), .clearance = clearance};
  }
};

// Whether a robot stands in the nest: all places that its ground sensor looks at are dark, so the centre
// between them is nest, because a disc is convex.
bool StandsInNest(const sim::SensorReadings& readings);

// A place that hands out items and never runs out: one item per interval, to one robot after the other in the
// order of their arrival (thesis 5.4.1 "one food resource, which never runs out").
class FoodSource {
 public:
  explicit FoodSource(const NestAndFood& site);

  // One tick. Robots within reach whose closed gripper is empty wait in a queue; one that leaves loses its
  // place. Gives at most one item; to whom, if anyone.
  std::optional<sim::RobotIndex> Serve(sim::Tick tick, std::span<const sim::RobotState> robots,
                                       sim::Grippers& grippers);
  bool Waits(sim::RobotIndex robot) const;

 private:
  struct Customer {
    sim::RobotIndex robot;
    sim::Tick arrival;
  };
  bool Demands(sim::RobotIndex robot, std::span<const sim::RobotState> robots,
               const sim::Grippers& grippers) const;

  NestAndFood site_;
  std::vector<Customer> queue_;
  sim::Tick next_item_ = 0;
};

// Items of a run. Allocates in Begin only.
class FoodCount {
 public:
  void Begin(sim::Tick tick_limit);
  void Take() { ++taken_; }
  void Drop(sim::Tick tick, bool in_nest);

  // In the nest.
  int dropped() const { return dropped_; }
  // food_taken, food_carried, food_lost and first_item_time, s, -1 when there was none.
  std::vector<std::pair<std::string, double>> Metrics(int carried) const;
  // food_window_1 and on: items dropped in the nest in each 120 s (thesis 6.4.2).
  void AddWindows(std::vector<std::pair<std::string, double>>& metrics) const;

  static std::size_t WindowOf(sim::Tick tick);
  static std::size_t Windows(sim::Tick tick_limit) { return WindowOf(tick_limit) + 1; }

 private:
  std::vector<int> dropped_in_window_;
  int taken_ = 0;
  int dropped_ = 0;
  int lost_ = 0;
  sim::Tick first_item_ = -1;
};

// Of a robot that kept to one place: the tick from which on it was never farther than `radius` from the mean
// of its positions in the last `window` ticks.
sim::Tick StillSince(const sim::Observer& observer, sim::RobotIndex robot, sim::Tick window, double radius);

// median_x, median_y, spread_x and spread_y: median and standard deviation, m, over robots and seconds.
void AddWhereabouts(const sim::Observer& observer, std::vector<std::pair<std::string, double>>& metrics);

class NestAndFoodScenario : public sim::Scenario {
 public:
  const sim::Arena& arena() const override { return arena_; }
  sim::Tick tick_limit() const override { return site_.tick_limit; }
  double FloorGrey(const sim::Vec2& point) const override { return InNest(point) ? 0.0 : 1.0; }
  double FloorHolds(const sim::Vec2& point) const override {
    return std::abs(std::sqrt((point - nest_).squaredNorm()) - site_.nest_radius);
  }
  std::vector<sim::GroundArea> ground_areas() const override;
  bool Finished(const sim::Observer& observer) override { return observer.last_tick() >= site_.tick_limit; }

 protected:
  using Metrics = std::vector<std::pair<std::string, double>>;

  // The test case's number of robots overrides that of `site`. `states`: what robots can be doing, by number.
  NestAndFoodScenario(const sim::TestCase& test_case, const NestAndFood& site, ControllerFactory controller,
                      std::span<const std::string_view> states);

  // Errors: "swarm-size", "nest-and-food". `food`: what the scenario calls it.
  Status CheckSite(std::string_view food) const;
  // A robot at its start, with a controller that is told what every scenario of this kind tells.
  sim::RobotSetup SetUp(const sim::Pose& pose, ControllerContext context) const;
  // At tick 0; all robots begin in `state`.
  void Begin(std::uint8_t state);

  // In every tick: opened grippers lose their items, into the nest's store there, for good elsewhere.
  void DropItems(const sim::Interaction& interaction);
  // Then the source gives at most one.
  void ServeItems(const sim::Interaction& interaction);
  // At last what a robot does. `at_rest`: by its own rules it may stand still.
  void Record(const sim::Interaction& interaction, sim::RobotIndex robot, std::uint8_t state, bool at_rest);

  // Kept to one place for the last trapped_window without being at rest at any moment of it.
  bool Trapped(const sim::Observer& observer, sim::RobotIndex robot) const;
  // Fitness, lost robots and a total failure when there is no item in the nest.
  sim::Outcome Judge(const sim::Observer& observer) const;
  Metrics ItemMetrics() const;
  // Nest and food.
  std::vector<sim::Annotation> Places() const;
  // A trapped robot, which kept to its place from `since` on.
  sim::Annotation TrappedMark(sim::RobotIndex robot, sim::Tick since) const;

  bool InNest(const sim::Vec2& point) const;

  sim::Arena arena_;
  NestAndFood site_;
  sim::Vec2 nest_;
  sim::Vec2 food_;
  std::vector<sim::Pose> start_poses_;  // that the test case gives; empty: the seed decides
  ControllerFactory controller_;
  FoodSource source_;
  FoodCount items_;
  StateLog states_;

 private:
  std::vector<sim::Tick> last_at_rest_;  // per robot, -1 = never
  std::vector<std::uint8_t> carrying_;   // per robot
};

}  // namespace gauntlet::controllers
