// The foot-bot's devices (thesis 3.3.2). A robot has those that its controller asks for; a sensor nobody asks
// for costs nothing.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace gauntlet::sim {

// The number of a device names its stream of noise, on which stored runs depend: append, do not renumber.
enum class Device : std::uint8_t {
  kWheels,
  kLeds,
  kProximity,
  kOmnidirectionalCamera,
  kRangeAndBearing,
  kLight,
  kMotorGround,
  kBaseGround,
  kDistanceScanner,
  kGripper,
  kPositioning,
  kWheelEncoders,
};

// Everything that is said of a device. The errors are those of ARGoS where ARGoS has them.
struct DeviceInfo {
  Device device;
  std::string_view key;               // in experiments, faults and messages; stored: do not rename
  std::string_view noise_error = {};  // what an error is added to
  std::string_view noise_unit = {};   // of the error: "" is a share of the reading's full scale, or as said
  double most_noise = 0.0;            // largest error that can be asked for; 0: none is defined
  bool drops = false;                 // has messages or blobs that may be lost
};

// In the order of the enumeration.
inline constexpr auto kDevices = std::to_array<DeviceInfo>({
    {Device::kWheels, "wheels", "share of the commanded speed, of each wheel", "", 1.0},
    {Device::kLeds, "leds"},
    {Device::kProximity, "proximity", "of full scale, of each of the 24 readings, also of zero ones", "",
     1.0},
    {Device::kOmnidirectionalCamera, "omnidirectional_camera",
     "share of the blob's distance, by which it is shifted in a random direction", "", 1.0, true},
    {Device::kRangeAndBearing, "range_and_bearing",
     "by which the sender's place is shifted in a random direction", "m", 10.0, true},
    {Device::kLight, "light", "of full scale, of each of the 24 readings", "", 1.0},
    {Device::kMotorGround, "motor_ground", "of the grey, of each of the 4 readings", "", 1.0},
    {Device::kBaseGround, "base_ground", "of the grey, of each of the 8 readings before they are cut at 0.5",
     "", 1.0},
    {Device::kDistanceScanner, "distance_scanner", "of each distance that is read", "m", 1.0},
    {Device::kGripper, "gripper"},
    {Device::kPositioning, "positioning"},
    {Device::kWheelEncoders, "wheel_encoders"},
});

constexpr std::size_t IndexOf(Device device) {
  return static_cast<std::size_t>(device);
}
static_assert([] {
  for (std::size_t i = 0; i < kDevices.size(); ++i) {
    if (IndexOf(kDevices[i].device) != i) return false;
  }
  return kDevices.size() <= 32;
}());

inline std::string KeyOf(Device device) {
  return std::string(kDevices[IndexOf(device)].key);
}
// The device of that key, or nothing.
inline std::optional<Device> DeviceOfKey(std::string_view key) {
  for (const DeviceInfo& info : kDevices) {
    if (info.key == key) return info.device;
  }
  return std::nullopt;
}

class DeviceSet {
 public:
  constexpr DeviceSet() = default;
  // NOLINTNEXTLINE(google-explicit-constructor): a device is a set of one.
  constexpr DeviceSet(Device device) : bits_(1u << IndexOf(device)) {}
  constexpr DeviceSet operator|(DeviceSet other) const {
    DeviceSet result;
    result.bits_ = bits_ | other.bits_;
    return result;
  }
  constexpr bool Has(Device device) const { return (bits_ >> IndexOf(device) & 1u) != 0; }
  constexpr bool operator==(const DeviceSet&) const = default;

 private:
  std::uint32_t bits_ = 0;
};
constexpr DeviceSet operator|(Device a, Device b) {
  return DeviceSet(a) | DeviceSet(b);
}

inline constexpr DeviceSet kAllDevices = [] {
  DeviceSet all;
  for (const DeviceInfo& info : kDevices) all = all | info.device;
  return all;
}();

}  // namespace gauntlet::sim
