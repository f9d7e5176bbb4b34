// Whether a robot kept to one place.
#pragma once

#include "sim/observer.h"

namespace gauntlet::controllers {

// In the last `window` ticks the robot was never farther than `radius` m from the mean of its positions in
// that time. False when the run is shorter than the window.
bool KeptWithin(const sim::Observer& observer, sim::RobotIndex robot, sim::Tick window, double radius);

// Of a robot that kept to one place: the tick from which on it was never farther than `radius` from the mean
// of its positions in the last `window` ticks.
sim::Tick StillSince(const sim::Observer& observer, sim::RobotIndex robot, sim::Tick window, double radius);

}  // namespace gauntlet::controllers
