#include "sim/robot/obstacle_course.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace gauntlet::sim {
namespace {

constexpr double kBeforeTheSide = 0.01;  // m, so that the obstacle does not hide its own lamp
constexpr std::size_t kLampsPerObstacle = 4;
// Deepest overlap with a robot ahead of it, m, with which a moving obstacle goes on; from there it turns
// back. A robot that is only pushed overlaps less, one that is squeezed against something soon more.
constexpr double kMostSqueeze = 0.003;

}  // namespace

ObstacleCourse::ObstacleCourse(const Arena& arena) {
  for (const Arena::Lit& lit : arena.lit()) {
    const std::size_t first = lights_.size();
    lights_.resize(first + kLampsPerObstacle, Light{.height = foot_bot::kBeaconHeight, .color = lit.color});
    PlaceLights(arena.obstacles()[lit.obstacle], first);
  }
  for (const Arena::Moving& moving : arena.moving()) {
    Traveller traveller = {.path = moving.path, .distances = {0.0}, .speed = moving.speed};
    for (std::size_t i = 1; i < moving.path.size(); ++i) {
      const Vec2 way = moving.path[i] - moving.path[i - 1];
      traveller.distances.push_back(traveller.distances.back() + std::sqrt(way.squaredNorm()));
    }
    const auto lit = std::find_if(arena.lit().begin(), arena.lit().end(),
                                  [&](const Arena::Lit& one) { return one.obstacle == moving.obstacle; });
    if (lit != arena.lit().end()) {
      traveller.lit = true;
      traveller.first_light = kLampsPerObstacle * static_cast<std::size_t>(lit - arena.lit().begin());
    }
    travellers_.push_back(std::move(traveller));
    boxes_.push_back(arena.obstacles()[moving.obstacle]);
    centers_.push_back(boxes_.back().center);
  }
}

void ObstacleCourse::Advance(std::span<const Pose> robots) {
  for (std::size_t i = 0; i < travellers_.size(); ++i) {
    Traveller& traveller = travellers_[i];
    const double length = traveller.distances.back();
    for (int tries = 0; tries < 2; ++tries) {
      double next = traveller.travelled + (traveller.back ? -1.0 : 1.0) * traveller.speed * kTickSeconds;
      // At either end it stops for the rest of the tick and turns.
      const bool at_end = next <= 0.0 || next >= length;
      next = std::clamp(next, 0.0, length);
      const Vec2 center = PointAt(traveller, next);
      if (tries == 0 && Squeezes(boxes_[i], center - boxes_[i].center, robots)) {
        traveller.back = !traveller.back;
        continue;
      }
      traveller.travelled = next;
      centers_[i] = center;
      if (at_end) traveller.back = next > 0.0;
      break;
    }
  }
}

Vec2 ObstacleCourse::PointAt(const Traveller& traveller, double distance) {
  std::size_t end = 1;
  while (end + 1 < traveller.path.size() && traveller.distances[end] < distance) ++end;
  const double from = traveller.distances[end - 1];
  const double part = traveller.distances[end] - from;
  if (!(part > 0.0)) return traveller.path[end];
  return traveller.path[end - 1] + (distance - from) / part * (traveller.path[end] - traveller.path[end - 1]);
}

bool ObstacleCourse::Squeezes(const OrientedBox& box, const Vec2& way, std::span<const Pose> robots) {
  constexpr double kNearest = foot_bot::kRadius - kMostSqueeze;
  return std::any_of(robots.begin(), robots.end(), [&](const Pose& robot) {
    const Vec2 local = ToLocal(box, robot.position);
    const Vec2 outward = local - local.cwiseMax(-box.half_extents).cwiseMin(box.half_extents);
    const Vec2 local_way(way.dot(box.axis), Cross(box.axis, way));
    return outward.squaredNorm() < kNearest * kNearest && outward.dot(local_way) > 0.0;
  });
}

void ObstacleCourse::Place(std::size_t index, const OrientedBox& box) {
  boxes_[index] = box;
  if (travellers_[index].lit) PlaceLights(box, travellers_[index].first_light);
}

void ObstacleCourse::PlaceLights(const OrientedBox& box, std::size_t first_light) {
  const Vec2 ahead = (box.half_extents.x() + kBeforeTheSide) * box.axis;
  const Vec2 aside = (box.half_extents.y() + kBeforeTheSide) * LeftOf(box.axis);
  const std::array<Vec2, kLampsPerObstacle> ways = {ahead, aside, -ahead, -aside};
  for (std::size_t i = 0; i < ways.size(); ++i) lights_[first_light + i].position = box.center + ways[i];
}

}  // namespace gauntlet::sim
