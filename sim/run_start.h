// How a run begins, as plain data: for a master, which simulates none, and for programs that begin the same
// run elsewhere.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "base/result.h"
#include "sim/arena/validity.h"
#include "sim/geometry/vec2.h"
#include "sim/robot/devices.h"
#include "sim/robot/foot_bot.h"
#include "sim/robot/surroundings.h"

namespace gauntlet::sim {

// A part of the floor that means something to the swarm.
struct GroundArea {
  std::string name;                  // "nest"
  Vec2 center = Vec2::Zero();        // m
  double radius = 0.0;               // m, of a disc; 0: a rectangle
  Vec2 half_extents = Vec2::Zero();  // m along x and y, of a rectangle
  double grey = 1.0;                 // of the floor there, 0 = black, 1 = white as elsewhere
};

struct StartingRobot {
  Pose pose = {};
  double camera_range = 0.0;  // m, as RobotSetup has it
  double radio_range = 0.0;   // m
  bool bodies_block_radio = true;
  // Those that its controller asks for; none when the controller is a plug-in's and the scenario is built in:
  // a master never loads a plug-in.
  DeviceSet devices = {};
  bool under_test = true;  // false: it belongs to the scenario, as the prey of a flock does
};

struct RunStart {
  std::vector<StartingRobot> robots;  // in robot order
  std::vector<Light> lights;
  std::size_t radio_beacons = 0;
  std::vector<GroundArea> ground_areas;
  Tick tick_limit = 0;  // the run ends at this tick at the latest
};

// What a scenario asks of a run's arena, and how the run begins.
struct RunBeginning {
  ArenaRequirements requirements;
  Result<RunStart> start;  // error: why it cannot begin, which may be for what is asked of the arena
};

}  // namespace gauntlet::sim
