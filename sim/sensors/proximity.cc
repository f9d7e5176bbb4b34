#include "sim/sensors/proximity.h"

#include <algorithm>
#include <cmath>

#include "base/bits.h"
#include "sim/geometry/nearby_boxes.h"
#include "sim/geometry/neighbour_pairs.h"
#include "sim/sensors/sensor_table.h"

namespace gauntlet::sim {
namespace {

constexpr std::size_t kSensors = foot_bot::kProximitySensors;
constexpr double kReach = foot_bot::kRadius + foot_bot::kProximityRange;  // m from the centre
constexpr double kNothing = 2.0 * kReach;
constexpr double kTouching = 1e-6;  // m from a box: its direction is no guide

// Rays of a robot with heading 0. Thrice around, so that nobody who looks to both sides of the second turn
// meets the seam.
const std::array<Vec2, 3 * kSensors> kRestRays = [] {
  std::array<Vec2, 3 * kSensors> rays;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    rays[i] = UnitVector(ProximityBearing(static_cast<int>(i % kSensors)));
  }
  return rays;
}();

// `v` turned by the angle of the unit vector `by`.
Vec2 Turned(const Vec2& v, const Vec2& by) {
  return {by.x() * v.x() - by.y() * v.y(), by.y() * v.x() + by.x() * v.y()};
}

// Bearing of `v` in sensors: sensor i looks in direction i, v = (1, 0) is at -0.5. Each quadrant is taken as
// linear in y / (x + y), which is less than 4.1 degrees (0.28 sensors) off. In [-0.5, 23.5].
double SensorAngle(const Vec2& v) {
  const double x = std::abs(v.x());
  const double y = std::abs(v.y());
  const double quarter = y / (x + y);
  const double upper = v.x() >= 0.0 ? quarter : 2.0 - quarter;
  return (v.y() >= 0.0 ? upper : 4.0 - upper) * (kSensors / 4) - 0.5;
}

// Asks the sensors that may see what lies towards `v`, which less than half a turn of the ring sees: those
// that do are side by side. When the middle one does not, only one of its neighbours may: the middle is at
// most 0.28 + 0.5 sensors beside v. `sees` is given sensors of the second turn of kRestRays.
template <typename Sees>
void LookAround(const Vec2& v, const Sees& sees) {
  const int middle = static_cast<int>(SensorAngle(v) + 0.5 + kSensors);
  int left = middle + 1;
  int right = middle - 1;
  while (sees(left)) ++left;
  if (!sees(middle) && left > middle + 1) return;
  while (sees(right)) --right;
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

// The rings of a swarm.
class ProximityRings final : public Sensor {
 public:
  ProximityRings(const Arena& arena, std::span<const RobotSensors> robots)
      : robots_(robots.begin(), robots.end()), boxes_(kReach) {
    for (const OrientedBox& box : arena.fixed_boxes()) boxes_.AddBox(box);
    boxes_.SetVisitors(robots.size());
    rings_.reserve(robots.size());
  }

  void Prepare(const Scene& scene) override {
    rings_.clear();
    for (const BodyFrame& robot : scene.robots) rings_.emplace_back(robot);
    neighbours_.Update(scene.positions, ProximityRing::kBodyReach);
    for (const auto& [a, b] : neighbours_.pairs()) {
      if (robots_[a].devices.Has(Device::kProximity)) rings_[a].See(scene.robots[b]);
      if (robots_[b].devices.Has(Device::kProximity)) rings_[b].See(scene.robots[a]);
    }
  }
  void Read(const Scene& scene, RobotIndex robot, SensorReadings& readings) override {
    const auto index = static_cast<std::size_t>(robot);
    ProximityRing& ring = rings_[index];
    for (const std::size_t box : boxes_.Near(index, scene.positions[index])) ring.See(boxes_.box(box));
    for (const OrientedBox& box : scene.moving_boxes) ring.See(box);
    ForEachBit(readings.proximity_hits & ~ring.hits(),
               [&](std::size_t sensor) { readings.proximity[sensor] = 0.0; });
    ForEachBit(ring.hits(), [&](std::size_t sensor) { readings.proximity[sensor] = ring.Reading(sensor); });
    readings.proximity_hits = ring.hits();
  }
  void Blank(RobotIndex /*robot*/, SensorReadings& readings) override {
    readings.proximity.fill(0.0);
    readings.proximity_hits = 0;
  }
  void Disturb(const Scene& /*scene*/, RobotIndex /*robot*/, DeviceErrors& errors,
               SensorReadings& readings) override {
    errors.AddTo(readings.proximity);
    readings.proximity_hits = 0;
    for (std::size_t i = 0; i < kSensors; ++i) {
      if (readings.proximity[i] != 0.0) readings.proximity_hits |= 1u << i;
    }
  }

 private:
  static constexpr double kSlack = 0.1;  // m; two robots that drive at each other use it up in 0.5 s

  std::vector<RobotSensors> robots_;
  NearbyBoxes boxes_;
  NeighbourPairs neighbours_{kSlack};
  std::vector<ProximityRing> rings_;  // per robot
};

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
  const auto sees = [&](int sensor) {
    // The box lies behind the line through its closest point, across the gap: rays that do not get there
    // within their reach miss it.
    const Vec2 ray = Turned(kRestRays[static_cast<std::size_t>(sensor)], forward);
    if (ray.dot(gap) * kReach < gap_squared) return false;
    Hit(static_cast<std::size_t>(sensor) % kSensors,
        EnterBox(box.half_extents, origin, ray) - foot_bot::kRadius);
    return true;
  };
  if (gap_squared < kTouching * kTouching) {
    for (int sensor = 0; sensor < static_cast<int>(kSensors); ++sensor) sees(sensor);
  } else {
    LookAround({forward.dot(gap), Cross(forward, gap)}, sees);
  }
}

void ProximityRing::SeeBody(const BodyFrame& robot, const Vec2& offset) {
  const Vec2 body = self_.FromWorld(offset);
  SeeDisc(body, foot_bot::kRadius, 0.1);
  // Turned away by this much, the gripper is behind the body for every ray: the body's shadow is at least
  // R + 0.2 R^2 / d - 0.98 R sqrt(1 - R^2 / d^2) > 1.01 kGripperRadius away from the gripper's centre on both
  // sides for d up to kBodyReach, and from d = sqrt(2) R on no ray begins in the body.
  const Vec2 facing = self_.FromWorld(robot.direction);
  const double away = facing.dot(body);
  const double distance_squared = body.squaredNorm();
  const bool hidden = away > 0.0 && away * away >= 0.2 * 0.2 * distance_squared &&
                      distance_squared >= 2.0 * foot_bot::kRadius * foot_bot::kRadius;
  if (!hidden) SeeDisc(body + foot_bot::kRadius * facing, foot_bot::kGripperRadius, 0.02);
}

// `center` in the frame of this robot. From the distance `apart` on, less than half a turn of the ring sees
// it.
void ProximityRing::SeeDisc(const Vec2& center, double radius, double apart) {
  const double distance_squared = center.squaredNorm();
  if (distance_squared >= (kReach + radius) * (kReach + radius)) return;
  if (distance_squared < apart * apart) {
    SeeNearDisc(center, radius);
    return;
  }
  // A ray that is kReach long ends in the disc or has passed through it when it lies more than this along the
  // way to the centre: while the tangents are longer than the ray, its end must be in the disc (law of
  // cosines), else it must lie between them.
  const double power = distance_squared - radius * radius;  // square of the tangents' length
  const double least_along =
      power > kReach * kReach ? (power + kReach * kReach) / (2.0 * kReach) : std::sqrt(power);
  LookAround(center, [&](int sensor) {
    const double along = kRestRays[static_cast<std::size_t>(sensor)].dot(center);
    if (along <= least_along) return false;
    const double half_chord = std::sqrt(along * along - power);
    // Else it ends before the ray begins.
    if (along + half_chord >= foot_bot::kRadius) {
      Hit(static_cast<std::size_t>(sensor) % kSensors, along - half_chord - foot_bot::kRadius);
    }
    return true;
  });
}

// A disc so near, or overlapped, that any sensor may see it.
void ProximityRing::SeeNearDisc(const Vec2& center, double radius) {
  for (std::size_t sensor = 0; sensor < kSensors; ++sensor) {
    const double across = Cross(kRestRays[sensor], center);
    const double half_chord_squared = radius * radius - across * across;
    if (half_chord_squared <= 0.0) continue;
    const double along = kRestRays[sensor].dot(center);
    const double half_chord = std::sqrt(half_chord_squared);
    if (along + half_chord < foot_bot::kRadius) continue;  // ends before the ray begins
    Hit(sensor, along - half_chord - foot_bot::kRadius);
  }
}

std::unique_ptr<Sensor> MakeProximityRings(const Arena& arena, std::span<const RobotSensors> robots) {
  return std::make_unique<ProximityRings>(arena, robots);
}

}  // namespace gauntlet::sim
