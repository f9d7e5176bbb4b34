#include "sim/sensors/omni_camera.h"

#include <algorithm>
#include <cmath>

namespace gauntlet::sim {
namespace {

constexpr std::size_t kManyBlobs = 64 * (1 + foot_bot::kRingLeds);
constexpr double kHighestLight = 2.0 * foot_bot::kCameraHeight;

// Of a robot with heading 0, from its centre.
const std::array<Vec2, foot_bot::kRingLeds>& RestRing() {
  static const std::array<Vec2, foot_bot::kRingLeds> ring = [] {
    std::array<Vec2, foot_bot::kRingLeds> result;
    for (std::size_t i = 0; i < result.size(); ++i) {
      result[i] = foot_bot::kRingRadius * UnitVector((static_cast<double>(i) + 0.5) * (kPi / 6.0));
    }
    return result;
  }();
  return ring;
}

double Side(const Vec2& offset) {
  return std::max(std::abs(offset.x()), std::abs(offset.y()));
}

bool HiddenByLowBox(const OmniCameras::Scene& scene, const BodyFrame& viewer,
                    const RobotPairs::Neighbour& other) {
  return !scene.occluders.all_high() &&
         scene.occluders.BoxBetween({viewer.position, foot_bot::kCameraHeight},
                                    {viewer.position + other.offset, foot_bot::kBeaconHeight});
}

}  // namespace

OmniCameras::OmniCameras(std::span<const double> ranges)
    : ranges_(ranges.begin(), ranges.end()), first_(ranges.size() + 1) {
  blobs_.reserve(ranges.size() * std::min(kManyBlobs, ranges.size() * (1 + foot_bot::kRingLeds)));
}

void OmniCameras::Look(const Scene& scene) {
  blobs_.clear();
  for (std::size_t i = 0; i < ranges_.size(); ++i) {
    const RobotIndex viewer = static_cast<RobotIndex>(i);
    first_[i] = blobs_.size();
    if (ranges_[i] <= 0.0) continue;
    for (const RobotPairs::Neighbour& other : scene.pairs.NeighboursOf(viewer)) {
      const Signals& signals = scene.signals[static_cast<std::size_t>(other.robot)];
      if (signals.beacon != Color::kBlack && other.clear && Side(other.offset) < ranges_[i] &&
          !HiddenByLowBox(scene, scene.robots[i], other)) {
        blobs_.push_back({.position = scene.robots[i].FromWorld(other.offset),
                          .range = other.distance,
                          .color = signals.beacon});
      }
      if (scene.any_ring_lit) AddRing(scene, viewer, other.robot);
    }
    if (!scene.lights.empty()) AddLights(scene, scene.lights, viewer);
    if (!scene.obstacle_lights.empty()) AddLights(scene, scene.obstacle_lights, viewer);
  }
  first_.back() = blobs_.size();
}

void OmniCameras::AddRing(const Scene& scene, RobotIndex viewer, RobotIndex other) {
  const BodyFrame& self = scene.robots[static_cast<std::size_t>(viewer)];
  const BodyFrame& carrier = scene.robots[static_cast<std::size_t>(other)];
  const Signals& signals = scene.signals[static_cast<std::size_t>(other)];
  const double range = ranges_[static_cast<std::size_t>(viewer)];
  const Point3 camera = {self.position, foot_bot::kCameraHeight};
  for (std::size_t led = 0; led < signals.ring.size(); ++led) {
    if (signals.ring[led] == Color::kBlack) continue;
    const Vec2 place = carrier.ToWorld(RestRing()[led]);
    const Vec2 offset = place - self.position;
    if (!(Side(offset) < range)) continue;
    const Point3 lamp = {place, foot_bot::kRingHeight};
    // Half of a ring is hidden by its own robot: that is the cheapest to ask.
    if (BodyBetween(std::span(&carrier, 1), camera, lamp, -1, -1)) continue;
    if (scene.occluders.BoxBetween(camera, lamp)) continue;
    if (BodyBetween(scene.robots, camera, lamp, viewer, other)) continue;
    Add(self, offset, std::sqrt(offset.squaredNorm()), signals.ring[led]);
  }
}

void OmniCameras::AddLights(const Scene& scene, std::span<const Light> lights, RobotIndex viewer) {
  const BodyFrame& self = scene.robots[static_cast<std::size_t>(viewer)];
  const Point3 camera = {self.position, foot_bot::kCameraHeight};
  for (const Light& light : lights) {
    if (light.color == Color::kBlack || light.height >= kHighestLight) continue;
    const Vec2 offset = light.position - self.position;
    if (!(Side(offset) < ranges_[static_cast<std::size_t>(viewer)])) continue;
    if (light.occludable) {
      const Point3 lamp = {light.position, light.height};
      if (scene.occluders.BoxBetween(camera, lamp)) continue;
      if (BodyBetween(scene.robots, camera, lamp, viewer, -1)) continue;
    }
    Add(self, offset, std::sqrt(offset.squaredNorm()), light.color);
  }
}

void OmniCameras::Add(const BodyFrame& viewer, const Vec2& offset, double range, Color color) {
  blobs_.push_back({.position = viewer.FromWorld(offset), .range = range, .color = color});
}

}  // namespace gauntlet::sim
