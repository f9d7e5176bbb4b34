// Where the foot-bot's ground sensors look (ARGoS footbot_motor_ground and footbot_base_ground; measured in
// tests/golden/argos/sensors/ground.csv).
#pragma once

#include <array>

#include "sim/sensors/sensor.h"

namespace gauntlet::sim {

// Places in the robot's frame, m: x forward, y left.
inline const std::array<Vec2, foot_bot::kMotorGroundSensors> kMotorGroundPlaces = {
    {{0.063, 0.0116}, {-0.063, 0.0116}, {-0.063, -0.0116}, {0.063, -0.0116}}};
inline const std::array<Vec2, foot_bot::kBaseGroundSensors> kBaseGroundPlaces = {{{0.08, 0.0},
                                                                                  {0.042, 0.065},
                                                                                  {0.0, 0.08},
                                                                                  {-0.042, 0.065},
                                                                                  {-0.08, 0.0},
                                                                                  {-0.042, -0.065},
                                                                                  {0.0, -0.08},
                                                                                  {0.042, -0.065}}};

// Grey of the floor under each place.
template <std::size_t kCount>
std::array<double, kCount> SenseGround(const BodyFrame& self, const std::array<Vec2, kCount>& places,
                                       const Surroundings& surroundings) {
  std::array<double, kCount> grey;
  for (std::size_t i = 0; i < kCount; ++i) grey[i] = surroundings.FloorGrey(self.ToWorld(places[i]));
  return grey;
}

}  // namespace gauntlet::sim
