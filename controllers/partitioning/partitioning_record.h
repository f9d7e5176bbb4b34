// What happened in a run of task partitioning, from what robots say and what the scenario moves.
#pragma once

#include <span>
#include <string>
#include <utility>
#include <vector>

#include "controllers/common/nest_and_food.h"
#include "controllers/common/state_log.h"
#include "controllers/partitioning/partition_message.h"
#include "sim/robot/signals.h"

namespace gauntlet::controllers {

// Allocates in Begin only.
class PartitioningRecord {
 public:
  struct Transfer {
    sim::Tick tick;
    sim::RobotIndex giver;
    sim::RobotIndex receiver;
    sim::Vec2 place;  // m, between the two
  };

  // Everybody begins in `state`.
  void Begin(int robots, PartitioningState state, sim::Tick tick_limit);

  // One tick: what all robots say. One that has said nothing yet is in the state it began in.
  void Hear(sim::Tick tick, std::span<const sim::Signals> signals);
  void HandOver(const Transfer& transfer);

  FoodCount& food() { return food_; }
  // Newest tick at which the robot stood by its own rules: waiting, or in a hand-over; -1 = never.
  sim::Tick last_at_rest(sim::RobotIndex robot) const {
    return robots_[static_cast<std::size_t>(robot)].at_rest;
  }
  const std::vector<Transfer>& transfers() const { return transfers_; }
  const StateLog& states() const { return states_; }
  // Of the registry's MetricInfo list, in its order. `learns`: partition lengths change, so they are told
  // over time.
  std::vector<std::pair<std::string, double>> Metrics(int carried, int trapped, bool learns) const;

 private:
  struct Robot {
    PartitioningState state;
    HandoverStep step = HandoverStep::kNone;
    sim::Tick at_rest = -1;
    double length = 0.0;  // m, partition length
  };
  void Hear(sim::Tick tick, const PartitionMessage& message, Robot& robot);
  double MeanLength() const;

  StateLog states_;
  std::vector<Robot> robots_;
  FoodCount food_;
  std::vector<double> length_in_window_;  // m, mean of the robots at the end of each
  std::vector<Transfer> transfers_;
  int handed_over_ = 0;
  int waits_ = 0;
  int timeouts_ = 0;
  int broken_ = 0;
  sim::Tick waited_ = 0;        // robot-ticks offering
  sim::Tick transferring_ = 0;  // robot-ticks of givers
};

}  // namespace gauntlet::controllers
