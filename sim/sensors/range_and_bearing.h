// Range-and-bearing (ARGoS range_and_bearing_medium_sensor; measured in tests/golden/argos/sensors/rab*.csv).
#pragma once

#include "sim/sensors/sensor.h"

namespace gauntlet::sim {

// The radios of a swarm. Each hears those that are strictly nearer than the sender's range when no box and,
// if bodies block, no third robot stands between: robots in robot order, then radio beacons in theirs.
std::unique_ptr<Sensor> MakeRadios(const Arena& arena, std::span<const RobotSensors> robots);

}  // namespace gauntlet::sim
