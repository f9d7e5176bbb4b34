// What may be wrong with the robots of a run: noise of their devices and faults of single robots. The thesis
// ignores both (3.3.2) and so does every shipped experiment; without them they cost nothing.
#pragma once

#include <array>
#include <cstddef>
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

// Of which robots those are drawn that have a random fault.
enum class FaultyRole { kTested, kAll };  // of the controller under test; also those of the scenario

// So many robots of each run have this fault. The run's seed decides which (DrawFaults).
struct RandomFaults {
  int count = 0;
  std::optional<Device> device = std::nullopt;  // nothing: the whole robot
  Tick tick = 0;
  FaultyRole role = FaultyRole::kTested;

  bool operator==(const RandomFaults&) const = default;
};

struct Disturbances {
  std::map<Device, DeviceNoise> noise = {};  // only devices with some
  std::vector<RobotFault> faults = {};
  RandomFaults random_faults = {};  // beside those

  bool None() const { return noise.empty() && faults.empty() && random_faults.count == 0; }
  bool operator==(const Disturbances&) const = default;
};

// The latest tick that a fault may begin at.
inline constexpr Tick kLatestFault = 1'000'000'000;
// What may fail: "stopped", which is the whole robot, and the keys of all devices.
std::vector<std::string> FaultNames();
std::string FaultName(std::optional<Device> device);
// As an experiment calls it: "tested", "all".
inline constexpr std::array<const char*, 2> kFaultyRoles = {"tested", "all"};

// "3:wheels@500 7:stopped@0": ROBOT:WHAT@TICK, several with spaces between them. WHAT is a device or
// `stopped`. Error: what is malformed, unknown (with the nearest known name) or out of range.
Result<std::vector<RobotFault>> ParseFaults(std::string_view text);
std::string FaultsText(std::span<const RobotFault> faults);

// All disturbances as keys and values of an experiment: {"noise.proximity.gaussian", "0.02"}, {"faults",
// "3:wheels@500"}.
std::vector<std::pair<std::string, std::string>> DisturbanceTexts(const Disturbances& disturbances);

struct SwarmSize {
  std::size_t robots = 0;
  std::size_t under_test = 0;  // of these, of the controller under test
};
// What of these disturbances cannot be simulated with such a swarm, naming robot, tick and value, or nothing.
std::optional<std::string> RefuseDisturbances(const Disturbances& disturbances, const SwarmSize& swarm);

}  // namespace gauntlet::sim
