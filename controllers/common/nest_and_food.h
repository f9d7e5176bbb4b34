// What scenarios share in which robots carry items from a source of food to a nest (thesis chapters 5 and 6).
#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "base/result.h"
#include "sim/arena/validity.h"
#include "sim/robot/controller.h"
#include "sim/run_spec.h"

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
};

sim::Vec2 NestOf(const NestAndFood& settings);
sim::Vec2 FoodOf(const NestAndFood& settings);

// A way from the nest to the food, and their clearance.
sim::ArenaRequirements RequirementsOf(const NestAndFood& settings);

// Whether a robot stands in the nest: all places that its ground sensor looks at are dark, so the centre
// between them is nest, because a disc is convex.
bool StandsInNest(const sim::SensorReadings& readings);

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

}  // namespace gauntlet::controllers
