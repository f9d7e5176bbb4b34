#include "sim/sensors/proximity.h"

#include <algorithm>
#include <cmath>

#include "sim/robot/controller.h"

namespace gauntlet::sim {
namespace {

constexpr std::size_t kSensors = foot_bot::kProximitySensors;
constexpr double kReach = foot_bot::kRadius + foot_bot::kProximityRange;  // m from the centre
constexpr double kNothing = 2.0 * kReach;

// Rays of a robot with heading 0.
const std::array<Vec2, kSensors>& RestRays() {
  static const std::array<Vec2, kSensors> rays = [] {
    std::array<Vec2, kSensors> result;
    for (std::size_t i = 0; i < kSensors; ++i) result[i] = UnitVector(ProximityBearing(static_cast<int>(i)));
    return result;
  }();
  return rays;
}

// Where a ray from the box's frame enters it: distance from `origin`, or kNothing.
double EnterBox(const Vec2& half_extents, const Vec2& origin, const Vec2& direction) {
  double enter = -kNothing;
  double leave = kNothing;
  for (int axis = 0; axis < 2; ++axis) {
    if (direction[axis] == 0.0) {
      if (std::abs(origin[axis]) > half_extents[axis]) return kNothing;
      continue;
    }
    const double inverse = 1.0 / direction[axis];
    const double a = (-half_extents[axis] - origin[axis]) * inverse;
    const double b = (half_extents[axis] - origin[axis]) * inverse;
    enter = std::max(enter, std::min(a, b));
    leave = std::min(leave, std::max(a, b));
  }
  return leave >= std::max(enter, foot_bot::kRadius) ? enter : kNothing;
}

}  // namespace

// Infrared model of footbot_proximity_default_sensor.cpp.
double ProximityReading(double distance) {
  constexpr double kSaturation = 0.009889556;  // m
  if (distance >= foot_bot::kProximityRange) return 0.0;
  if (distance < kSaturation) return 1.0;
  return std::min(1.0, 0.0100527 / (distance + 0.000163144));
}

ProximityRing::ProximityRing(const BodyFrame& self) : self_(self) {}

void ProximityRing::PrepareRays() {
  prepared_ = true;
  const std::array<Vec2, kSensors>& rest = RestRays();
  for (std::size_t i = 0; i < kSensors; ++i) {
    ray_x_[i] = self_.direction.x() * rest[i].x() - self_.direction.y() * rest[i].y();
    ray_y_[i] = self_.direction.y() * rest[i].x() + self_.direction.x() * rest[i].y();
    nearest_[i] = kNothing;
  }
}

// A hit counts only strictly inside the ray; a ray that starts inside a body reads its start.
void ProximityRing::Hit(std::size_t sensor, double distance) {
  if (distance >= foot_bot::kProximityRange) return;
  active_ = true;
  nearest_[sensor] = std::min(nearest_[sensor], std::max(distance, 0.0));
}

void ProximityRing::See(const OrientedBox& box) {
  const Vec2 local = ToLocal(box, self_.position);
  const Vec2 closest = local.cwiseMax(-box.half_extents).cwiseMin(box.half_extents);
  const Vec2 gap = closest - local;
  const double gap_squared = gap.squaredNorm();
  if (gap_squared >= kReach * kReach) return;
  if (!prepared_) PrepareRays();
  for (std::size_t i = 0; i < kSensors; ++i) {
    const Vec2 world(ray_x_[i], ray_y_[i]);
    const Vec2 ray(box.axis.dot(world), Cross(box.axis, world));
    // The box lies behind the line through its closest point, across the gap: rays that do not get there
    // within their reach miss it.
    if (ray.dot(gap) * kReach < gap_squared) continue;
    Hit(i, EnterBox(box.half_extents, local, ray) - foot_bot::kRadius);
  }
}

void ProximityRing::See(const BodyFrame& robot) {
  constexpr double kBodyReach = kReach + foot_bot::kRadius + foot_bot::kGripperRadius;
  if ((robot.position - self_.position).squaredNorm() >= kBodyReach * kBodyReach) return;
  SeeDisc(robot.position, foot_bot::kRadius);
  SeeDisc(robot.position + foot_bot::kRadius * robot.direction, foot_bot::kGripperRadius);
}

void ProximityRing::SeeDisc(const Vec2& center, double radius) {
  const Vec2 offset = center - self_.position;
  if (offset.squaredNorm() >= (kReach + radius) * (kReach + radius)) return;
  if (!prepared_) PrepareRays();
  for (std::size_t i = 0; i < kSensors; ++i) {
    const double across = ray_x_[i] * offset.y() - ray_y_[i] * offset.x();
    const double half_chord_squared = radius * radius - across * across;
    if (half_chord_squared <= 0.0) continue;
    const double along = ray_x_[i] * offset.x() + ray_y_[i] * offset.y();
    const double half_chord = std::sqrt(half_chord_squared);
    if (along + half_chord < foot_bot::kRadius) continue;  // ends before the ray begins
    Hit(i, along - half_chord - foot_bot::kRadius);
  }
}

ProximityReadings ProximityRing::Readings() const {
  ProximityReadings readings{};
  if (!active_) return readings;
  for (std::size_t i = 0; i < kSensors; ++i) readings[i] = ProximityReading(nearest_[i]);
  return readings;
}

}  // namespace gauntlet::sim
