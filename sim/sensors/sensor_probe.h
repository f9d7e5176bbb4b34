// A door for benchmarks.
#pragma once

#include "sim/robot/devices.h"

namespace gauntlet::sim {

// Told when the sensors of a device begin to be read.
class SensorProbe {
 public:
  virtual ~SensorProbe() = default;
  virtual void BeginDevice(Device device) = 0;
};

}  // namespace gauntlet::sim
