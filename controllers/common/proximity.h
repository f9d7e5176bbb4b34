// What controllers compute from the proximity ring.
#pragma once

#include <array>
#include <span>

#include "sim/geometry/vec2.h"
#include "sim/robot/controller.h"
#include "sim/robot/foot_bot.h"

namespace gauntlet::controllers {

using ProximityReadings = std::array<double, sim::foot_bot::kProximitySensors>;

// Unit vectors of the ring's sensors in the robot's frame (x ahead, y left).
const std::array<sim::Vec2, sim::foot_bot::kProximitySensors>& ProximityDirections();

// The reading of a sensor whose ray hits something at `distance` m from the body (ARGoS
// footbot_proximity_default: 1 below 0.00989 m, then 0.0100527 / (d + 0.000163144)). Range is not considered.
double ProximityReadingAt(double distance);
// The distance, in m from the body, at which a sensor reads `reading`, in (0, 1]. A saturated sensor says
// only that it is at most this near.
double ProximityDistanceOf(double reading);

// The largest reading of the sensors whose bearing differs from the heading by at most `half_angle` rad.
double FrontReading(const ProximityReadings& readings, double half_angle);

// A robot's body, as another one sees it.
struct SeenBody {
  double range = 0.0;    // m between centres
  double bearing = 0.0;  // rad from the heading
};

// The readings without those of sensors that look at one of `bodies`: a ray hits it when it passes its centre
// at 0.10 m or less, and it is nearer than 0.30 m.
ProximityReadings WithoutBodies(const ProximityReadings& readings, std::span<const SeenBody> bodies);

// All readings as one push.
struct ProximitySum {
  sim::Vec2 sum = sim::Vec2::Zero();  // of reading * direction of the sensor; points at what is near
  double largest = 0.0;               // reading
};
ProximitySum SumProximity(const ProximityReadings& readings);

}  // namespace gauntlet::controllers
