// What happened in a run of task partitioning, from what robots say and what the scenario moves.
#pragma once

#include <span>
#include <string>
#include <utility>
#include <vector>

#include "controllers/common/nest_and_food.h"
#include "controllers/partitioning/partition_message.h"

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

  PartitioningState state(std::size_t robot) const { return robots_[robot].state; }
  // Whether the robot said in this tick that it stands by its own rules: waiting, or in a hand-over.
  bool at_rest(std::size_t robot) const { return robots_[robot].at_rest; }
  const std::vector<Transfer>& transfers() const { return transfers_; }
  // From `transfers` to `partition_length` of the registry's list; `trapped` robots are among it.
  void AddMetrics(int trapped, std::vector<std::pair<std::string, double>>& metrics) const;
  // partition_length_window_1 and on.
  void AddWindows(std::vector<std::pair<std::string, double>>& metrics) const;

 private:
  struct Robot {
    PartitioningState state;
    HandoverStep step = HandoverStep::kNone;
    bool at_rest = false;
    double length = 0.0;  // m, partition length
  };
  void Hear(const PartitionMessage& message, Robot& robot);
  double MeanLength() const;

  std::vector<Robot> robots_;
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
