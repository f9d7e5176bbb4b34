// Where the nest is, by the lamp above it: thesis 6.2.1 has it in range everywhere.
#pragma once

#include <array>
#include <optional>

#include "controllers/behaviour.h"
#include "sim/robot/foot_bot.h"

namespace gauntlet::controllers {

struct NestDirection {
  double bearing = 0.0;   // rad from the heading
  double distance = 0.0;  // m on the floor, from the robot's centre to the point under the lamp
};

// Bearing and distance from a ring of light sensors that a single lamp shines on: each reads its brightness
// times 1 - angle / 90 degrees (ARGoS footbot_light), so the two that look most towards it tell both exactly.
// Nothing when all sensors are dark.
std::optional<NestDirection> ReadLamp(const std::array<double, sim::foot_bot::kLightSensors>& readings,
                                      const Lamp& lamp);

}  // namespace gauntlet::controllers
