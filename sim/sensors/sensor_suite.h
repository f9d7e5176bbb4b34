// All sensors of a swarm: every robot gets the readings of the devices that its controller asked for, and
// nothing else is computed.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "sim/arena/arena.h"
#include "sim/physics/nearby_boxes.h"
#include "sim/robot/controller.h"
#include "sim/robot/grippers.h"
#include "sim/robot/signals.h"
#include "sim/robot/surroundings.h"
#include "sim/sensors/body_frame.h"
#include "sim/sensors/distance_scanner.h"
#include "sim/sensors/neighbour_grid.h"
#include "sim/sensors/occluders.h"
#include "sim/sensors/omni_camera.h"
#include "sim/sensors/range_and_bearing.h"
#include "sim/sensors/robot_pairs.h"

namespace gauntlet::sim {

class SensorSuite {
 public:
  struct RobotSensors {
    DeviceSet devices;
    double camera_range = 0.0;                             // m, see OmniCameras
    double radio_range = foot_bot::kRangeAndBearingRange;  // m, see Radios
    bool bodies_block_radio = true;
  };
  SensorSuite(const Arena& arena, std::span<const RobotSensors> robots);

  // What there is to be sensed in a tick.
  struct World {
    std::span<const Pose> poses;
    std::span<const Signals> signals;
    std::span<const Actuators> actuators;  // as in action: drives the scanners
    const Surroundings& surroundings;
    const Grippers& grippers;
    std::span<const OrientedBox> moving_boxes = {};  // as many as the arena has moving obstacles
    std::span<const Light> obstacle_lights = {};
  };
  // Reads every sensor. Allocates nothing, except in crowds where a robot sees or hears more than 64 others.
  void Sense(const World& world);
  // Of the last Sense; valid until the next.
  const SensorReadings& ReadingsOf(RobotIndex robot) const {
    return readings_[static_cast<std::size_t>(robot)];
  }

 private:
  void SenseOthers(const World& world);
  void FindNear();
  void SenseProximity(const World& world, RobotIndex robot);
  void SenseRest(const World& world, RobotIndex robot);

  std::vector<RobotSensors> sensors_;
  DeviceSet anybodys_devices_;
  std::vector<BodyFrame> frames_;
  std::vector<SensorReadings> readings_;
  NearbyBoxes nearby_;
  std::vector<std::uint64_t> near_;  // of few robots: bit j of near_[i] says that j is near i
  NeighbourGrid proximity_grid_;
  Occluders occluders_;
  RobotPairs pairs_;
  OmniCameras cameras_;
  Radios radios_;
  std::vector<OrientedBox> boxes_;         // fixed, then moving ones
  std::vector<DistanceScanner> scanners_;  // per robot; empty when nobody has one
};

}  // namespace gauntlet::sim
