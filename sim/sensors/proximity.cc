#include "sim/sensors/proximity.h"

#include <algorithm>
#include <bit>
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

// `v` turned by the angle of the unit vector `by`.
Vec2 Turned(const Vec2& v, const Vec2& by) {
  return {by.x() * v.x() - by.y() * v.y(), by.y() * v.x() + by.x() * v.y()};
}

// Bearing of `v` in sensors: sensor i looks in direction i, v = (1, 0) is at -0.5. Each quadrant is taken as
// linear in y / (x + y), which is less than 4.1 degrees off. In [-0.5, 23.5].
double SensorAngle(const Vec2& v) {
  const double x = std::abs(v.x());
  const double y = std::abs(v.y());
  const double quarter = y / (x + y);
  const double upper = v.x() >= 0.0 ? quarter : 2.0 - quarter;
  return (v.y() >= 0.0 ? upper : 4.0 - upper) * (kSensors / 4) - 0.5;
}

// From the distance `apart` on, a disc spans less than `half_width` sensors to either side of its centre:
// asin(radius / apart) / 15 degrees, and 0.28 for the error of SensorAngle.
constexpr ProximityRing::Disc kBody = {.radius = foot_bot::kRadius, .apart = 0.16, .half_width = 2.14 + 0.28};
constexpr ProximityRing::Disc kGripper = {
    .radius = foot_bot::kGripperRadius, .apart = 0.07, .half_width = 0.55 + 0.28};

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

// A hit counts only strictly inside the ray; a ray that starts inside a body reads its start.
void ProximityRing::Hit(std::size_t sensor, double distance) {
  if (distance >= foot_bot::kProximityRange) return;
  const std::uint32_t bit = 1u << sensor;
  distance = std::max(distance, 0.0);
  nearest_[sensor] = (hits_ & bit) != 0 ? std::min(nearest_[sensor], distance) : distance;
  hits_ |= bit;
}

void ProximityRing::See(const OrientedBox& box) {
  const Vec2 origin = ToLocal(box, self_.position);
  const Vec2 closest = origin.cwiseMax(-box.half_extents).cwiseMin(box.half_extents);
  const Vec2 gap = closest - origin;
  const double gap_squared = gap.squaredNorm();
  if (gap_squared >= kReach * kReach) return;
  const Vec2 forward(box.axis.dot(self_.direction), Cross(box.axis, self_.direction));
  const std::array<Vec2, kSensors>& rays = RestRays();
  for (std::size_t i = 0; i < kSensors; ++i) {
    const Vec2 ray = Turned(rays[i], forward);
    // The box lies behind the line through its closest point, across the gap: rays that do not get there
    // within their reach miss it.
    if (ray.dot(gap) * kReach < gap_squared) continue;
    Hit(i, EnterBox(box.half_extents, origin, ray) - foot_bot::kRadius);
  }
}

void ProximityRing::See(const BodyFrame& robot) {
  constexpr double kBodyReach = kReach + foot_bot::kRadius + foot_bot::kGripperRadius;
  const Vec2 offset = robot.position - self_.position;
  if (offset.squaredNorm() >= kBodyReach * kBodyReach) return;
  const Vec2 body(self_.direction.dot(offset), Cross(self_.direction, offset));
  SeeDisc(body, kBody);
  const Vec2 front(self_.direction.dot(robot.direction), Cross(self_.direction, robot.direction));
  SeeDisc(body + foot_bot::kRadius * front, kGripper);
}

// `center` in the frame of this robot. Only the sensors that look near the disc are asked.
void ProximityRing::SeeDisc(const Vec2& center, const Disc& disc) {
  const double distance_squared = center.squaredNorm();
  if (distance_squared >= (kReach + disc.radius) * (kReach + disc.radius)) return;
  const std::array<Vec2, kSensors>& rays = RestRays();
  std::size_t first = 0;
  std::size_t last = kSensors - 1;
  if (distance_squared >= disc.apart * disc.apart) {
    // Counted around the ring twice, so that the window does not end at the seam.
    const double middle = SensorAngle(center) + kSensors;
    first = static_cast<std::size_t>(middle - disc.half_width) + 1;
    last = static_cast<std::size_t>(middle + disc.half_width);
  }
  for (std::size_t i = first; i <= last; ++i) {
    const std::size_t sensor = i % kSensors;
    const double across = Cross(rays[sensor], center);
    const double half_chord_squared = disc.radius * disc.radius - across * across;
    if (half_chord_squared <= 0.0) continue;
    const double along = rays[sensor].dot(center);
    const double half_chord = std::sqrt(half_chord_squared);
    if (along + half_chord < foot_bot::kRadius) continue;  // ends before the ray begins
    Hit(sensor, along - half_chord - foot_bot::kRadius);
  }
}

ProximityReadings ProximityRing::Readings() const {
  ProximityReadings readings{};
  for (std::uint32_t hits = hits_; hits != 0; hits &= hits - 1) {
    const std::size_t sensor = static_cast<std::size_t>(std::countr_zero(hits));
    readings[sensor] = ProximityReading(nearest_[sensor]);
  }
  return readings;
}

}  // namespace gauntlet::sim
