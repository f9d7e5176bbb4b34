#include "sim/sensors/sensor_suite.h"

#include <algorithm>
#include <bit>
#include <cstdint>

#include "sim/sensors/sensor_table.h"

namespace gauntlet::sim {
namespace {

bool SameBits(double a, double b) {
  return std::bit_cast<std::uint64_t>(a) == std::bit_cast<std::uint64_t>(b);
}

}  // namespace

SensorSuite::SensorSuite(const Arena& arena, std::span<const RobotSensors> robots)
    : frames_(robots.size()),
      positions_(robots.size()),
      readings_(robots.size()),
      occluders_(arena),
      pairs_(robots, arena.fixed_boxes()) {
  for (const RobotSensors& robot : robots) anybodys_devices_ = anybodys_devices_ | robot.devices;
  for (const SensorKind& kind : kSensorKinds) {
    if (!anybodys_devices_.Has(kind.device)) continue;
    equipment_.push_back({kind.device, kind.make(arena, robots), {}});
    for (std::size_t i = 0; i < robots.size(); ++i) {
      if (robots[i].devices.Has(kind.device)) equipment_.back().robots.push_back(static_cast<RobotIndex>(i));
    }
  }
}

void SensorSuite::Sense(const World& world) {
  for (std::size_t i = 0; i < frames_.size(); ++i) {
    // Most drive straight on or stand.
    if (SameBits(world.poses[i].heading, frames_[i].heading)) {
      frames_[i].position = world.poses[i].position;
    } else {
      frames_[i] = BodyFrame(world.poses[i]);
    }
    positions_[i] = world.poses[i].position;
  }
  if (!world.moving_boxes.empty()) occluders_.SetMoving(world.moving_boxes);
  const bool camera = anybodys_devices_.Has(Device::kOmnidirectionalCamera);
  const bool any_ring_lit = camera && anybodys_devices_.Has(Device::kLeds) &&
                            std::any_of(world.signals.begin(), world.signals.end(),
                                        [](const Signals& signals) { return signals.RingLit(); });
  if (camera || anybodys_devices_.Has(Device::kRangeAndBearing)) {
    pairs_.Update(positions_, world.signals, occluders_, any_ring_lit);
  }
  const Scene scene = {world, frames_, positions_, occluders_, pairs_, any_ring_lit};
  for (const auto& [device, sensor, robots] : equipment_) {
    if (world.probe != nullptr) world.probe->BeginDevice(device);
    sensor->Prepare(scene);
    for (const RobotIndex robot : robots) {
      SensorReadings& readings = readings_[static_cast<std::size_t>(robot)];
      if (!world.attention.empty() && !world.attention[static_cast<std::size_t>(robot)].Has(device)) {
        sensor->Blank(robot, readings);
        continue;
      }
      sensor->Read(scene, robot, readings);
      if (world.disturber == nullptr) continue;
      if (world.disturber->Dead(robot, device, world.tick)) {
        sensor->Blank(robot, readings);
      } else if (world.disturber->Noisy(device)) {
        DeviceErrors errors = world.disturber->ErrorsOf(robot, device, world.tick);
        sensor->Disturb(scene, robot, errors, readings);
      }
    }
  }
}

}  // namespace gauntlet::sim
