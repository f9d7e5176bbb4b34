// Swarms that start in the corner (+,+) of the arena and go to the corner (-,-).
#pragma once

#include <vector>

#include "sim/arena/test_case.h"
#include "sim/arena/validity.h"
#include "sim/robot/foot_bot.h"

namespace gauntlet::controllers {

struct CornerToCorner {
  sim::Tick tick_limit = 0;      // the run is over then at the latest
  double corner_distance = 0.0;  // m from the centre lines of a corner's walls to the start and to the goal
  double spawn_side = 0.0;       // m, side of the square in the corner that the swarm starts in
  double camera_range = 0.0;     // m, half side of the square that a robot sees

  sim::ArenaRequirements Requirements(const sim::TestCase& test_case) const {
    const sim::Vec2 start(test_case.side_x / 2.0 - corner_distance, test_case.side_y / 2.0 - corner_distance);
    return {.start = start, .goal = -start};
  }
  // Where the swarm starts: the test case's area, or the square in the corner.
  sim::Rectangle StartArea(const sim::TestCase& test_case) const {
    const sim::Vec2 corner(test_case.side_x / 2.0, test_case.side_y / 2.0);
    return test_case.spawn_area.value_or(sim::Rectangle{corner - sim::Vec2(spawn_side, spawn_side), corner});
  }
};

inline std::vector<sim::Vec2> CornersOf(const sim::Rectangle& area) {
  return {area.min, {area.max.x(), area.min.y()}, area.max, {area.min.x(), area.max.y()}};
}

}  // namespace gauntlet::controllers
