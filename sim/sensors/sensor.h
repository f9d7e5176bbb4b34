// What all sensors have in common. To add one: a row in robot/devices.h, its reading in robot/controller.h, a
// class with its Make in a source of its own (it overrides Disturb when the device may be noisy), and both
// lines of it in sensor_table.h.
#pragma once

#include <span>

#include "sim/arena/arena.h"
#include "sim/robot/disturber.h"
#include "sim/robot/grippers.h"
#include "sim/robot/surroundings.h"
#include "sim/sensors/occluders.h"
#include "sim/sensors/robot_pairs.h"
#include "sim/sensors/sensor_probe.h"

namespace gauntlet::sim {

// What there is to be sensed in a tick.
struct World {
  std::span<const Pose> poses;
  std::span<const Signals> signals;
  std::span<const Actuators> actuators;  // as in action
  const Surroundings& surroundings;
  const Grippers& grippers;
  std::span<const WheelSpeeds> wheels = {};        // in effect; of each robot, or empty: nobody drives
  std::span<const OrientedBox> moving_boxes = {};  // as many as the arena has moving obstacles
  std::span<const Light> obstacle_lights = {};
  const Disturber* disturber = nullptr;       // of the run, when something is disturbed
  Tick tick = 0;                              // which errors and faults depend on
  std::span<const DeviceSet> attention = {};  // of each robot: what is read; empty: everything
  SensorProbe* probe = nullptr;               // of a benchmark
};

// With what all sensors work out of it only once.
struct Scene : World {
  std::span<const BodyFrame> robots;
  std::span<const Vec2> positions;  // m, of the robots
  const Occluders& occluders;
  const RobotPairs& pairs;    // of this tick, when a robot has a camera or a radio
  bool any_ring_lit = false;  // somebody's ring LEDs are on, and there is a camera
};

// One kind of sensor on all robots of a swarm. After the first tick nothing is allocated, except by cameras
// and radios in crowds.
class Sensor {
 public:
  virtual ~Sensor() = default;
  // Once per tick, before the first Read: what the robots' readings share.
  virtual void Prepare(const Scene& /*scene*/) {}
  // What a robot that has this sensor reads. Spans in `readings` are valid until the next Prepare.
  virtual void Read(const Scene& scene, RobotIndex robot, SensorReadings& readings) = 0;
  // After Read, when the sensor is dead: what a robot without it reads.
  virtual void Blank(RobotIndex robot, SensorReadings& readings) = 0;
  // After Read, when noise is asked for, which only devices have whose row defines it: puts the errors in.
  virtual void Disturb(const Scene& /*scene*/, RobotIndex /*robot*/, DeviceErrors& /*errors*/,
                       SensorReadings& /*readings*/) {}
};

}  // namespace gauntlet::sim
