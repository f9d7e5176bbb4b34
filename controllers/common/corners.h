// Swarms that start in the corner (+,+) of the arena and go to the corner (-,-).
#pragma once

#include <vector>

#include "sim/arena/test_case.h"
#include "sim/arena/validity.h"

namespace gauntlet::controllers {

// Start and goal, each `distance` m from the centre lines of the walls of its corner.
inline sim::ArenaRequirements CornerToCorner(const sim::TestCase& test_case, double distance) {
  sim::ArenaRequirements requirements;
  requirements.start = {test_case.side_x / 2.0 - distance, test_case.side_y / 2.0 - distance};
  requirements.goal = -requirements.start;
  return requirements;
}

// Where the swarm starts: the test case's area, or the square of that side in the corner.
inline sim::Rectangle StartArea(const sim::TestCase& test_case, double side) {
  const sim::Vec2 corner(test_case.side_x / 2.0, test_case.side_y / 2.0);
  return test_case.spawn_area.value_or(sim::Rectangle{corner - sim::Vec2(side, side), corner});
}

inline std::vector<sim::Vec2> CornersOf(const sim::Rectangle& area) {
  return {area.min, {area.max.x(), area.min.y()}, area.max, {area.min.x(), area.max.y()}};
}

}  // namespace gauntlet::controllers
