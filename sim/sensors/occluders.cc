#include "sim/sensors/occluders.h"

#include <algorithm>
#include <cmath>
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
  boxes_.push_back(Bounded(box, height));
  all_high_ = all_high_ && height >= kHighestDevice;
}

void Occluders::SetMoving(std::span<const OrientedBox> boxes) {
  moving_.clear();
  for (const OrientedBox& box : boxes) moving_.push_back(Bounded(box, kBoxHeight));
}

void Occluders::FindHighBoxes(std::span<const Vec2> places, std::vector<std::size_t>& found) const {
  found.clear();
  if (places.empty()) return;
  Vec2 min = places[0];
  Vec2 max = min;
  for (const Vec2& place : places) {
    min = min.cwiseMin(place);
    max = max.cwiseMax(place);
  }
  for (std::size_t i = 0; i < boxes_.size(); ++i) {
    const Box& box = boxes_[i];
    if (box.height < kHighestDevice) continue;
    if ((box.min.array() <= max.array()).all() && (box.max.array() >= min.array()).all()) found.push_back(i);
  }
}

inline bool Occluders::HighBoxBetween(const Box& box, const Vec2& a, const Vec2& b, const Vec2& min,
                                      const Vec2& max) {
  if (box.height < kHighestDevice) return false;
  if (box.min.x() > max.x() || box.max.x() < min.x() || box.min.y() > max.y() || box.max.y() < min.y()) {
    return false;
  }
  return SegmentTouches(box.box, a, b);
}

bool Occluders::BoxBetween(std::span<const std::size_t> boxes, const Vec2& a, const Vec2& b) const {
  const Vec2 min = a.cwiseMin(b);
  const Vec2 max = a.cwiseMax(b);
  const auto between = [&](const Box& box) { return HighBoxBetween(box, a, b, min, max); };
  return std::ranges::any_of(boxes, [&](std::size_t index) { return between(boxes_[index]); }) ||
         std::ranges::any_of(moving_, between);
}

inline bool Occluders::LowBoxBetween(const Box& box, const Point3& a, const Point3& b) {
  Vec2 from;
  Vec2 to;
  if (!CutBelow(box.height, a, b, from, to)) return false;
  if (box.min.x() > std::max(from.x(), to.x()) || box.max.x() < std::min(from.x(), to.x()) ||
      box.min.y() > std::max(from.y(), to.y()) || box.max.y() < std::min(from.y(), to.y())) {
    return false;
  }
  return SegmentTouches(box.box, from, to);
}

bool Occluders::BoxBetween(const Point3& a, const Point3& b) const {
  const auto between = [&](const Box& box) { return LowBoxBetween(box, a, b); };
  return std::ranges::any_of(boxes_, between) || std::ranges::any_of(moving_, between);
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

}  // namespace gauntlet::sim
