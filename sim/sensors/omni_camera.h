// The foot-bot's omnidirectional camera and the LEDs and lamps it sees (ARGoS
// colored_blob_omnidirectional_camera; measured in tests/golden/argos/sensors/cam_*.csv).
#pragma once

#include "sim/sensors/sensor.h"

namespace gauntlet::sim {

// The cameras of a swarm. Each sees a blob for every beacon, ring LED and lamp that is not black, strictly
// inside its square and not hidden: robots in robot order, of each the beacon, then its ring; then lights in
// their order, then those of obstacles. Robots are lower than the line to a beacon and hide none; a ring LED
// may be hidden by a robot, by its own too. A robot does not see its own LEDs. Lamps 0.577 m (twice the
// camera's height) or more above the floor are not seen.
std::unique_ptr<Sensor> MakeOmniCameras(const Arena& arena, std::span<const RobotSensors> robots);

}  // namespace gauntlet::sim
