#include "sim/robot/disturber.h"

#include <algorithm>
#include <limits>
#include <utility>

#include "base/check.h"

namespace gauntlet::sim {
namespace {

constexpr Tick kNever = std::numeric_limits<Tick>::max();

}  // namespace

double DeviceErrors::Draw() {
  double error = 0.0;
  if (noise_.uniform > 0.0) error += noise_.uniform * (2.0 * random_.Uniform() - 1.0);
  if (noise_.gaussian > 0.0) error += noise_.gaussian * random_.Gaussian();
  return error;
}

void DeviceErrors::AddTo(std::span<double> readings) {
  for (double& reading : readings) reading = std::clamp(reading + Draw(), 0.0, 1.0);
}

std::vector<RobotFault> DrawFaults(const RandomFaults& random, const std::vector<bool>& under_test,
                                   std::uint64_t seed) {
  std::vector<RobotIndex> robots;
  for (std::size_t i = 0; i < under_test.size(); ++i) {
    if (random.role == FaultyRole::kAll || under_test[i]) robots.push_back(static_cast<RobotIndex>(i));
  }
  const auto count = static_cast<std::size_t>(random.count);
  GAUNTLET_CHECK(count <= robots.size(), "more faulty robots than there are");
  RandomStream stream(seed, StreamPurpose::kFaultyRobots);
  for (std::size_t i = 0; i < count; ++i)
    std::swap(robots[i], robots[i + stream.Below(static_cast<std::uint32_t>(robots.size() - i))]);
  robots.resize(count);
  std::ranges::sort(robots);
  std::vector<RobotFault> faults;
  for (const RobotIndex robot : robots)
    faults.push_back({.robot = robot, .device = random.device, .tick = random.tick});
  return faults;
}

Disturber::Disturber(const Disturbances& disturbances, std::uint64_t seed,
                     const std::vector<bool>& under_test)
    : seed_(seed), stopped_(under_test.size(), kNever), dead_(under_test.size()) {
  const std::size_t robots = under_test.size();
  for (PerDevice& ticks : dead_) ticks.fill(kNever);
  for (const auto& [device, noise] : disturbances.noise) noise_[IndexOf(device)] = noise;
  std::vector<RobotFault> faults = DrawFaults(disturbances.random_faults, under_test, seed);
  faults.insert(faults.end(), disturbances.faults.begin(), disturbances.faults.end());
  for (const RobotFault& fault : faults) {
    const std::size_t robot = Index(fault.robot);
    GAUNTLET_CHECK(robot < robots, "a fault of a robot that is not there");
    Tick& dead = fault.device ? dead_[robot][IndexOf(*fault.device)] : stopped_[robot];
    dead = std::min(dead, fault.tick);
  }
  for (std::size_t robot = 0; robot < robots; ++robot) {
    for (const Device device : {Device::kWheels, Device::kLeds, Device::kRangeAndBearing}) {
      Tick& dead = dead_[robot][IndexOf(device)];
      dead = std::min(dead, stopped_[robot]);
    }
  }
}

DeviceErrors Disturber::ErrorsOf(RobotIndex robot, Device device, Tick tick) const {
  const auto purpose =
      static_cast<std::uint32_t>(StreamPurpose::kFirstDeviceNoise) + static_cast<std::uint32_t>(device);
  return {noise_[IndexOf(device)],
          RandomStream(seed_, static_cast<StreamPurpose>(purpose), static_cast<std::uint32_t>(robot),
                       static_cast<std::uint32_t>(tick))};
}

void Disturber::DisturbAction(RobotIndex robot, Tick tick, const Action& action) const {
  if (Dead(robot, Device::kWheels, tick)) {
    action.wheels = {};
  } else if (Noisy(Device::kWheels)) {
    DeviceErrors errors = ErrorsOf(robot, Device::kWheels, tick);
    for (double* const speed : {&action.wheels.left, &action.wheels.right}) {
      *speed =
          std::clamp(*speed * (1.0 + errors.Draw()), -foot_bot::kMaxWheelSpeed, foot_bot::kMaxWheelSpeed);
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

}  // namespace gauntlet::sim
