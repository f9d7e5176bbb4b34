// The Observer (thesis 3.3.3.1): position, facing direction and moving speed of every robot in every tick.
// The one place that records poses.
#pragma once

#include <span>
#include <vector>

#include "sim/geometry/vec2.h"
#include "sim/robot/foot_bot.h"

namespace gauntlet::sim {

struct RobotState {
  double x = 0.0;        // m
  double y = 0.0;        // m
  double heading = 0.0;  // rad in (-pi, pi]
  double speed = 0.0;    // m/s: distance moved in the last tick / 0.1 s; 0 at tick 0

  Vec2 position() const { return {x, y}; }
};

// Tick 0 holds the start poses. Memory is reserved once, so that recording allocates nothing within
// `tick_limit`.
class Observer {
 public:
  Observer(int robots, Tick tick_limit, std::size_t moving_obstacles = 0);

  // Appends one tick; `states` has robots() entries, `obstacles` the centres (m) of the moving obstacles in
  // the order of Arena::moving().
  void Record(std::span<const RobotState> states, std::span<const Vec2> obstacles = {});

  int robots() const { return robots_; }
  // The newest recorded tick; -1 before the first.
  Tick last_tick() const { return static_cast<Tick>(states_.size() / static_cast<std::size_t>(robots_)) - 1; }
  // All robots at `tick`, 0 <= tick <= last_tick().
  std::span<const RobotState> At(Tick tick) const {
    return std::span<const RobotState>(states_).subspan(
        static_cast<std::size_t>(tick) * static_cast<std::size_t>(robots_),
        static_cast<std::size_t>(robots_));
  }
  // The centres of the moving obstacles at `tick`, as Arena::LineOfSight takes them.
  std::span<const Vec2> ObstaclesAt(Tick tick) const {
    return std::span<const Vec2>(obstacles_)
        .subspan(static_cast<std::size_t>(tick) * moving_obstacles_, moving_obstacles_);
  }
  std::span<const RobotState> Latest() const { return At(last_tick()); }

 private:
  int robots_;
  std::size_t moving_obstacles_;
  std::vector<RobotState> states_;
  std::vector<Vec2> obstacles_;
};

}  // namespace gauntlet::sim
