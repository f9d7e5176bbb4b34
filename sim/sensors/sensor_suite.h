// All sensors of a swarm: every robot gets the readings of the devices that its controller asked for, and
// nothing else is computed.
#pragma once

#include <span>
#include <vector>

#include "sim/arena/arena.h"
#include "sim/physics/nearby_boxes.h"
#include "sim/robot/controller.h"
#include "sim/sensors/body_frame.h"
#include "sim/sensors/omni_camera.h"

namespace gauntlet::sim {

// The devices that this simulator has.
inline constexpr DeviceSet kSupportedDevices =
    Device::kWheels | Device::kLeds | Device::kProximity | Device::kOmnidirectionalCamera;

class SensorSuite {
 public:
  struct RobotSensors {
    DeviceSet devices;
    double camera_range = 0.0;  // m, see OmniCameras
  };
  SensorSuite(const Arena& arena, std::span<const RobotSensors> robots);

  // Reads every sensor at these poses while the beacons show these colours. Allocates nothing.
  void Sense(std::span<const Pose> poses, std::span<const Color> beacons);
  // Of the last Sense; valid until the next.
  const SensorReadings& ReadingsOf(RobotIndex robot) const {
    return readings_[static_cast<std::size_t>(robot)];
  }

 private:
  void SenseProximity(RobotIndex robot);

  std::vector<RobotSensors> sensors_;
  std::vector<BodyFrame> frames_;
  std::vector<SensorReadings> readings_;
  NearbyBoxes nearby_;
  OmniCameras cameras_;
  bool any_camera_ = false;
};

}  // namespace gauntlet::sim
