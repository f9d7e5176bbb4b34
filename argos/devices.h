// The robot's devices as ARGoS' interface names them: each takes our readings in ARGoS' units, or turns what
// it was told into our commands. None allocates memory once it has held as much before.
#pragma once

#include <span>
#include <string_view>
#include <type_traits>

#include "argos/mailbox.h"
#include "argos/palette.h"
#include "sim/geometry/directions.h"
#include "sim/robot/controller.h"

#include <argos3/core/control_interface/ci_actuator.h>
#include <argos3/core/control_interface/ci_sensor.h>
#include <argos3/core/utility/math/angles.h>

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
  // That the scanner will have when it is read next; computed as ARGoS does, which controllers may compare.
  argos::CRadians scanner;
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
template <typename Face, typename Link>
struct Linked {
  Face* face = nullptr;
  Link* link = nullptr;
};

template <typename Face, typename Link>
struct DeviceRow {
  std::string_view tag;
  sim::DeviceSet devices;  // that it reads or drives
  Linked<Face, Link> (*make)(RobotParts& parts);
};
using SensorRow = DeviceRow<argos::CCI_Sensor, SensorLink>;
using ActuatorRow = DeviceRow<argos::CCI_Actuator, ActuatorLink>;

// A new device, which is given the robot's parts if it wants them.
template <typename Device>
Device* NewDevice(RobotParts& parts) {
  if constexpr (std::is_constructible_v<Device, RobotParts&>) {
    return new Device(parts);
  } else {
    return new Device;
  }
}

std::span<const SensorRow> SensorRows();
std::span<const ActuatorRow> ActuatorRows();

}  // namespace gauntlet::argos_form
