// The scenes behind tests/golden/argos/motion, and our engine run through them.
#pragma once

#include <ostream>
#include <string>
#include <vector>

#include "sim/geometry/oriented_box.h"
#include "sim/physics/physics_engine.h"

namespace gauntlet::sim {

struct ArgosScene {
  std::string name;                   // of the file in motion/, without .csv
  std::vector<WheelSpeeds> commands;  // per robot, from the end of tick 1 on
  std::vector<OrientedBox> boxes;
  bool free = false;                  // nothing is ever touched
  double contact_tolerance = 0.0025;  // m, over the whole file
};

inline void PrintTo(const ArgosScene& scene, std::ostream* out) {
  *out << scene.name;
}

const std::vector<ArgosScene>& ArgosScenes();
const ArgosScene& FindArgosScene(const std::string& name);

// [tick][robot]
using Trajectory = std::vector<std::vector<Pose>>;
Trajectory ArgosTrajectory(const ArgosScene& scene);
// As many ticks as ARGoS recorded, from ARGoS' start poses.
Trajectory SimulateScene(const ArgosScene& scene, PhysicsEngine& engine);

// Largest deviations between two trajectories over ticks [0, end).
struct Deviation {
  double position = 0.0;  // m
  double heading = 0.0;   // rad
};
Deviation Compare(const Trajectory& a, const Trajectory& b, std::size_t end);

// Number of leading ticks in which no robot's body is nearer than `gap` metres to a box or another body.
std::size_t TicksBeforeContact(const ArgosScene& scene, const Trajectory& trajectory, double gap);

// Mean velocity (m/s) of a robot over the last `ticks` ticks.
Vec2 FinalVelocity(const Trajectory& trajectory, std::size_t robot, std::size_t ticks);

}  // namespace gauntlet::sim
