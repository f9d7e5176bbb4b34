#include "sim/robot/controller.h"

#include "sim/geometry/trigonometry.h"

namespace gauntlet::sim {

double ProximityBearing(int sensor) {
  return WrapAngle((sensor + 0.5) * (2.0 * kPi / foot_bot::kProximitySensors));
}

}  // namespace gauntlet::sim
