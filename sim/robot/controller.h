// What a robot's controller may see and do. A controller holds no reference to the simulation: its readings,
// its actuators and its random numbers are all it gets, so global information cannot leak in.
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "sim/geometry/vec2.h"
#include "sim/random/random_stream.h"
#include "sim/robot/devices.h"
#include "sim/robot/foot_bot.h"

namespace gauntlet::sim {

enum class Color : std::uint8_t {
  kBlack = 0,
  kRed,
  kGreen,
  kBlue,
  kYellow,
  kWhite,
  kMagenta,
  kCyan,
  kOrange
};

// A light source seen by the omnidirectional camera.
struct Blob {
  double range = 0.0;    // m, horizontal
  double bearing = 0.0;  // rad from the heading, (-pi, pi]
  Color color = Color::kBlack;
};

// One tick's readings; only the members of requested devices are filled, the others stay empty or zero.
struct SensorReadings {
  // Reading of sensor i, bearing (i + 1/2) * 15 degrees; 0 = nothing within 0.10 m of the body, 1 = touching.
  std::array<double, foot_bot::kProximitySensors> proximity{};
  bool proximity_active = false;  // some proximity reading is not zero
  std::span<const Blob> blobs;    // omnidirectional camera; in robot order
};

// Commands hold until changed. Set in tick t, they act in tick t + 1.
struct Actuators {
  double left_wheel = 0.0;   // m/s
  double right_wheel = 0.0;  // m/s
  Color beacon = Color::kBlack;

  // Forward speed (m/s) and turn rate (rad/s, counter-clockwise) as wheel speeds.
  void Drive(double forward, double turn) {
    left_wheel = forward - turn * foot_bot::kWheelDistance / 2.0;
    right_wheel = forward + turn * foot_bot::kWheelDistance / 2.0;
  }
};

struct ControlStep {
  Tick tick = 0;
  const SensorReadings& readings;
  Actuators& actuators;
  RandomStream& random;  // this robot's stream of this tick
};

// One robot's behaviour. Called once per tick, from one thread.
class Controller {
 public:
  virtual ~Controller() = default;
  virtual DeviceSet Devices() const = 0;
  virtual void Step(const ControlStep& step) = 0;
};

// Bearing of proximity sensor i, rad in (-pi, pi].
double ProximityBearing(int sensor);

}  // namespace gauntlet::sim
