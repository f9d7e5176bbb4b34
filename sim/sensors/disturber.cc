#include "sim/sensors/disturber.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/check.h"
#include "sim/sensors/ground_sensor.h"

namespace gauntlet::sim {
namespace {

constexpr Tick kNever = std::numeric_limits<Tick>::max();
constexpr std::size_t kMostRays = 12;  // of the distance scanner in a tick, of either range

double DrawError(const DeviceNoise& noise, RandomStream& random) {
  double error = 0.0;
  if (noise.uniform > 0.0) error += noise.uniform * (2.0 * random.Uniform() - 1.0);
  if (noise.gaussian > 0.0) error += noise.gaussian * random.Gaussian();
  return error;
}

// Something seen or heard, shifted by `error` (m) in a random direction.
template <typename Seen>
void Shift(double error, RandomStream& random, Seen& seen) {
  seen.position += error * UnitVector(2.0 * kPi * random.Uniform());
  seen.range = std::sqrt(seen.position.squaredNorm());
}

bool HasErrors(const DeviceNoise& noise) {
  return noise.uniform > 0.0 || noise.gaussian > 0.0;
}

}  // namespace

Disturber::Disturber(const Disturbances& disturbances, std::uint64_t seed, std::size_t robots,
                     const Surroundings& surroundings, std::size_t obstacle_lights)
    : seed_(seed), surroundings_(surroundings), stopped_(robots, kNever), dead_(robots) {
  for (PerDevice& ticks : dead_) ticks.fill(kNever);
  for (const auto& [device, noise] : disturbances.noise) noise_[IndexOf(device)] = noise;
  for (const RobotFault& fault : disturbances.faults) {
    const std::size_t robot = Index(fault.robot);
    GAUNTLET_CHECK(robot < robots, "a fault of a robot that is not there");
    if (fault.device) {
      Tick& dead = dead_[robot][IndexOf(*fault.device)];
      dead = std::min(dead, fault.tick);
    } else {
      stopped_[robot] = std::min(stopped_[robot], fault.tick);
    }
  }
  for (std::size_t robot = 0; robot < robots; ++robot) {
    for (const Device device : {Device::kWheels, Device::kLeds, Device::kRangeAndBearing}) {
      Tick& dead = dead_[robot][IndexOf(device)];
      dead = std::min(dead, stopped_[robot]);
    }
  }
  blobs_.reserve(robots * (1 + foot_bot::kRingLeds) + surroundings.lights().size() + obstacle_lights);
  messages_.reserve(robots + surroundings.radio_beacons().size());
  short_.reserve(kMostRays);
  long_.reserve(kMostRays);
}

RandomStream Disturber::Stream(RobotIndex robot, Device device, Tick tick) const {
  const auto purpose = static_cast<std::uint32_t>(StreamPurpose::kFirstDeviceNoise) +
                       static_cast<std::uint32_t>(IndexOf(device));
  return {seed_, static_cast<StreamPurpose>(purpose), static_cast<std::uint32_t>(robot),
          static_cast<std::uint32_t>(tick)};
}

void Disturber::DisturbAction(RobotIndex robot, Tick tick, const Action& action) const {
  if (Dead(robot, Device::kWheels, tick)) {
    action.wheels = {};
  } else if (HasErrors(NoiseOf(Device::kWheels))) {
    RandomStream random = Stream(robot, Device::kWheels, tick);
    for (double* const speed : {&action.wheels.left, &action.wheels.right}) {
      *speed = std::clamp(*speed * (1.0 + DrawError(NoiseOf(Device::kWheels), random)),
                          -foot_bot::kMaxWheelSpeed, foot_bot::kMaxWheelSpeed);
    }
  }
  if (Dead(robot, Device::kLeds, tick)) {
    action.signals.beacon = Color::kBlack;
    action.signals.ring.fill(Color::kBlack);
  }
  action.signals.silent = Dead(robot, Device::kRangeAndBearing, tick);
  if (action.signals.silent) action.signals.message = {};
  if (Dead(robot, Device::kGripper, tick)) action.grippers.SetClosed(robot, false);
}

const SensorReadings& Disturber::DisturbReadings(RobotIndex robot, Tick tick, const DeviceSet& devices,
                                                 const Pose& pose, const SensorReadings& readings) {
  readings_ = readings;
  if (devices.Has(Device::kProximity)) {
    DisturbShares(robot, Device::kProximity, tick, readings_.proximity);
    readings_.proximity_hits = 0;
    for (std::size_t i = 0; i < readings_.proximity.size(); ++i) {
      if (readings_.proximity[i] != 0.0) readings_.proximity_hits |= 1u << i;
    }
  }
  if (devices.Has(Device::kLight)) DisturbShares(robot, Device::kLight, tick, readings_.light);
  if (devices.Has(Device::kMotorGround)) {
    DisturbShares(robot, Device::kMotorGround, tick, readings_.motor_ground);
  }
  if (devices.Has(Device::kBaseGround)) DisturbBaseGround(robot, tick, pose);
  if (devices.Has(Device::kOmnidirectionalCamera)) DisturbBlobs(robot, tick);
  if (devices.Has(Device::kRangeAndBearing)) DisturbMessages(robot, tick);
  if (devices.Has(Device::kDistanceScanner)) DisturbScanner(robot, tick);
  if (Dead(robot, Device::kGripper, tick)) readings_.holding_item = false;
  return readings_;
}

template <std::size_t kCount>
void Disturber::DisturbShares(RobotIndex robot, Device device, Tick tick,
                              std::array<double, kCount>& readings) const {
  if (Dead(robot, device, tick)) {
    readings.fill(0.0);
  } else if (const DeviceNoise& noise = NoiseOf(device); HasErrors(noise)) {
    RandomStream random = Stream(robot, device, tick);
    for (double& reading : readings) reading = std::clamp(reading + DrawError(noise, random), 0.0, 1.0);
  }
}

void Disturber::DisturbBaseGround(RobotIndex robot, Tick tick, const Pose& pose) {
  const DeviceNoise& noise = NoiseOf(Device::kBaseGround);
  if (Dead(robot, Device::kBaseGround, tick)) {
    readings_.base_ground.fill(false);
  } else if (HasErrors(noise)) {
    RandomStream random = Stream(robot, Device::kBaseGround, tick);
    const auto grey = SenseGround(BodyFrame(pose), kBaseGroundPlaces, surroundings_);
    for (std::size_t i = 0; i < grey.size(); ++i) {
      readings_.base_ground[i] = grey[i] + DrawError(noise, random) >= 0.5;
    }
  }
}

void Disturber::DisturbBlobs(RobotIndex robot, Tick tick) {
  const DeviceNoise& noise = NoiseOf(Device::kOmnidirectionalCamera);
  if (Dead(robot, Device::kOmnidirectionalCamera, tick)) {
    readings_.blobs = {};
  } else if (noise.Any()) {
    RandomStream random = Stream(robot, Device::kOmnidirectionalCamera, tick);
    blobs_.clear();
    for (Blob blob : readings_.blobs) {
      const bool lost = noise.drop > 0.0 && random.Chance(noise.drop);
      if (HasErrors(noise)) {
        const double error = blob.range * DrawError(noise, random);
        Shift(error, random, blob);
      }
      if (!lost) blobs_.push_back(blob);
    }
    readings_.blobs = blobs_;
  }
}

void Disturber::DisturbMessages(RobotIndex robot, Tick tick) {
  const DeviceNoise& noise = NoiseOf(Device::kRangeAndBearing);
  if (Dead(robot, Device::kRangeAndBearing, tick)) {
    readings_.range_and_bearing = {};
  } else if (noise.Any()) {
    RandomStream random = Stream(robot, Device::kRangeAndBearing, tick);
    messages_.clear();
    for (Message message : readings_.range_and_bearing) {
      const bool lost = noise.drop > 0.0 && random.Chance(noise.drop);
      if (HasErrors(noise)) {
        const double error = DrawError(noise, random);
        Shift(error, random, message);
      }
      if (!lost) messages_.push_back(message);
    }
    readings_.range_and_bearing = messages_;
  }
}

void Disturber::DisturbScanner(RobotIndex robot, Tick tick) {
  const DeviceNoise& noise = NoiseOf(Device::kDistanceScanner);
  const bool dead = Dead(robot, Device::kDistanceScanner, tick);
  if (!dead && !HasErrors(noise)) return;
  RandomStream random = Stream(robot, Device::kDistanceScanner, tick);
  short_.assign(readings_.scanner_short.begin(), readings_.scanner_short.end());
  long_.assign(readings_.scanner_long.begin(), readings_.scanner_long.end());
  for (std::vector<ScannerReading>* const rays : {&short_, &long_}) {
    for (ScannerReading& ray : *rays) {
      const bool hit = ray.distance >= 0.0;
      if (dead) ray.distance = ScannerReading::kNothing;
      if (!dead && hit) ray.distance = std::max(ray.distance + DrawError(noise, random), 0.0);
    }
  }
  readings_.scanner_short = short_;
  readings_.scanner_long = long_;
}

}  // namespace gauntlet::sim
