// The light flocking example as a source for ARGoS against the same behaviour written for Gauntlet, and
// against ARGoS.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <vector>

#include "controllers/common/proximity.h"
#include "controllers/examples/light_flocking_registry.h"
#include "controllers/examples/light_flocking_scenario.h"
#include "controllers/registry.h"
#include "sim/simulation.h"
#include "tests/argos/light_flocking_form.h"

namespace gauntlet::argos_form {
namespace {

using controllers::ControllerContext;
using controllers::ControllerFactory;
using controllers::light_flocking::kFlockmateColor;
using controllers::light_flocking::LightFlockingScenario;
using controllers::light_flocking::LightFlockingScenarioParameters;
using controllers::light_flocking::Turning;
using sim::Device;
using sim::Vec2;

constexpr double kTargetDistance = 75.0;  // cm
constexpr double kGain = 1000.0;          // cm^2/s
constexpr double kMaxSpeed = 10.0;        // cm/s

// What argos/example/light_flocking.cc does, step by step in centimetres, written for Gauntlet.
class CentimetreFlocker final : public sim::Controller {
 public:
  sim::DeviceSet Devices() const override {
    return Device::kWheels | Device::kLeds | Device::kOmnidirectionalCamera | Device::kLight;
  }

  void Step(const sim::ControlStep& step) override {
    step.actuators.beacon = kFlockmateColor;
    Drive(Flock(step.readings.blobs) + SeekLight(step.readings.light), step.actuators);
  }

 private:
  static double Attraction(double distance) {
    const double far = std::max(distance, 1.0);
    const double ratio = kTargetDistance / far;
    const double term = ratio * ratio;
    return kGain / far * (term - term * term);
  }

  static Vec2 Flock(std::span<const sim::Blob> blobs) {
    Vec2 sum = Vec2::Zero();
    int count = 0;
    for (const sim::Blob& blob : blobs) {
      const double distance = blob.range * 100.0;
      if (blob.color != kFlockmateColor || distance >= 1.8 * kTargetDistance) continue;
      if (distance > 0.0) sum += Attraction(distance) * Vec2(blob.position / blob.range);
      ++count;
    }
    if (count == 0) return Vec2::Zero();
    sum /= count;
    const double speed = std::sqrt(sum.squaredNorm());
    return speed > kMaxSpeed ? Vec2(sum * (kMaxSpeed / speed)) : sum;
  }

  static Vec2 SeekLight(std::span<const double> readings) {
    Vec2 sum = Vec2::Zero();
    for (std::size_t i = 0; i < readings.size(); ++i) {
      sum += readings[i] * sim::UnitVector(sim::ProximityBearing(static_cast<int>(i)));
    }
    const double length = std::sqrt(sum.squaredNorm());
    return length > 0.0 ? Vec2(sum * (0.25 * kMaxSpeed / length)) : Vec2::Zero();
  }

  void Drive(const Vec2& velocity, sim::Actuators& actuators) {
    const double bearing = sim::AngleOf(velocity);
    const double angle = std::abs(bearing);
    const double speed = std::min(std::sqrt(velocity.squaredNorm()), kMaxSpeed);
    if (turning_ == Turning::kHard && angle <= 70.0 * sim::kDegree) turning_ = Turning::kSoft;
    if (turning_ != Turning::kHard) {
      turning_ = angle > 90.0 * sim::kDegree   ? Turning::kHard
                 : angle > 10.0 * sim::kDegree ? Turning::kSoft
                                               : Turning::kNone;
    }
    double inner = speed;
    double outer = speed;
    if (turning_ == Turning::kSoft) {
      const double share = angle / (90.0 * sim::kDegree);
      inner = speed * (1.0 - share);
      outer = speed * (1.0 + share);
    } else if (turning_ == Turning::kHard) {
      inner = -kMaxSpeed;
      outer = kMaxSpeed;
    }
    actuators.left_wheel = (bearing > 0.0 ? inner : outer) * 0.01;
    actuators.right_wheel = (bearing > 0.0 ? outer : inner) * 0.01;
  }

  Turning turning_ = Turning::kNone;
};

ControllerFactory OurForm() {
  return {.create = [](const ControllerContext&) { return std::make_unique<CentimetreFlocker>(); },
          .traits = {.link_range = 1.35}};
}

sim::RunResult RunOf(const ControllerFactory& robots, std::uint64_t seed) {
  const auto& table = LightFlockingScenarioParameters();
  sim::TestCase test_case;
  test_case.obstacles = {{.x = 0.8, .y = 1.4, .length = 1.4, .width = 0.4, .orientation_deg = 100},
                         {.x = -0.3, .y = 0.2, .length = 1.6, .width = 0.2, .orientation_deg = 13}};
  LightFlockingScenario scenario(test_case, table.Read(*controllers::ResolveParameters(table.infos(), {})),
                                 robots, seed);
  return Simulate(scenario, seed, false);
}

TEST(LightFlocking, AsASourceForArgosMovesEveryRobotAsOurForm) {
  for (const std::uint64_t seed : {1u, 2u, 3u}) {
    const sim::RunResult argos = RunOf(ExampleFlockers(), seed);
    ASSERT_EQ(argos.verdict, sim::Verdict::kCompleted) << argos.message;
    EXPECT_EQ(argos.ticks, 2000);
    EXPECT_GT(argos.robots[0].path_length, 1.0);
    EXPECT_EQ(argos.trajectory_hash, RunOf(OurForm(), seed).trajectory_hash);
    EXPECT_EQ(argos.trajectory_hash, RunOf(ExampleFlockers(), seed).trajectory_hash);
  }
}

}  // namespace
}  // namespace gauntlet::argos_form
