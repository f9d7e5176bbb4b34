// Carries the disturbances of a run out: what controllers read and what their commands do, with noise and
// faults. A simulation without disturbances has none.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "sim/robot/disturbances.h"
#include "sim/robot/grippers.h"
#include "sim/robot/signals.h"
#include "sim/robot/surroundings.h"

namespace gauntlet::sim {

class Disturber {
 public:
  // Disturbances that RefuseDisturbances lets pass. `surroundings` tells how many blobs and messages there
  // may be; afterwards nothing is allocated.
  Disturber(const Disturbances& disturbances, std::uint64_t seed, std::size_t robots,
            const Surroundings& surroundings, std::size_t obstacle_lights);

  // The whole robot is dead in this tick.
  bool Stopped(RobotIndex robot, Tick tick) const { return tick >= stopped_[Index(robot)]; }

  // What the commands of a robot become in this tick.
  struct Action {
    WheelSpeeds& wheels;
    Signals& signals;
    Grippers& grippers;
  };
  void DisturbAction(RobotIndex robot, Tick tick, const Action& action) const;

  // What the robot's devices read in this tick instead of `readings`. Valid until the next call.
  const SensorReadings& DisturbReadings(RobotIndex robot, Tick tick, const DeviceSet& devices,
                                        const Pose& pose, const SensorReadings& readings);

 private:
  using PerDevice = std::array<Tick, kDevices.size()>;

  static std::size_t Index(RobotIndex robot) { return static_cast<std::size_t>(robot); }
  bool Dead(RobotIndex robot, Device device, Tick tick) const {
    return tick >= dead_[Index(robot)][IndexOf(device)];
  }
  const DeviceNoise& NoiseOf(Device device) const { return noise_[IndexOf(device)]; }
  // A device's errors of one robot in one tick: its numbers depend on nothing else.
  RandomStream Stream(RobotIndex robot, Device device, Tick tick) const;
  template <std::size_t kCount>
  void DisturbShares(RobotIndex robot, Device device, Tick tick, std::array<double, kCount>& readings) const;
  void DisturbBlobs(RobotIndex robot, Tick tick);
  void DisturbMessages(RobotIndex robot, Tick tick);
  void DisturbScanner(RobotIndex robot, Tick tick);
  void DisturbBaseGround(RobotIndex robot, Tick tick, const Pose& pose);

  std::uint64_t seed_;
  const Surroundings& surroundings_;
  std::array<DeviceNoise, kDevices.size()> noise_{};
  std::vector<Tick> stopped_;    // per robot: from this tick on
  std::vector<PerDevice> dead_;  // per robot: from these ticks on
  SensorReadings readings_;      // of the last call
  std::vector<Blob> blobs_;
  std::vector<Message> messages_;
  std::vector<ScannerReading> short_;
  std::vector<ScannerReading> long_;
};

}  // namespace gauntlet::sim
