#include "sim/robot/disturber.h"

#include <algorithm>
#include <limits>

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

Disturber::Disturber(const Disturbances& disturbances, std::uint64_t seed, std::size_t robots)
    : seed_(seed), stopped_(robots, kNever), dead_(robots) {
  for (PerDevice& ticks : dead_) ticks.fill(kNever);
  for (const auto& [device, noise] : disturbances.noise) noise_[IndexOf(device)] = noise;
  for (const RobotFault& fault : disturbances.faults) {
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
