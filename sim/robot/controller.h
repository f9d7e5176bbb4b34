// What a robot's controller may see and do. A controller holds no reference to the simulation: its readings,
// its actuators and its random numbers are all it gets, so global information cannot leak in.
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <span>

#include "sim/arena/color.h"
#include "sim/geometry/trigonometry.h"
#include "sim/geometry/vec2.h"
#include "sim/random/random_stream.h"
#include "sim/robot/devices.h"
#include "sim/robot/foot_bot.h"

namespace gauntlet::sim {

// A light source seen by the omnidirectional camera. Most rules need its place only, so its bearing is worked
// out when asked for.
struct Blob {
  Vec2 position = Vec2::Zero();  // m in the robot's frame: x ahead, y left
  double range = 0.0;            // m, horizontal: the length of `position`
  Color color = Color::kBlack;

  double Bearing() const { return AngleOf(position); }  // rad from the heading, (-pi, pi]
  static Blob At(double range, double bearing, Color color) {
    return {range * UnitVector(bearing), range, color};
  }
};

// What a robot says over range-and-bearing.
using Payload = std::array<std::uint8_t, 10>;

// A message heard by range-and-bearing. Who sent it is not told, unless the payload tells.
struct Message {
  Vec2 position = Vec2::Zero();  // m, of the sender in the robot's frame: x ahead, y left
  double range = 0.0;            // m, horizontal: the length of `position`
  Payload payload{};

  double Bearing() const { return AngleOf(position); }  // rad from the heading, (-pi, pi]
  static Message At(double range, double bearing, const Payload& payload) {
    return {range * UnitVector(bearing), range, payload};
  }
};

// What one ray of the distance scanner meets.
struct ScannerReading {
  static constexpr double kTooNear = -1.0;  // only of long range: nearer than 0.12 m
  static constexpr double kNothing = -2.0;  // nothing within the range

  double bearing = 0.0;        // rad from the heading, (-pi, pi]
  double distance = kNothing;  // m from the body's surface, or kTooNear, kNothing
};

// One tick's readings; only the members of requested devices are filled, the others stay empty or zero.
struct SensorReadings {
  // Reading of sensor i, bearing (i + 1/2) * 15 degrees; 0 = nothing within 0.10 m of the body, 1 = touching.
  std::array<double, foot_bot::kProximitySensors> proximity{};
  std::uint32_t proximity_hits = 0;  // bit i: reading i of `proximity` is not zero
  std::span<const Blob> blobs;  // omnidirectional camera; of robots in robot order, then of lights in theirs
  // Messages in robot order, then those of the scenario's radio beacons in theirs.
  std::span<const Message> range_and_bearing;
  // Brightness in [0, 1]; the bearings are those of the proximity sensors.
  std::array<double, foot_bot::kLightSensors> light{};
  std::array<double, foot_bot::kMotorGroundSensors> motor_ground{};  // grey, 0 = black, 1 = white
  std::array<bool, foot_bot::kBaseGroundSensors> base_ground{};      // grey of at least 0.5
  std::span<const ScannerReading> scanner_short;  // 0 to 0.26 m; one ray in the other's back
  std::span<const ScannerReading> scanner_long;   // 0.12 to 1.42 m; across the short ones
  bool holding_item = false;                      // the gripper has something in it
  Pose pose;                                      // positioning: the robot's own, in the world
  WheelSpeeds wheels;  // wheel encoders: in effect in this tick, also of a robot that is blocked
};

// How the distance scanner is driven. Off, it reads nothing.
struct ScannerCommand {
  enum class Mode : std::uint8_t { kOff, kAngle, kSpeed };

  Mode mode = Mode::kOff;
  double value = 0.0;  // kAngle: rad from the heading; kSpeed: rad/s counter-clockwise
};

// Commands hold until changed. Set in tick t, they act in tick t + 1.
struct Actuators {
  double left_wheel = 0.0;   // m/s
  double right_wheel = 0.0;  // m/s
  Color beacon = Color::kBlack;
  std::array<Color, foot_bot::kRingLeds> ring{};  // LED i at (i + 1/2) * 30 degrees from the heading
  Payload message{};                              // heard by the others in every tick from t + 1 on
  ScannerCommand scanner;
  bool gripper_closed = false;

  // Forward speed (m/s) and turn rate (rad/s, counter-clockwise) as wheel speeds.
  void Drive(double forward, double turn) {
    left_wheel = forward - turn * foot_bot::kWheelDistance / 2.0;
    right_wheel = forward + turn * foot_bot::kWheelDistance / 2.0;
  }
};

// What a robot shows and says to others, as in action during a tick.
struct Signals {
  Color beacon = Color::kBlack;
  std::array<Color, foot_bot::kRingLeds> ring{};
  Payload message{};
  bool silent = false;  // no message is sent: its radio is dead

  bool RingLit() const { return ring != std::array<Color, foot_bot::kRingLeds>{}; }
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

  // What it does not use need not be computed; both change nothing but the readings that they leave out.
  // Those of its devices whose readings the next Step uses, when its gripper then holds an item or does not.
  // The others read as if they were not there.
  virtual DeviceSet Attention(bool /*holding_item*/) const { return Devices(); }
  // m between centres: it uses no message from farther off. Without noise of range-and-bearing it gets none.
  virtual double ListeningRange() const { return std::numeric_limits<double>::infinity(); }

  // Called once, before the first tick: what is commanded here acts in it. The beacon is as the scenario
  // lights it.
  virtual void Begin(Actuators& /*actuators*/) {}
};

// Bearing of proximity sensor i, rad in (-pi, pi].
inline double ProximityBearing(int sensor) {
  return WrapAngle((sensor + 0.5) * (2.0 * kPi / foot_bot::kProximitySensors));
}

}  // namespace gauntlet::sim
