// Carries the disturbances of a run out: errors in what robots read and do, and faults. A simulation without
// disturbances has none.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "sim/robot/controller.h"
#include "sim/robot/disturbances.h"
#include "sim/robot/grippers.h"

namespace gauntlet::sim {

// The errors of one device of one robot in one tick. Their numbers depend on nothing else.
class DeviceErrors {
 public:
  DeviceErrors(const DeviceNoise& noise, const RandomStream& random) : noise_(noise), random_(random) {}

  // The next error, in the unit of the device.
  double Draw();
  // Adds an error to each of these readings, which stay in [0, 1].
  void AddTo(std::span<double> readings);
  // Loses some of what is seen or heard and shifts all others in random directions, each by an error times
  // `scale(one)` metres. What is left stands at the beginning of `all`.
  template <typename Seen, typename Scale>
  std::span<Seen> Scatter(std::span<Seen> all, const Scale& scale) {
    std::size_t left = 0;
    for (Seen one : all) {
      const bool lost = noise_.drop > 0.0 && random_.Chance(noise_.drop);
      if (noise_.uniform > 0.0 || noise_.gaussian > 0.0) {
        const double error = scale(one) * Draw();
        one.position += error * UnitVector(2.0 * kPi * random_.Uniform());
        one.range = std::sqrt(one.position.squaredNorm());
      }
      if (!lost) all[left++] = one;
    }
    return all.first(left);
  }

 private:
  const DeviceNoise& noise_;
  RandomStream random_;
};

// The faults of different robots that a run's seed draws, each of the role's robots as likely as another, in
// the order of the robots. `under_test`: per robot, whether it is of the controller under test; of the role
// there are as many as are drawn or more.
std::vector<RobotFault> DrawFaults(const RandomFaults& random, const std::vector<bool>& under_test,
                                   std::uint64_t seed);

class Disturber {
 public:
  // Disturbances that RefuseDisturbances lets pass; `under_test` as for DrawFaults. Afterwards nothing is
  // allocated.
  Disturber(const Disturbances& disturbances, std::uint64_t seed, const std::vector<bool>& under_test);

  // The whole robot is dead in this tick.
  bool Stopped(RobotIndex robot, Tick tick) const { return tick >= stopped_[Index(robot)]; }
  // The device is; of a robot that stopped, its wheels, LEDs and radio are.
  bool Dead(RobotIndex robot, Device device, Tick tick) const {
    return tick >= dead_[Index(robot)][IndexOf(device)];
  }
  bool Noisy(Device device) const { return noise_[IndexOf(device)].Any(); }
  DeviceErrors ErrorsOf(RobotIndex robot, Device device, Tick tick) const;

  // What the commands of a robot become in this tick.
  struct Action {
    WheelSpeeds& wheels;
    Signals& signals;
    Grippers& grippers;
  };
  void DisturbAction(RobotIndex robot, Tick tick, const Action& action) const;

 private:
  using PerDevice = std::array<Tick, kDevices.size()>;

  static std::size_t Index(RobotIndex robot) { return static_cast<std::size_t>(robot); }

  std::uint64_t seed_;
  std::array<DeviceNoise, kDevices.size()> noise_{};
  std::vector<Tick> stopped_;    // per robot: from this tick on
  std::vector<PerDevice> dead_;  // per robot: from these ticks on
};

}  // namespace gauntlet::sim
