#include "controllers/common/potential_field.h"

#include <algorithm>
#include <cmath>

#include "sim/geometry/trigonometry.h"

namespace gauntlet::controllers {
namespace {

constexpr double kNoDirection = 1e-3;
constexpr double kFaint = 0.5;  // reading, of dps
constexpr double kAhead = 5.0 * sim::kDegree;
constexpr double kNearest = 0.01;  // m: where the proximity sensors saturate

double KhatibStrength(double distance, double reach) {
  return distance >= reach ? 0.0 : (1.0 / distance - 1.0 / reach) / (distance * distance);
}

}  // namespace

sim::Vec2 Repulsion(const ProximitySum& near, const PotentialFieldSettings& settings) {
  const double length = std::sqrt(near.sum.dot(near.sum));
  if (length <= settings.least_push || length == 0.0) return sim::Vec2::Zero();
  const sim::Vec2 away = -near.sum / length;
  if (!settings.analytic) return away;
  const double distance = std::max(ProximityDistanceOf(near.largest), kNearest);
  return away * (KhatibStrength(distance, settings.reach) / KhatibStrength(settings.balance, settings.reach));
}

sim::Vec2 Diffusion(const ProximitySum& near) {
  const double length = std::sqrt(near.sum.dot(near.sum));
  if (length == 0.0) return {1.0, 0.0};
  if (length < kFaint && std::fabs(sim::AngleOf(near.sum)) <= kAhead) return {1.0, 0.0};
  return -near.sum / length;
}

DriveCommand FollowField(double goal_bearing, const sim::Vec2& repulsion, double speed,
                         const SteeringThresholds& steering) {
  const sim::Vec2 force = sim::UnitVector(goal_bearing) + repulsion;
  const bool balanced = force.dot(force) < kNoDirection * kNoDirection;
  return Steer(balanced ? sim::kPi : sim::AngleOf(force), speed, steering);
}

}  // namespace gauntlet::controllers
