#include "sim/robot/disturbances.h"

#include <algorithm>
#include <charconv>

#include "base/nearest_name.h"
#include "base/number_text.h"
#include "sim/arena/test_case.h"

namespace gauntlet::sim {
namespace {

constexpr std::string_view kStopped = "stopped";
constexpr RobotIndex kLastRobot = kMaxRobots - 1;
constexpr std::pair<const char*, double DeviceNoise::*> kNoiseValues[] = {
    {"uniform", &DeviceNoise::uniform}, {"gaussian", &DeviceNoise::gaussian}, {"drop", &DeviceNoise::drop}};

Error WrongFault(std::string_view fault, const std::string& why) {
  std::string message = "'";
  return InvalidInput(message.append(fault).append("': ").append(why));
}

// A whole number that fills the text.
std::optional<long long> WholeNumber(std::string_view text) {
  long long value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (text.empty() || error != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return value;
}

Result<RobotFault> ParseFault(std::string_view text) {
  const std::size_t colon = text.find(':');
  const std::size_t at = text.find('@');
  if (colon == std::string_view::npos || at == std::string_view::npos || at < colon) {
    return WrongFault(text, "a fault is written ROBOT:WHAT@TICK, such as 3:wheels@500");
  }
  const std::optional<long long> robot = WholeNumber(text.substr(0, colon));
  if (!robot || *robot < 0 || *robot > kLastRobot) {
    return WrongFault(text, "the robot is a whole number, 0 to " + std::to_string(kLastRobot));
  }
  const std::optional<long long> tick = WholeNumber(text.substr(at + 1));
  if (!tick || *tick < 0 || *tick > kLatestFault) {
    return WrongFault(text, "the tick is a whole number, 0 to " + std::to_string(kLatestFault));
  }
  RobotFault fault = {.robot = static_cast<RobotIndex>(*robot), .tick = static_cast<Tick>(*tick)};
  const std::string_view what = text.substr(colon + 1, at - colon - 1);
  if (what == kStopped) return fault;
  fault.device = DeviceOfKey(what);
  if (fault.device) return fault;
  const std::vector<std::string> names = FaultNames();
  const std::string nearest = NearestName(what, std::vector<std::string_view>(names.begin(), names.end()));
  std::string known;
  for (const std::string& name : names) known.append(known.empty() ? "" : ", ").append(name);
  std::string why = "no device is called '";
  why.append(what).append("'; ");
  if (nearest.empty()) return WrongFault(text, why.append("known: ").append(known));
  return WrongFault(text, why.append("did you mean '").append(nearest).append("'?"));
}

std::string FaultText(const RobotFault& fault) {
  return std::to_string(fault.robot) + ":" + FaultName(fault.device) + "@" + std::to_string(fault.tick);
}

std::optional<std::string> RefuseNoise(Device device, const DeviceNoise& noise) {
  const std::string key = "noise." + KeyOf(device);
  const DeviceInfo& info = kDevices[IndexOf(device)];
  if (info.most_noise == 0.0) return "bad-noise: " + key + ": no noise is defined for this device";
  for (const auto& [name, value] : kNoiseValues) {
    const double most = value != &DeviceNoise::drop ? info.most_noise : info.drops ? 1.0 : 0.0;
    if (noise.*value >= 0.0 && noise.*value <= most) continue;  // NaN is not within anything
    return "bad-noise: " + key + "." + name + " = " + NumberText(noise.*value) + "; 0 to " +
           NumberText(most) + " is possible";
  }
  return std::nullopt;
}

std::optional<std::string> RefuseRandomFaults(const RandomFaults& random, const SwarmSize& swarm) {
  if (random.count == 0) return std::nullopt;
  const bool tested = random.role == FaultyRole::kTested;
  const std::size_t robots = tested ? swarm.under_test : swarm.robots;
  if (random.count < 0 || static_cast<std::size_t>(random.count) > robots) {
    return "bad-fault: random_faults.count = " + std::to_string(random.count) + "; this swarm has " +
           std::to_string(robots) + (tested ? " robots under test, so 0 to " : " robots, so 0 to ") +
           std::to_string(robots) + " of them may be faulty";
  }
  if (random.tick >= 0) return std::nullopt;
  return "bad-fault: random_faults.tick = " + std::to_string(random.tick) + "; ticks count from 0";
}

}  // namespace

std::vector<std::string> FaultNames() {
  std::vector<std::string> names = {std::string(kStopped)};
  for (const DeviceInfo& info : kDevices) names.emplace_back(info.key);
  return names;
}

std::string FaultName(std::optional<Device> device) {
  return device ? KeyOf(*device) : std::string(kStopped);
}

Result<std::vector<RobotFault>> ParseFaults(std::string_view text) {
  std::vector<RobotFault> faults;
  while (true) {
    const std::size_t begin = text.find_first_not_of(' ');
    if (begin == std::string_view::npos) return faults;
    text.remove_prefix(begin);
    const std::size_t end = std::min(text.find(' '), text.size());
    TRY(const RobotFault fault, ParseFault(text.substr(0, end)));
    faults.push_back(fault);
    text.remove_prefix(end);
  }
}

std::string FaultsText(std::span<const RobotFault> faults) {
  std::string text;
  for (const RobotFault& fault : faults) text.append(text.empty() ? "" : " ").append(FaultText(fault));
  return text;
}

std::vector<std::pair<std::string, std::string>> DisturbanceTexts(const Disturbances& disturbances) {
  std::vector<std::pair<std::string, std::string>> texts;
  for (const auto& [device, noise] : disturbances.noise) {
    for (const auto& [name, value] : kNoiseValues) {
      if (noise.*value == 0.0) continue;
      texts.emplace_back("noise." + KeyOf(device) + "." + name, NumberText(noise.*value));
    }
  }
  if (!disturbances.faults.empty()) texts.emplace_back("faults", FaultsText(disturbances.faults));
  const RandomFaults& random = disturbances.random_faults;
  if (random.count == 0) return texts;
  texts.emplace_back("random_faults.count", std::to_string(random.count));
  texts.emplace_back("random_faults.what", FaultName(random.device));
  texts.emplace_back("random_faults.tick", std::to_string(random.tick));
  texts.emplace_back("random_faults.role", kFaultyRoles.at(static_cast<std::size_t>(random.role)));
  return texts;
}

std::optional<std::string> RefuseDisturbances(const Disturbances& disturbances, const SwarmSize& swarm) {
  for (const auto& [device, noise] : disturbances.noise) {
    if (std::optional<std::string> reason = RefuseNoise(device, noise)) return reason;
  }
  for (const RobotFault& fault : disturbances.faults) {
    if (fault.robot >= 0 && static_cast<std::size_t>(fault.robot) < swarm.robots && fault.tick >= 0) {
      continue;
    }
    return "bad-fault: " + FaultText(fault) + ": robot " + std::to_string(fault.robot) + ", tick " +
           std::to_string(fault.tick) + "; this swarm has robots 0 to " + std::to_string(swarm.robots - 1) +
           ", ticks count from 0";
  }
  return RefuseRandomFaults(disturbances.random_faults, swarm);
}

}  // namespace gauntlet::sim
