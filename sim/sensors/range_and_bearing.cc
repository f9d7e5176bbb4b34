#include "sim/sensors/range_and_bearing.h"

#include <algorithm>
#include <cmath>

namespace gauntlet::sim {
namespace {

constexpr std::size_t kManyMessages = 64;

Point3 AntennaAt(const Vec2& position) {
  return {position, foot_bot::kRangeAndBearingHeight};
}

}  // namespace

Radios::Radios(std::span<const Radio> radios)
    : radios_(radios.begin(), radios.end()), first_(radios.size() + 1) {
  messages_.reserve(radios.size() * std::min(radios.size() + 1, kManyMessages));
}

void Radios::Listen(const Scene& scene) {
  messages_.clear();
  for (std::size_t i = 0; i < radios_.size(); ++i) {
    first_[i] = messages_.size();
    if (radios_[i].range <= 0.0) continue;
    HearRobots(scene, i);
    HearBeacons(scene, i);
  }
  first_.back() = messages_.size();
}

void Radios::HearRobots(const Scene& scene, std::size_t listener) {
  const BodyFrame& self = scene.robots[listener];
  const RobotIndex robot = static_cast<RobotIndex>(listener);
  for (const RobotPairs::Neighbour& other : scene.pairs.NeighboursOf(robot)) {
    const std::size_t sender = static_cast<std::size_t>(other.robot);
    if (!other.clear || !(other.distance < radios_[sender].range) || scene.signals[sender].silent) continue;
    if (!scene.occluders.all_high() &&
        scene.occluders.BoxBetween(AntennaAt(self.position), AntennaAt(scene.robots[sender].position))) {
      continue;
    }
    if (radios_[listener].bodies_block &&
        BodyBetween(scene.robots, AntennaAt(self.position), AntennaAt(scene.robots[sender].position), robot,
                    other.robot)) {
      continue;
    }
    messages_.push_back({.position = self.FromWorld(other.offset),
                         .range = other.distance,
                         .payload = scene.signals[sender].message});
  }
}

void Radios::HearBeacons(const Scene& scene, std::size_t listener) {
  const BodyFrame& self = scene.robots[listener];
  const Point3 antenna = AntennaAt(self.position);
  for (const RadioBeacon& beacon : scene.beacons) {
    const Vec2 offset = beacon.position - self.position;
    if (!(offset.squaredNorm() < beacon.range * beacon.range)) continue;
    const Point3 source = AntennaAt(beacon.position);
    if (scene.occluders.BoxBetween(antenna, source)) continue;
    if (radios_[listener].bodies_block &&
        BodyBetween(scene.robots, antenna, source, static_cast<RobotIndex>(listener), -1)) {
      continue;
    }
    messages_.push_back({.position = self.FromWorld(offset),
                         .range = std::sqrt(offset.squaredNorm()),
                         .payload = beacon.payload});
  }
}

}  // namespace gauntlet::sim
