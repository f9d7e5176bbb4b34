// How a robot knows its own motion: exactly (thesis 3.3.2). Errors are SourceEstimate's.
#pragma once

#include <functional>

#include "sim/geometry/vec2.h"
#include "sim/observer.h"

namespace gauntlet::controllers {

// What a robot's body did in one tick.
struct BodyMotion {
  sim::Vec2 shift = sim::Vec2::Zero();  // m, in the frame of the body before it moved: x ahead, y left
  double turn = 0.0;                    // rad, counter-clockwise
};

// Where a point that was at `point` in the body's frame is after the body moved.
sim::Vec2 AfterMotion(const sim::Vec2& point, const BodyMotion& motion);

// The motion since the last call, or since the start.
using Odometer = std::function<BodyMotion()>;

// Takes the motion from the simulation through Headquarters, pushes by others included, and hands out nothing
// else of it: no position and no heading. `headquarters` outlives it.
Odometer OdometerOf(const sim::Headquarters& headquarters, sim::RobotIndex robot, const sim::Pose& start);

}  // namespace gauntlet::controllers
