// A place that hands out items and never runs out: one item per interval, to one robot after the other in the
// order of their arrival (thesis 5.4.1 "one food resource, which never runs out"). Of foraging and
// of task partitioning.
#pragma once

#include <algorithm>
#include <optional>
#include <span>
#include <vector>

#include "sim/observer.h"
#include "sim/robot/grippers.h"

namespace gauntlet::controllers {

struct FoodSourceSettings {
  sim::Vec2 position = sim::Vec2::Zero();  // m
  double reach = 0.0;                      // m from the position to a robot's centre
  sim::Tick pickup = 0;                    // a robot stands there for this long before it gets an item
  sim::Tick interval = 0;                  // from one item to the next
};

class FoodSource {
 public:
  FoodSource(const FoodSourceSettings& settings, int robots);

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

  FoodSourceSettings settings_;
  std::vector<Customer> queue_;
  sim::Tick next_item_ = 0;
};

}  // namespace gauntlet::controllers
