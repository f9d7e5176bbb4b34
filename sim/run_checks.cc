#include "sim/run_checks.h"

#include <cmath>

#include "base/number_text.h"

namespace gauntlet::sim {
namespace {

bool FiniteAndNotNegative(double value) {
  return std::isfinite(value) && value >= 0.0;
}

// Why this robot cannot be simulated, or nothing.
std::optional<std::string> RefuseRobot(const Arena& arena, std::size_t index, const RobotSetup& setup) {
  const Vec2& p = setup.pose.position;
  const std::string start =
      "bad-start: " + RobotName(index) + ", tick 0: at " + PointText(p.x(), p.y()) + " m";
  if (!p.allFinite() || !std::isfinite(setup.pose.heading)) {
    return start + ", heading " + NumberText(setup.pose.heading) + "; a pose is finite";
  }
  if (!arena.InInterior(p)) {
    return start + ", outside the walls, whose inner faces are at " +
           PointText(arena.interior_min().x(), arena.interior_min().y()) + " and " +
           PointText(arena.interior_max().x(), arena.interior_max().y()) + " m";
  }
  for (std::size_t box = 0; box < arena.obstacles().size(); ++box) {
    if (Contains(arena.obstacles()[box], p)) return start + ", inside obstacle " + std::to_string(box + 1);
  }
  for (const double range : {setup.camera_range, setup.radio_range}) {
    if (!FiniteAndNotNegative(range)) {
      return "bad-range: " + RobotName(index) + ", tick 0: camera or radio range " + NumberText(range) +
             " m; a range is finite and not negative";
    }
  }
  if (setup.controller == nullptr) return start + ", without a controller";
  const DeviceSet devices = setup.controller->Devices();
  for (const DeviceInfo& info : kDevices) {
    if (!devices.Has(info.device) || setup.equipment.Has(info.device)) continue;
    return "unsupported-device: " + RobotName(index) + " asks in tick 0 for " + std::string(info.key) +
           ", which it does not have";
  }
  return std::nullopt;
}

std::optional<std::string> CheckLights(std::span<const Light> lights, Tick tick) {
  for (std::size_t i = 0; i < lights.size(); ++i) {
    const Light& light = lights[i];
    if (light.position.allFinite() && FiniteAndNotNegative(light.height) &&
        FiniteAndNotNegative(light.intensity)) [[likely]] {
      continue;
    }
    return "invalid-light: light " + std::to_string(i) + ", tick " + std::to_string(tick) + ": at " +
           PointText(light.position.x(), light.position.y()) + " m, height " + NumberText(light.height) +
           " m, intensity " + NumberText(light.intensity) +
           "; a place is finite, a height and an intensity are finite and not negative";
  }
  return std::nullopt;
}

std::optional<std::string> CheckRadioBeacons(std::span<const RadioBeacon> beacons, Tick tick) {
  for (std::size_t i = 0; i < beacons.size(); ++i) {
    const RadioBeacon& beacon = beacons[i];
    if (beacon.position.allFinite() && FiniteAndNotNegative(beacon.range)) [[likely]] {
      continue;
    }
    return "invalid-radio-beacon: radio beacon " + std::to_string(i) + ", tick " + std::to_string(tick) +
           ": at " + PointText(beacon.position.x(), beacon.position.y()) + " m, range " +
           NumberText(beacon.range) + " m; a place is finite, a range is finite and not negative";
  }
  return std::nullopt;
}

std::string InvalidOutcome(const std::string& what, double value, Tick tick) {
  return "invalid-outcome: tick " + std::to_string(tick) + ": the scenario's " + what + " is " +
         NumberText(value) + "; a result is finite";
}

}  // namespace

std::string RobotName(std::size_t robot) {
  return "robot " + std::to_string(robot);
}

std::optional<std::string> RefuseSwarm(const Arena& arena, const std::vector<RobotSetup>& swarm) {
  if (swarm.empty() || swarm.size() > static_cast<std::size_t>(kMaxRobots)) {
    return "swarm-size: " + std::to_string(swarm.size()) + " robots; a run has 1 to " +
           std::to_string(kMaxRobots);
  }
  for (std::size_t i = 0; i < swarm.size(); ++i) {
    if (std::optional<std::string> reason = RefuseRobot(arena, i, swarm[i])) return reason;
  }
  return std::nullopt;
}

std::optional<std::string> CheckSurroundings(const Surroundings& surroundings, Tick tick) {
  if (std::optional<std::string> complaint = CheckLights(surroundings.lights(), tick)) return complaint;
  return CheckRadioBeacons(surroundings.radio_beacons(), tick);
}

std::optional<std::string> CheckOutcome(const Outcome& outcome, Tick tick) {
  if (!outcome.complaint.empty())
    return "invalid-outcome: tick " + std::to_string(tick) + ": " + outcome.complaint;
  if (!std::isfinite(outcome.fitness)) return InvalidOutcome("fitness", outcome.fitness, tick);
  for (const auto& [name, value] : outcome.metrics) {
    if (!std::isfinite(value)) return InvalidOutcome("metric " + name, value, tick);
  }
  return std::nullopt;
}

}  // namespace gauntlet::sim
