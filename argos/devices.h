// The robot's devices as ARGoS' interface names them: each takes our readings in ARGoS' units, or turns what
// it was told into our commands. None allocates memory once it has held as much before.
#pragma once

#include <span>
#include <string_view>

#include "argos/mailbox.h"
#include "argos/palette.h"
#include "sim/geometry/directions.h"
#include "sim/robot/controller.h"

#include <argos3/core/control_interface/ci_actuator.h>
#include <argos3/core/control_interface/ci_sensor.h>

namespace gauntlet::argos_form {

// What those of all robots of a run share.
struct RunParts {
  static constexpr std::size_t kRoom = 128;  // places without more memory

  Palette palette;
  Mailbox mailbox;
  sim::Directions directions = sim::Directions(kRoom);
};

// What the devices of one robot share.
struct RobotParts {
  Palette& palette;
  Mailbox& mailbox;
  sim::Directions& directions;  // for whoever needs some at the moment
  sim::RobotIndex robot = 0;
  std::size_t message_bytes = sim::Payload().size();
  sim::Pose start;
  double turret = 0.0;  // rad, counter-clockwise from the heading
};

class SensorLink {
 public:
  virtual ~SensorLink() = default;
  virtual void Take(const sim::SensorReadings& readings) = 0;
};

class ActuatorLink {
 public:
  virtual ~ActuatorLink() = default;
  virtual void Give(sim::Actuators& actuators) = 0;
};

// One object seen from both sides; the ARGoS side owns it.
struct LinkedSensor {
  argos::CCI_Sensor* sensor = nullptr;
  SensorLink* link = nullptr;
};
struct LinkedActuator {
  argos::CCI_Actuator* actuator = nullptr;
  ActuatorLink* link = nullptr;
};

struct SensorRow {
  std::string_view tag;
  sim::DeviceSet devices;  // that it reads
  LinkedSensor (*make)(RobotParts& parts);
};
struct ActuatorRow {
  std::string_view tag;
  sim::DeviceSet devices;  // that it drives
  LinkedActuator (*make)(RobotParts& parts);
};

std::span<const SensorRow> SensorRows();
std::span<const ActuatorRow> ActuatorRows();

}  // namespace gauntlet::argos_form
