// The foot-bot's proximity ring: 24 rays from the body's surface outward, 0.10 m long (ARGoS
// footbot_proximity; reading function and geometry measured in tests/golden/argos/sensors/prox_*.csv).
#pragma once

#include <array>
#include <cstdint>

#include "sim/sensors/sensor.h"

namespace gauntlet::sim {

using ProximityReadings = std::array<double, foot_bot::kProximitySensors>;

// Reading in [0, 1] of a ray whose first hit lies `distance` metres from the body's surface; 0 from 0.10 m
// on.
double ProximityReading(double distance);

// The readings of one robot, collected body by body. What is farther than the range costs one distance.
class ProximityRing {
 public:
  explicit ProximityRing(const BodyFrame& self) : self_(self) {}

  void See(const OrientedBox& box);
  // The other robot's body and the gripper disc at its front.
  void See(const BodyFrame& robot) {
    const Vec2 offset = robot.position - self_.position;
    if (offset.squaredNorm() < kBodyReach * kBodyReach) SeeBody(robot, offset);
  }

  // Bit i: ray i hit something.
  std::uint32_t hits() const { return hits_; }
  // Of a sensor whose ray hit something.
  double Reading(std::size_t sensor) const { return ProximityReading(nearest_[sensor]); }

  // How near another robot must be to be seen, m, centre to centre.
  static constexpr double kBodyReach =
      2.0 * foot_bot::kRadius + foot_bot::kProximityRange + foot_bot::kGripperRadius;

 private:
  void SeeBody(const BodyFrame& robot, const Vec2& offset);
  void SeeDisc(const Vec2& center, double radius, double apart);
  void SeeNearDisc(const Vec2& center, double radius);
  void Hit(std::size_t sensor, double distance);

  const BodyFrame& self_;
  std::uint32_t hits_ = 0;
  std::array<double, foot_bot::kProximitySensors> nearest_;  // m from the surface, where hits_ says so
};

}  // namespace gauntlet::sim
