// The Observer (thesis 3.3.3.1): position, facing direction and moving speed of every robot in every tick.
// The one place that records poses. Headquarters is the one door through which robots get any of it.
#pragma once

#include <span>
#include <vector>

#include "base/check.h"
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
  Observer(int robots, Tick tick_limit, std::size_t moving_obstacles = 0)
      : robots_(robots), moving_obstacles_(moving_obstacles) {
    obstacles_.reserve(moving_obstacles * (static_cast<std::size_t>(tick_limit) + 1));
    states_.reserve(static_cast<std::size_t>(robots) * (static_cast<std::size_t>(tick_limit) + 1));
  }

  // Appends one tick; `states` has robots() entries, `obstacles` the centres (m) of the moving obstacles in
  // the order of Arena::moving().
  void Record(std::span<const RobotState> states, std::span<const Vec2> obstacles = {}) {
    GAUNTLET_CHECK(states.size() == static_cast<std::size_t>(robots_), "one state per robot");
    GAUNTLET_CHECK(obstacles.size() == moving_obstacles_, "one centre per moving obstacle");
    obstacles_.insert(obstacles_.end(), obstacles.begin(), obstacles.end());
    states_.insert(states_.end(), states.begin(), states.end());
  }

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

// Headquarters (thesis 3.3.3.2): the one explicit door through which a scenario hands global information to a
// robot. The prey of the flocking scenario is given one, and the odometers of task partitioning, which tell
// their robot its own motion only.
class Headquarters {
 public:
  explicit Headquarters(const Observer& observer) : observer_(observer) {}

  // Pose of the robot at the newest tick.
  Pose PoseOf(RobotIndex robot) const {
    const RobotState& state = observer_.Latest()[static_cast<std::size_t>(robot)];
    return {state.position(), state.heading};
  }

 private:
  const Observer& observer_;
};

}  // namespace gauntlet::sim
