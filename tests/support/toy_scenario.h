// A scenario for tests and benchmarks of the simulator: robots whose behaviour is a function.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "sim/arena/arena.h"
#include "sim/geometry/trigonometry.h"
#include "sim/random/random_stream.h"
#include "sim/scenario.h"

namespace gauntlet::sim {

using Behaviour = std::function<void(const ControlStep&)>;
using Beginning = std::function<void(Actuators&)>;

class ToyController final : public Controller {
 public:
  ToyController(DeviceSet devices, Behaviour behaviour, Beginning beginning)
      : devices_(devices), behaviour_(std::move(behaviour)), beginning_(std::move(beginning)) {}
  DeviceSet Devices() const override { return devices_; }
  void Begin(Actuators& actuators) override { beginning_(actuators); }
  void Step(const ControlStep& step) override { behaviour_(step); }

 private:
  DeviceSet devices_;
  Behaviour behaviour_;
  Beginning beginning_;
};

inline constexpr DeviceSet kToyDevices =
    Device::kWheels | Device::kLeds | Device::kProximity | Device::kOmnidirectionalCamera;

struct ToyRobot {
  Pose pose;
  Behaviour behaviour = [](const ControlStep&) {};
  DeviceSet devices = kToyDevices;
  Color beacon = Color::kRed;
  double camera_range = 1.637;  // m
  double radio_range = foot_bot::kRangeAndBearingRange;
  bool bodies_block_radio = true;
  DeviceSet equipment = kAllDevices;
  Beginning beginning = [](Actuators&) {};
  bool under_test = true;
};

// Ends at the tick limit, or after the tick at which `finished` says so. Fitness: mean distance of the robots
// from the origin at the end.
class ToyScenario final : public Scenario {
 public:
  ToyScenario(TestCase test_case, std::vector<ToyRobot> robots, Tick tick_limit)
      : arena_(test_case), robots_(std::move(robots)), tick_limit_(tick_limit) {}

  std::function<bool(const Observer&)> finished = [](const Observer&) { return false; };
  std::function<void(const Interaction&)> interact = [](const Interaction&) {};
  std::function<double(const Vec2&)> floor = [](const Vec2&) { return 1.0; };
  std::vector<Light> lamps;
  std::vector<RadioBeacon> radios;
  std::vector<std::pair<std::string, double>> extra_metrics;
  std::string complaint;

  const Arena& arena() const override { return arena_; }
  Tick tick_limit() const override { return tick_limit_; }
  Result<std::vector<RobotSetup>> CreateSwarm(const Headquarters&) override {
    std::vector<RobotSetup> swarm;
    for (const ToyRobot& robot : robots_) {
      swarm.push_back(
          {.pose = robot.pose,
           .beacon = robot.beacon,
           .camera_range = robot.camera_range,
           .controller = std::make_unique<ToyController>(robot.devices, robot.behaviour, robot.beginning),
           .radio_range = robot.radio_range,
           .bodies_block_radio = robot.bodies_block_radio,
           .equipment = robot.equipment,
           .under_test = robot.under_test});
    }
    return swarm;
  }
  std::span<const Light> lights() const override { return lamps; }
  std::span<const RadioBeacon> radio_beacons() const override { return radios; }
  double FloorGrey(const Vec2& point) const override { return floor(point); }
  void Interact(const Interaction& interaction) override { interact(interaction); }
  bool Finished(const Observer& observer) override { return finished(observer); }
  Outcome Evaluate(const Observer& observer) override {
    Outcome outcome;
    for (const RobotState& state : observer.Latest()) outcome.fitness += state.position().norm();
    outcome.fitness /= observer.robots();
    outcome.metrics = {{"robots", observer.robots()}};
    outcome.metrics.insert(outcome.metrics.end(), extra_metrics.begin(), extra_metrics.end());
    outcome.complaint = complaint;
    outcome.lost.assign(static_cast<std::size_t>(observer.robots()), false);
    return outcome;
  }

 private:
  Arena arena_;
  std::vector<ToyRobot> robots_;
  Tick tick_limit_;
};

// Straight at `speed`, turning at random now and then and away from what the proximity ring sees.
inline Behaviour RandomWalk(double speed) {
  return [speed, turn_ticks = 0, turn_rate = 0.0](const ControlStep& step) mutable {
    if (step.readings.proximity_hits != 0) {
      Vec2 away = Vec2::Zero();
      for (int i = 0; i < foot_bot::kProximitySensors; ++i) {
        away -= step.readings.proximity[static_cast<std::size_t>(i)] * UnitVector(ProximityBearing(i));
      }
      const double bearing = AngleOf(away);
      step.actuators.Drive(std::abs(bearing) > kPi / 2 ? 0.0 : speed, bearing > 0 ? 0.8 : -0.8);
      return;
    }
    if (turn_ticks == 0 && step.random.Chance(0.05)) {
      turn_ticks = static_cast<int>(step.random.Below(25));
      turn_rate = step.random.Chance(0.5) ? 0.8 : -0.8;
    }
    step.actuators.Drive(speed, turn_ticks > 0 ? turn_rate : 0.0);
    if (turn_ticks > 0) --turn_ticks;
  };
}

// Towards the mean of the visible beacons and through whatever stands there: everybody pushes into one crowd.
inline Behaviour Huddle(double speed) {
  return [speed, wander = RandomWalk(speed)](const ControlStep& step) mutable {
    if (step.readings.blobs.empty()) return wander(step);
    Vec2 mean = Vec2::Zero();
    for (const Blob& blob : step.readings.blobs) mean += blob.range * UnitVector(blob.Bearing());
    const double bearing = AngleOf(mean);
    step.actuators.Drive(std::abs(bearing) < 0.5 ? speed : 0.0, bearing > 0 ? 0.8 : -0.8);
  };
}

// `count` obstacles anywhere in the default arena, as the genetic algorithm's first generation has them.
inline Genome RandomObstacles(int count, RandomStream& random) {
  Genome genome;
  for (int i = 0; i < count; ++i) {
    genome.push_back({.x = random.Uniform(-3, 3),
                      .y = random.Uniform(-3, 3),
                      .length = random.Uniform(0.4, 2.0),
                      .width = random.Uniform(0.1, 0.4),
                      .orientation_deg = random.Below(360) * 1.0});
  }
  return genome;
}

// `count` robots in the square of the given half side around `center`, clear of boxes and of each other.
inline std::vector<ToyRobot> RandomRobots(int count, const TestCase& test_case, const Vec2& center,
                                          double half_side, const Behaviour& behaviour,
                                          RandomStream& random) {
  const Arena arena(test_case);
  std::vector<ToyRobot> robots;
  for (int tries = 0; static_cast<int>(robots.size()) < count; ++tries) {
    GAUNTLET_CHECK(tries < 100000, "the robots do not fit");
    const double x = random.Uniform(-1, 1);  // one after the other: arguments have no order
    const double y = random.Uniform(-1, 1);
    const Vec2 p = center + half_side * Vec2(x, y);
    bool clear = arena.InInterior(p);
    for (const OrientedBox& box : arena.boxes()) clear = clear && Distance(box, p) > foot_bot::kRadius + 0.01;
    for (const ToyRobot& robot : robots) clear = clear && (robot.pose.position - p).norm() > 0.18;
    if (clear) robots.push_back({.pose = {p, random.Uniform(-kPi, kPi)}, .behaviour = behaviour});
  }
  return robots;
}

}  // namespace gauntlet::sim
