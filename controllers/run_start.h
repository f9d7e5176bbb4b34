// How a run begins, for a master, which builds a scenario for this alone, and for programs that begin the
// same run elsewhere.
#pragma once

#include <cstddef>
#include <vector>

#include "base/result.h"
#include "sim/run_spec.h"
#include "sim/scenario.h"

namespace gauntlet::controllers {

struct StartingRobot {
  sim::Pose pose = {};
  double camera_range = 0.0;  // m, as sim::RobotSetup has it
  double radio_range = 0.0;   // m
  bool bodies_block_radio = true;
  // Those that its controller asks for; none when the controller is a plug-in's, which a master never loads.
  sim::DeviceSet devices = {};
  bool under_test = true;  // false: it belongs to the scenario, as the prey of a flock does
};

struct RunStart {
  std::vector<StartingRobot> robots;  // in robot order
  std::vector<sim::Light> lights;
  std::size_t radio_beacons = 0;
  std::vector<sim::GroundArea> ground_areas;
  sim::Tick tick_limit = 0;  // the run ends at this tick at the latest
};

// Start poses are those of the spec's seed. Error: as CreateScenario, or why the swarm cannot be put into the
// arena ("no-room-to-spawn: ...").
Result<RunStart> StartOf(const sim::RunSpec& spec);

// The number of robots of the spec's swarm, provided that it can be put into the arena at all. Start places
// are random, so a few seeds from the spec's on are tried, and one that works is enough. Error: as StartOf,
// of the last try.
Result<std::size_t> CountSwarm(const sim::RunSpec& spec);

}  // namespace gauntlet::controllers
