#include "sim/sensors/sensor_suite.h"

#include <algorithm>

#include "base/bits.h"
#include "sim/sensors/ground_sensor.h"
#include "sim/sensors/light_sensor.h"
#include "sim/sensors/proximity.h"

namespace gauntlet::sim {
namespace {

using RobotSensors = SensorSuite::RobotSensors;

// Up to this many robots it costs less to ask every robot than to keep a grid.
constexpr std::size_t kFewRobots = 40;
constexpr double kBodyReach =
    2.0 * foot_bot::kRadius + foot_bot::kProximityRange + foot_bot::kGripperRadius;  // m, centre to centre

double CameraRange(const RobotSensors& robot) {
  return robot.devices.Has(Device::kOmnidirectionalCamera) ? robot.camera_range : 0.0;
}

double RadioRange(const RobotSensors& robot) {
  return robot.devices.Has(Device::kRangeAndBearing) ? robot.radio_range : 0.0;
}

std::vector<double> CameraRanges(std::span<const RobotSensors> robots) {
  std::vector<double> ranges;
  for (const RobotSensors& robot : robots) ranges.push_back(CameraRange(robot));
  return ranges;
}

std::vector<RobotPairs::Reach> Reaches(std::span<const RobotSensors> robots) {
  std::vector<RobotPairs::Reach> reaches;
  for (const RobotSensors& robot : robots) {
    reaches.push_back({.camera = CameraRange(robot), .radio = RadioRange(robot)});
  }
  return reaches;
}

std::vector<Radios::Radio> RadiosOf(std::span<const RobotSensors> robots) {
  std::vector<Radios::Radio> radios;
  for (const RobotSensors& robot : robots) {
    radios.push_back({.range = RadioRange(robot), .bodies_block = robot.bodies_block_radio});
  }
  return radios;
}

}  // namespace

SensorSuite::SensorSuite(const Arena& arena, std::span<const RobotSensors> robots)
    : sensors_(robots.begin(), robots.end()),
      frames_(robots.size()),
      readings_(robots.size()),
      nearby_(foot_bot::kRadius + foot_bot::kProximityRange),
      near_(std::min(robots.size(), kFewRobots)),
      proximity_grid_(kBodyReach, robots.size()),
      occluders_(arena),
      pairs_(Reaches(robots)),
      cameras_(CameraRanges(robots)),
      radios_(RadiosOf(robots)),
      boxes_(arena.fixed_boxes()) {
  for (const OrientedBox& box : arena.fixed_boxes()) nearby_.AddBox(box);
  boxes_.resize(boxes_.size() + arena.moving().size());
  nearby_.SetRobots(static_cast<int>(robots.size()));
  for (const RobotSensors& robot : robots) anybodys_devices_ = anybodys_devices_ | robot.devices;
  if (anybodys_devices_.Has(Device::kDistanceScanner)) scanners_.resize(robots.size());
}

void SensorSuite::Sense(const World& world) {
  for (std::size_t i = 0; i < frames_.size(); ++i) frames_[i] = BodyFrame(world.poses[i]);
  if (!world.moving_boxes.empty()) {
    occluders_.SetMoving(world.moving_boxes);
    std::copy(world.moving_boxes.begin(), world.moving_boxes.end(),
              boxes_.end() - std::ssize(world.moving_boxes));
  }
  SenseOthers(world);
  if (anybodys_devices_.Has(Device::kProximity)) FindNear();
  for (std::size_t i = 0; i < frames_.size(); ++i) {
    const RobotIndex robot = static_cast<RobotIndex>(i);
    if (sensors_[i].devices.Has(Device::kProximity)) SenseProximity(world, robot);
    SenseRest(world, robot);
  }
}

// What needs to know where robots are from each other.
void SensorSuite::SenseOthers(const World& world) {
  const bool camera = anybodys_devices_.Has(Device::kOmnidirectionalCamera);
  const bool radio = anybodys_devices_.Has(Device::kRangeAndBearing);
  if (!camera && !radio) return;
  bool any_ring_lit = false;
  if (camera && anybodys_devices_.Has(Device::kLeds)) {
    any_ring_lit = std::any_of(world.signals.begin(), world.signals.end(),
                               [](const Signals& signals) { return signals.RingLit(); });
  }
  occluders_.Frame(frames_);
  pairs_.Update(frames_, occluders_, any_ring_lit);
  if (camera) {
    cameras_.Look({.robots = frames_,
                   .occluders = occluders_,
                   .pairs = pairs_,
                   .signals = world.signals,
                   .any_ring_lit = any_ring_lit,
                   .lights = world.surroundings.lights(),
                   .obstacle_lights = world.obstacle_lights});
  }
  if (radio) {
    radios_.Listen({.robots = frames_,
                    .occluders = occluders_,
                    .pairs = pairs_,
                    .signals = world.signals,
                    .beacons = world.surroundings.radio_beacons()});
  }
  for (std::size_t i = 0; i < frames_.size(); ++i) {
    const RobotIndex robot = static_cast<RobotIndex>(i);
    if (camera) readings_[i].blobs = cameras_.BlobsOf(robot);
    if (radio) readings_[i].range_and_bearing = radios_.MessagesOf(robot);
  }
}

// Who could be in reach of whose proximity ring.
void SensorSuite::FindNear() {
  if (frames_.size() > kFewRobots) {
    proximity_grid_.Update(frames_);
    return;
  }
  std::fill(near_.begin(), near_.end(), std::uint64_t{0});
  for (std::size_t a = 0; a < frames_.size(); ++a) {
    const Vec2 position = frames_[a].position;
    for (std::size_t b = 0; b < a; ++b) {
      const std::uint64_t near = (frames_[b].position - position).squaredNorm() < kBodyReach * kBodyReach;
      near_[a] |= near << b;
      near_[b] |= near << a;
    }
  }
}

void SensorSuite::SenseProximity(const World& world, RobotIndex robot) {
  const std::size_t index = static_cast<std::size_t>(robot);
  const BodyFrame& self = frames_[index];
  ProximityRing ring(self);
  for (const std::size_t box : nearby_.Near(robot, self.position)) ring.See(nearby_.box(box));
  for (const OrientedBox& box : world.moving_boxes) ring.See(box);
  if (frames_.size() <= kFewRobots) {
    ForEachBit(near_[index], [&](std::size_t other) { ring.See(frames_[other]); });
  } else {
    for (const std::size_t other : proximity_grid_.Near(self.position)) {
      if (other != index) ring.See(frames_[other]);
    }
  }
  SensorReadings& readings = readings_[index];
  ForEachBit(readings.proximity_hits & ~ring.hits(),
             [&](std::size_t sensor) { readings.proximity[sensor] = 0.0; });
  ForEachBit(ring.hits(), [&](std::size_t sensor) { readings.proximity[sensor] = ring.Reading(sensor); });
  readings.proximity_hits = ring.hits();
}

void SensorSuite::SenseRest(const World& world, RobotIndex robot) {
  const std::size_t index = static_cast<std::size_t>(robot);
  const DeviceSet& devices = sensors_[index].devices;
  const BodyFrame& self = frames_[index];
  SensorReadings& readings = readings_[index];
  if (devices.Has(Device::kLight)) {
    readings.light = SenseLight(frames_, robot, world.surroundings.lights(), occluders_);
  }
  if (devices.Has(Device::kMotorGround)) {
    readings.motor_ground = SenseGround(self, kMotorGroundPlaces, world.surroundings);
  }
  if (devices.Has(Device::kBaseGround)) {
    const auto grey = SenseGround(self, kBaseGroundPlaces, world.surroundings);
    std::transform(grey.begin(), grey.end(), readings.base_ground.begin(),
                   [](double value) { return value >= 0.5; });
  }
  if (devices.Has(Device::kDistanceScanner)) {
    scanners_[index].Scan(world.actuators[index].scanner, frames_, robot, boxes_);
    readings.scanner_short = scanners_[index].short_range();
    readings.scanner_long = scanners_[index].long_range();
  }
  if (devices.Has(Device::kGripper)) readings.holding_item = world.grippers.Holds(robot);
}

}  // namespace gauntlet::sim
