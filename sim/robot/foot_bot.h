// The foot-bot's body and drive as ARGoS3 models it (argos3/src/plugins/robots/foot-bot, dynamics2d engine;
// constants measured against that simulator).
#pragma once

#include <cstdint>

namespace gauntlet::sim {

// One control step: 0.1 s.
using Tick = std::int32_t;
inline constexpr double kTickSeconds = 0.1;
inline constexpr int kTicksPerSecond = 10;

// Index into the swarm; spawn order. Box2D bodies are created in this order.
using RobotIndex = int;

struct WheelSpeeds {
  double left = 0.0;   // m/s
  double right = 0.0;  // m/s
};

namespace foot_bot {

inline constexpr double kRadius = 0.085036758;  // m, FOOTBOT_RADIUS
inline constexpr double kHeight = 0.146899733;  // m
inline constexpr double kWheelDistance = 0.14;  // m, FOOTBOT_INTERWHEEL_DISTANCE
inline constexpr double kMass = 1.68;           // kg, body 1.6 + turret 0.08 accelerate together
inline constexpr double kMaxForce = 15.0;       // N, drive force limit of dynamics2d
inline constexpr double kMaxWheelSpeed =
    1.0;  // m/s; ours: far beyond the robot; jams then sink into themselves (docs/validation.md)
inline constexpr double kFriction = 0.7;        // contact friction; of a pair: the product
inline constexpr double kStaticFriction = 0.1;  // of walls and fixed obstacles
inline constexpr int kSubstepsPerTick = 10;     // of ARGoS' physics
inline constexpr double kSubstep = kTickSeconds / kSubstepsPerTick;  // s
inline constexpr double kProximityRange = 0.10;                      // m beyond the body
inline constexpr int kProximitySensors = 24;           // sensor i at (i + 1/2) * 15 degrees from the heading
inline constexpr double kCameraHeight = 0.288699733;   // m
inline constexpr double kBeaconHeight = 0.174249733;   // m
inline constexpr double kRangeAndBearingHeight = 0.1;  // m
inline constexpr double kRangeAndBearingRange = 3.0;   // m, default of ARGoS
inline constexpr int kLightSensors = 24;               // at the bearings of the proximity sensors
inline constexpr int kMotorGroundSensors = 4;
inline constexpr int kBaseGroundSensors = 8;
inline constexpr int kRingLeds = 12;                // LED i at (i + 1/2) * 30 degrees from the heading
inline constexpr double kRingRadius = 0.090036758;  // m
inline constexpr double kRingHeight = 0.085;        // m
inline constexpr double kGripperRadius = 0.01;      // m, disc at the front that rays of others hit

}  // namespace foot_bot
}  // namespace gauntlet::sim
