#include "sim/sensors/omni_camera.h"

#include <cmath>

#include "sim/geometry/ray_cast.h"

namespace gauntlet::sim {

OmniCameras::OmniCameras(const Arena& arena, std::span<const double> ranges)
    : ranges_(ranges.begin(), ranges.end()),
      blobs_(ranges.empty() ? 0 : ranges.size() * (ranges.size() - 1)),
      counts_(ranges.size()) {
  for (const OrientedBox& box : arena.boxes()) {
    Occluder occluder{.box = box, .min = box.center, .max = box.center};
    for (const Vec2& corner : Corners(box)) {
      occluder.min = occluder.min.cwiseMin(corner);
      occluder.max = occluder.max.cwiseMax(corner);
    }
    obstacles_.push_back(occluder);
  }
  occluders_.reserve(obstacles_.size());
}

void OmniCameras::Look(std::span<const BodyFrame> robots, std::span<const Color> beacons) {
  FindOccluders(robots);
  for (std::size_t& count : counts_) count = 0;
  for (std::size_t i = 0; i < robots.size(); ++i) {
    for (std::size_t j = i + 1; j < robots.size(); ++j) {
      const Vec2 offset = robots[j].position - robots[i].position;
      const double side = std::max(std::abs(offset.x()), std::abs(offset.y()));
      const bool i_sees = side < ranges_[i] && beacons[j] != Color::kBlack;
      const bool j_sees = side < ranges_[j] && beacons[i] != Color::kBlack;
      if ((!i_sees && !j_sees) || Hidden(robots[i].position, robots[j].position)) continue;
      const double range = std::sqrt(offset.squaredNorm());
      const double bearing = AngleOf(offset);
      if (i_sees) Add(i, robots[i], range, bearing, beacons[j]);
      if (j_sees) Add(j, robots[j], range, bearing > 0.0 ? bearing - kPi : bearing + kPi, beacons[i]);
    }
  }
}

// Lines of sight stay inside the rectangle around all robots; a box outside it hides nobody.
void OmniCameras::FindOccluders(std::span<const BodyFrame> robots) {
  occluders_.clear();
  if (robots.empty()) return;
  Vec2 min = robots[0].position;
  Vec2 max = min;
  for (const BodyFrame& robot : robots) {
    min = min.cwiseMin(robot.position);
    max = max.cwiseMax(robot.position);
  }
  for (std::size_t i = 0; i < obstacles_.size(); ++i) {
    const Occluder& obstacle = obstacles_[i];
    if ((obstacle.min.array() <= max.array()).all() && (obstacle.max.array() >= min.array()).all()) {
      occluders_.push_back(i);
    }
  }
}

bool OmniCameras::Hidden(const Vec2& a, const Vec2& b) const {
  const Vec2 min = a.cwiseMin(b);
  const Vec2 max = a.cwiseMax(b);
  for (const std::size_t index : occluders_) {
    const Occluder& obstacle = obstacles_[index];
    if (obstacle.min.x() > max.x() || obstacle.max.x() < min.x() || obstacle.min.y() > max.y() ||
        obstacle.max.y() < min.y()) {
      continue;
    }
    if (SegmentTouches(obstacle.box, a, b)) return true;
  }
  return false;
}

void OmniCameras::Add(std::size_t viewer, const BodyFrame& frame, double range, double world_bearing,
                      Color color) {
  double bearing = world_bearing - frame.heading;  // both in (-pi, pi]
  if (bearing > kPi) bearing -= 2.0 * kPi;
  if (bearing <= -kPi) bearing += 2.0 * kPi;
  blobs_[viewer * (ranges_.size() - 1) + counts_[viewer]++] = {
      .range = range, .bearing = bearing, .color = color};
}

}  // namespace gauntlet::sim
