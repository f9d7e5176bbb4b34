// What controllers compute from the proximity ring.
#pragma once

#include <array>

#include "sim/geometry/vec2.h"
#include "sim/robot/foot_bot.h"

namespace gauntlet::controllers {

// Unit vectors of the ring's sensors in the robot's frame (x ahead, y left).
const std::array<sim::Vec2, sim::foot_bot::kProximitySensors>& ProximityDirections();

// The reading of a sensor whose ray hits something at `distance` m from the body (ARGoS
// footbot_proximity_default: 1 below 0.00989 m, then 0.0100527 / (d + 0.000163144)). Range is not considered.
double ProximityReadingAt(double distance);

}  // namespace gauntlet::controllers
