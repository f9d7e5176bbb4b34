#include "sim/robot/devices.h"

namespace gauntlet::sim {

std::string_view NameOf(Device device) {
  switch (device) {
    case Device::kWheels:
      return "wheels";
    case Device::kLeds:
      return "leds";
    case Device::kProximity:
      return "proximity";
    case Device::kOmnidirectionalCamera:
      return "omnidirectional-camera";
    case Device::kRangeAndBearing:
      return "range-and-bearing";
    case Device::kLight:
      return "light";
    case Device::kMotorGround:
      return "motor-ground";
    case Device::kBaseGround:
      return "base-ground";
    case Device::kDistanceScanner:
      return "distance-scanner";
    case Device::kGripper:
      return "gripper";
  }
  return "unknown-device";
}

}  // namespace gauntlet::sim
