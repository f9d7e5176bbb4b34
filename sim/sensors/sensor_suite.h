// All sensors of a swarm: every robot gets the readings of the devices that its controller asked for, and
// nothing else is computed.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "sim/sensors/sensor.h"

namespace gauntlet::sim {

class SensorSuite {
 public:
  SensorSuite(const Arena& arena, std::span<const RobotSensors> robots);

  // Reads every sensor. Allocates nothing, except in crowds where a robot sees or hears more than 64 others.
  void Sense(const World& world);
  // Of the last Sense; valid until the next.
  const SensorReadings& ReadingsOf(RobotIndex robot) const {
    return readings_[static_cast<std::size_t>(robot)];
  }

 private:
  struct Equipment {
    Device device;
    std::unique_ptr<Sensor> sensor;
    std::vector<RobotIndex> robots;  // that have it
  };

  std::vector<BodyFrame> frames_;
  std::vector<Vec2> positions_;
  std::vector<SensorReadings> readings_;
  Occluders occluders_;
  RobotPairs pairs_;
  DeviceSet anybodys_devices_;
  std::vector<Equipment> equipment_;
};

}  // namespace gauntlet::sim
