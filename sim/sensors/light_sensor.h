// The foot-bot's ring of light sensors (ARGoS footbot_light; measured in
// tests/golden/argos/sensors/light*.csv).
#pragma once

#include <array>

#include "sim/sensors/sensor.h"

namespace gauntlet::sim {

using LightReadings = std::array<double, foot_bot::kLightSensors>;

// What robot `self` reads. A lamp of intensity I at D metres (in space) shines with exp(-2 D / I) as far as
// D = 2.5 I on the sensors within 90 degrees, falling linearly with the angle. An occludable lamp is hidden
// by whatever meets the line from the robot's place on the floor to it.
LightReadings SenseLight(std::span<const BodyFrame> robots, RobotIndex self, std::span<const Light> lights,
                         const Occluders& occluders);

}  // namespace gauntlet::sim
