// A run that tests make up: where its robots are in each tick.
#pragma once

#include <functional>
#include <numeric>
#include <vector>

#include "controllers/requirements/measures.h"
#include "sim/arena/test_case.h"

namespace gauntlet::testing_support {

class RecordedRun {
 public:
  // place(tick, robot) in an arena of 6 x 6 m whose inner faces are 2.95 m from its centre; ticks 0 to
  // `ticks`.
  RecordedRun(int robots, sim::Tick ticks, const std::function<sim::Vec2(sim::Tick, int)>& place)
      : arena_(sim::TestCase{}), observer_(robots, ticks) {
    std::vector<sim::RobotState> states(static_cast<std::size_t>(robots));
    for (sim::Tick tick = 0; tick <= ticks; ++tick) {
      for (int robot = 0; robot < robots; ++robot) {
        const sim::Vec2 at = place(tick, robot);
        states[static_cast<std::size_t>(robot)] = {.x = at.x(), .y = at.y(), .heading = 0.0, .speed = 0.05};
      }
      observer_.Record(states);
    }
  }

  // Starts at (-2, 0), is to reach (2, 0), and may last as long as it did.
  controllers::requirements::Trace trace(sim::Tick step = sim::kTicksPerSecond) const {
    controllers::requirements::Trace trace{.observer = observer_,
                                           .arena = arena_,
                                           .start = {-2.0, 0.0},
                                           .goal = {2.0, 0.0},
                                           .tick_limit = observer_.last_tick(),
                                           .step = step};
    trace.robots.resize(static_cast<std::size_t>(observer_.robots()));
    std::iota(trace.robots.begin(), trace.robots.end(), 0);
    return trace;
  }

 private:
  sim::Arena arena_;
  sim::Observer observer_;
};

}  // namespace gauntlet::testing_support
