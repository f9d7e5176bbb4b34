// The foot-bot's devices. A robot has those that its controller asks for; a sensor nobody asks for costs
// nothing.
#pragma once

#include <cstdint>
#include <string_view>

namespace gauntlet::sim {

enum class Device : std::uint32_t {
  kWheels = 1u << 0,
  kLeds = 1u << 1,
  kProximity = 1u << 2,
  kOmnidirectionalCamera = 1u << 3,
  kRangeAndBearing = 1u << 4,
  kLight = 1u << 5,
  kMotorGround = 1u << 6,
  kBaseGround = 1u << 7,
  kDistanceScanner = 1u << 8,
  kGripper = 1u << 9,
};

class DeviceSet {
 public:
  constexpr DeviceSet() = default;
  // NOLINTNEXTLINE(google-explicit-constructor): a device is a set of one.
  constexpr DeviceSet(Device device) : bits_(static_cast<std::uint32_t>(device)) {}
  constexpr DeviceSet operator|(DeviceSet other) const {
    DeviceSet result;
    result.bits_ = bits_ | other.bits_;
    return result;
  }
  constexpr bool Has(Device device) const { return (bits_ & static_cast<std::uint32_t>(device)) != 0; }
  constexpr bool operator==(const DeviceSet&) const = default;

 private:
  std::uint32_t bits_ = 0;
};
constexpr DeviceSet operator|(Device a, Device b) {
  return DeviceSet(a) | DeviceSet(b);
}

// Everything a foot-bot can have (thesis 3.3.2).
inline constexpr DeviceSet kAllDevices = Device::kWheels | Device::kLeds | Device::kProximity |
                                         Device::kOmnidirectionalCamera | Device::kRangeAndBearing |
                                         Device::kLight | Device::kMotorGround | Device::kBaseGround |
                                         Device::kDistanceScanner | Device::kGripper;

std::string_view NameOf(Device device);

}  // namespace gauntlet::sim
