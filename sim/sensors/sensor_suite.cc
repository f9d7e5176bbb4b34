#include "sim/sensors/sensor_suite.h"

#include "sim/sensors/proximity.h"

namespace gauntlet::sim {
namespace {

std::vector<double> CameraRanges(std::span<const SensorSuite::RobotSensors> robots) {
  std::vector<double> ranges;
  for (const SensorSuite::RobotSensors& robot : robots) {
    ranges.push_back(robot.devices.Has(Device::kOmnidirectionalCamera) ? robot.camera_range : 0.0);
  }
  return ranges;
}

}  // namespace

SensorSuite::SensorSuite(const Arena& arena, std::span<const RobotSensors> robots)
    : sensors_(robots.begin(), robots.end()),
      frames_(robots.size()),
      readings_(robots.size()),
      nearby_(foot_bot::kRadius + foot_bot::kProximityRange),
      cameras_(arena, CameraRanges(robots)) {
  for (const OrientedBox& box : arena.boxes()) nearby_.AddBox(box);
  nearby_.SetRobots(static_cast<int>(robots.size()));
  for (const RobotSensors& robot : robots) {
    any_camera_ = any_camera_ || robot.devices.Has(Device::kOmnidirectionalCamera);
  }
}

void SensorSuite::Sense(std::span<const Pose> poses, std::span<const Color> beacons) {
  for (std::size_t i = 0; i < poses.size(); ++i) frames_[i] = BodyFrame(poses[i]);
  if (any_camera_) cameras_.Look(frames_, beacons);
  for (std::size_t i = 0; i < poses.size(); ++i) {
    const RobotIndex robot = static_cast<RobotIndex>(i);
    if (sensors_[i].devices.Has(Device::kProximity)) SenseProximity(robot);
    if (any_camera_) readings_[i].blobs = cameras_.BlobsOf(robot);
  }
}

void SensorSuite::SenseProximity(RobotIndex robot) {
  const std::size_t index = static_cast<std::size_t>(robot);
  const BodyFrame& self = frames_[index];
  ProximityRing ring(self);
  for (const std::size_t box : nearby_.Near(robot, self.position)) ring.See(nearby_.box(box));
  for (std::size_t other = 0; other < frames_.size(); ++other) {
    if (other != index) ring.See(frames_[other]);
  }
  SensorReadings& readings = readings_[index];
  if (!ring.active() && !readings.proximity_active) return;
  readings.proximity = ring.Readings();
  readings.proximity_active = ring.active();
}

}  // namespace gauntlet::sim
