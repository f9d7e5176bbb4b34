// The foot-bot's drive as ARGoS' dynamics2d engine models it, in closed form for one tick without contacts.
// Source: argos3/src/plugins/simulator/physics_engines/dynamics2d/dynamics2d_differentialsteering_control.cpp
// (heading sampled once per tick, force-limited velocity), measured in tests/golden/argos/motion.
#pragma once

#include <array>

#include "sim/geometry/vec2.h"
#include "sim/physics/physics_engine.h"

namespace gauntlet::sim {

// How a robot moves at the end of a tick. The next tick's first substep still moves with it.
struct DriveState {
  Vec2 velocity = Vec2::Zero();  // m/s
  double turn_rate = 0.0;        // rad/s
};

struct DriveMotion {
  std::array<Vec2, 2> halves = {Vec2::Zero(), Vec2::Zero()};  // m, displacement in each half of the tick
  double turn = 0.0;                                          // rad over the tick
  DriveState end;
};

// One tick from `start` with the wheels at `command` and the robot facing `direction` (unit vector) at the
// tick's begin. Ten substeps of 0.01 s: each first moves with the old velocity, then brings the velocity
// nearer to the commanded one by at most 15 N * 0.01 s / 1.68 kg; the turn rate follows at once. Both wheels
// at 0 brake.
DriveMotion Drive(const DriveState& start, const WheelSpeeds& command, const Vec2& direction);

}  // namespace gauntlet::sim
