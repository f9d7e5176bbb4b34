// What every robot of a run did when: one state per robot and tick, for metrics and the time-line.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "sim/run_result.h"

namespace gauntlet::controllers {

// Allocates once, in Begin.
class StateLog {
 public:
  // `names` of the states by number, at least one; they outlive the log.
  explicit StateLog(std::span<const std::string_view> names) : names_(names) {}

  // Everybody's state at tick 0.
  void Begin(int robots, sim::Tick tick_limit, std::uint8_t state);
  // The next robot's, in robot order, tick after tick.
  void Add(std::uint8_t state) { states_.push_back(state); }

  std::uint8_t At(sim::RobotIndex robot, sim::Tick tick) const {
    return states_[static_cast<std::size_t>(tick) * robots_ + static_cast<std::size_t>(robot)];
  }
  // Number of ticks, tick 0 included.
  sim::Tick ticks() const { return static_cast<sim::Tick>(states_.size() / robots_); }
  // mean_robots_NAME for each state: how many robots were in it, mean over all ticks.
  void AddMeans(std::vector<std::pair<std::string, double>>& metrics) const;
  // A robot's annotation "states" (analysis/figures/run/run_annotations.h): changes of state, looked at once
  // per second. A second in which `brief` occurred counts as that state, however short it was.
  sim::Annotation Line(sim::RobotIndex robot, std::optional<std::uint8_t> brief) const;

 private:
  bool OccurredInSecondBefore(sim::RobotIndex robot, sim::Tick tick, std::uint8_t state) const;

  std::span<const std::string_view> names_;
  std::size_t robots_ = 0;
  std::vector<std::uint8_t> states_;  // [tick * robots + robot]
};

}  // namespace gauntlet::controllers
