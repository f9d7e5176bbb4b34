// A scenario in which robots carry items from a source of food to a nest: the place, the items, and what is
// recorded of the robots. Foraging and task partitioning are two.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "controllers/behaviour.h"
#include "controllers/common/food_source.h"
#include "controllers/common/nest_and_food.h"
#include "controllers/common/state_log.h"
#include "sim/scenario.h"

namespace gauntlet::controllers {

class NestAndFoodScenario : public sim::Scenario {
 public:
  const sim::Arena& arena() const override { return arena_; }
  sim::Tick tick_limit() const override { return site_.tick_limit; }
  double FloorGrey(const sim::Vec2& point) const override { return InNest(point) ? 0.0 : 1.0; }
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
  ControllerFactory controller_;
  FoodSource source_;
  FoodCount items_;
  StateLog states_;

 private:
  std::vector<sim::Tick> last_at_rest_;  // per robot, -1 = never
  std::vector<std::uint8_t> carrying_;   // per robot
};

}  // namespace gauntlet::controllers
