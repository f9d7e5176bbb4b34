// A test case: the environment a swarm is tested in. It says nothing about the controller, the seed or the
// robots' behaviour.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "sim/arena/genome.h"

namespace gauntlet::sim {

// Largest swarm of a run; a larger one is refused.
inline constexpr int kMaxRobots = 1000;

struct Rectangle {
  Vec2 min = Vec2::Zero();  // m
  Vec2 max = Vec2::Zero();  // m
};

struct TestCase {
  std::string name;             // where it came from; no influence on a run
  double side_x = 6.0;          // m, between the centre lines of the walls (thesis 4.5.3: 6 x 6 m)
  double side_y = 6.0;          // m
  double wall_thickness = 0.1;  // m; the free interior ends half a thickness inside the centre lines
  Genome obstacles;
  std::optional<Rectangle> spawn_area;  // overrides the scenario's spawn area (imported .argos files)
  std::optional<int> robots;            // overrides the scenario's number of robots under test (birds)
  // Where each of `robots` starts, in their order, instead of where the seed puts it. Empty: the seed
  // decides.
  std::vector<Pose> start_poses = {};
  // m, the middle of the arena. Only programs of a user's have arenas elsewhere than around the origin
  // (ArenaRequirements::anywhere).
  Vec2 center = Vec2::Zero();
};

}  // namespace gauntlet::sim
