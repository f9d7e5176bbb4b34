// What may be wrong with the robots of a run: noise of their devices and faults of single robots. The thesis
// ignores both (3.3.2) and so does every shipped experiment; without them they cost nothing.
#pragma once

#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "base/result.h"
#include "sim/robot/devices.h"
#include "sim/robot/foot_bot.h"

namespace gauntlet::sim {

// Errors of one kind of device on every robot, drawn anew for each reading in every tick. `uniform` and
// `gaussian` add up. Their unit is that of DeviceInfo.
struct DeviceNoise {
  double uniform = 0.0;   // half width of a uniform error
  double gaussian = 0.0;  // standard deviation of a Gaussian one
  double drop = 0.0;      // probability that a message or a blob is not received at all

  bool Any() const { return uniform != 0.0 || gaussian != 0.0 || drop != 0.0; }
  bool operator==(const DeviceNoise&) const = default;
};

// From `tick` on, one device of one robot is dead, or the whole robot.
//   wheels: stand still (braked); leds: dark; range-and-bearing: neither sends nor hears; gripper: open,
//   feels nothing; a sensor reads what a device reads that the robot does not have: zero or nothing. The
//   whole robot: wheels stand, dark, silent, its controller is not called any more.
struct RobotFault {
  RobotIndex robot = 0;
  std::optional<Device> device = std::nullopt;  // nothing: the whole robot
  Tick tick = 0;                                // at least 0; 0 and 1 mean from the beginning

  bool operator==(const RobotFault&) const = default;
};

struct Disturbances {
  std::map<Device, DeviceNoise> noise = {};  // only devices with some
  std::vector<RobotFault> faults = {};

  bool None() const { return noise.empty() && faults.empty(); }
  bool operator==(const Disturbances&) const = default;
};

// "3:wheels@500 7:stopped@0": ROBOT:WHAT@TICK, several with spaces between them. WHAT is a device or
// `stopped`. Error: what is malformed, unknown (with the nearest known name) or out of range.
Result<std::vector<RobotFault>> ParseFaults(std::string_view text);
std::string FaultsText(std::span<const RobotFault> faults);

// All disturbances as keys and values of an experiment: {"noise.proximity.gaussian", "0.02"}, {"faults",
// "3:wheels@500"}.
std::vector<std::pair<std::string, std::string>> DisturbanceTexts(const Disturbances& disturbances);

// What of these disturbances cannot be simulated with so many robots, naming robot, tick and value, or
// nothing.
std::optional<std::string> RefuseDisturbances(const Disturbances& disturbances, std::size_t robots);

}  // namespace gauntlet::sim
