#include "sim/sensors/occluders.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "sim/geometry/ray_cast.h"

namespace gauntlet::sim {
namespace {

constexpr double kHighestDevice = 0.9;  // m; nothing that sees or is seen is higher

// Shortens the segment a-b, seen from above, to its part at or below `height`. False when none is left.
bool CutBelow(double height, const Point3& a, const Point3& b, Vec2& from, Vec2& to) {
  from = a.position;
  to = b.position;
  if (a.height <= height && b.height <= height) return true;
  if (a.height > height && b.height > height) return false;
  const double share = (height - a.height) / (b.height - a.height);  // of the way from a
  const Vec2 crossing = a.position + share * (b.position - a.position);
  (a.height > height ? from : to) = crossing;
  return true;
}

// A distance that decides, less what rounding may have added to it.
double Lasting(double distance) {
  constexpr double kRounding = 1e-9;  // m: coordinates up to 1000 m lose far less
  return std::max(0.0, distance - kRounding);
}

}  // namespace

Occluders::Occluders(const Arena& arena) {
  for (const OrientedBox& box : arena.fixed_boxes()) AddBox(box);
  moving_.reserve(arena.moving().size());
}

Occluders::Box Occluders::Bounded(const OrientedBox& box, double height) {
  Box bounded = {.box = box, .height = height, .min = box.center, .max = box.center};
  for (const Vec2& corner : Corners(box)) {
    bounded.min = bounded.min.cwiseMin(corner);
    bounded.max = bounded.max.cwiseMax(corner);
  }
  return bounded;
}

void Occluders::AddBox(const OrientedBox& box, double height) {
  all_.push_back(boxes_.size());
  boxes_.push_back(Bounded(box, height));
  all_high_ = all_high_ && height >= kHighestDevice;
}

void Occluders::SetMoving(std::span<const OrientedBox> boxes) {
  moving_.clear();
  for (const OrientedBox& box : boxes) moving_.push_back(Bounded(box, kBoxHeight));
}

inline bool Occluders::Touches(const Box& box, const Vec2& a, const Vec2& b, const Vec2& min,
                               const Vec2& max) {
  if (box.min.x() > max.x() || box.max.x() < min.x() || box.min.y() > max.y() || box.max.y() < min.y()) {
    return false;
  }
  return SegmentTouches(box.box, a, b);
}

Sight Occluders::SightBetween(std::span<const std::size_t> boxes, const Vec2& a, const Vec2& b) const {
  const Vec2 min = a.cwiseMin(b);
  const Vec2 max = a.cwiseMax(b);
  double room = kLongest;
  for (const std::size_t index : boxes) {
    const Box& box = boxes_[index];
    if (box.height < kHighestDevice) continue;
    const double apart = std::max(std::max(box.min.x() - max.x(), min.x() - box.max.x()),
                                  std::max(box.min.y() - max.y(), min.y() - box.max.y()));
    if (apart >= room) continue;
    if (apart <= 0.0 && SegmentTouches(box.box, a, b)) return {false, Lasting(SegmentDepth(box.box, a, b))};
    room = std::min(room, std::max(apart, SegmentGap(box.box, a, b)));
  }
  return {true, Lasting(room)};
}

bool Occluders::MovingBoxBetween(const Vec2& a, const Vec2& b) const {
  if (moving_.empty()) return false;
  const Vec2 min = a.cwiseMin(b);
  const Vec2 max = a.cwiseMax(b);
  return std::ranges::any_of(moving_, [&](const Box& box) { return Touches(box, a, b, min, max); });
}

inline bool Occluders::LowBoxBetween(const Box& box, const Point3& a, const Point3& b) {
  Vec2 from;
  Vec2 to;
  if (!CutBelow(box.height, a, b, from, to)) return false;
  return Touches(box, from, to, from.cwiseMin(to), from.cwiseMax(to));
}

bool Occluders::BoxBetween(const Point3& a, const Point3& b) const {
  const auto between = [&](const Box& box) { return LowBoxBetween(box, a, b); };
  return std::ranges::any_of(boxes_, between) || std::ranges::any_of(moving_, between);
}

bool Occluders::BoxBetween(const Point3& a, const Point3& b, SightMemory& memory) const {
  // A higher lamp may shine over boxes.
  if (!all_high_ || std::max(a.height, b.height) > kHighestDevice) return BoxBetween(a, b);
  const double& holds = memory.sight.holds;
  if ((a.position - memory.from).squaredNorm() >= holds * holds || b.position != memory.to) {
    memory = {SightBetween(all_, a.position, b.position), a.position, b.position};
  }
  return !memory.sight.clear || MovingBoxBetween(a.position, b.position);
}

bool BodyBetween(std::span<const BodyFrame> robots, const Point3& a, const Point3& b, RobotIndex self,
                 RobotIndex other) {
  Vec2 from;
  Vec2 to;
  if (!CutBelow(foot_bot::kHeight, a, b, from, to)) return false;
  const Vec2 middle = (from + to) / 2.0;
  const double reach = std::sqrt((to - from).squaredNorm()) / 2.0 + foot_bot::kRadius;
  for (std::size_t i = 0; i < robots.size(); ++i) {
    if (std::cmp_equal(i, self) || std::cmp_equal(i, other)) continue;
    const Vec2& body = robots[i].position;
    if ((body - middle).squaredNorm() > reach * reach) continue;
    if (SegmentTouches(body, foot_bot::kRadius, from, to)) return true;
  }
  return false;
}

double BodyRoom(std::span<const Vec2> robots, const Vec2& a, const Vec2& b, RobotIndex self,
                RobotIndex other) {
  const Vec2 way = b - a;
  const double length_squared = way.squaredNorm();
  const double per_length_squared = length_squared > 0.0 ? 1.0 / length_squared : 0.0;
  double nearest = std::numeric_limits<double>::infinity();  // squared, of a centre from the line
  for (std::size_t i = 0; i < robots.size(); ++i) {
    if (std::cmp_equal(i, self) || std::cmp_equal(i, other)) continue;
    const Vec2 from_a = robots[i] - a;
    const double share = std::clamp(from_a.dot(way) * per_length_squared, 0.0, 1.0);
    nearest = std::min(nearest, (from_a - share * way).squaredNorm());
  }
  return std::sqrt(nearest) - foot_bot::kRadius;
}

}  // namespace gauntlet::sim
