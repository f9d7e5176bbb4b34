#include "controllers/partitioning/bug_walk.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "sim/geometry/trigonometry.h"

namespace gauntlet::controllers {
namespace {

constexpr double kNothing = std::numeric_limits<double>::infinity();
using sim::kDegree;
// The side on which the obstacle is kept.
constexpr double kSideFrom = -130.0 * kDegree;
constexpr double kSideTo = -15.0 * kDegree;
constexpr double kScannerRange = 0.26;  // m beyond the body, the short range (ARGoS)
constexpr double kWallSpeed = 0.9;      // share of the speed along an obstacle
constexpr double kLostSpeed = 0.6;      // share of the speed round its end
constexpr double kBodyMargin = 0.02;    // m: a ray that ends this near to a robot's edge ended at the robot

struct Window {
  double middle;  // rad
  double half;    // rad
  bool Has(double bearing) const { return std::fabs(sim::WrapAngle(bearing - middle)) <= half; }
};

constexpr Window kSide = {(kSideFrom + kSideTo) / 2.0, (kSideTo - kSideFrom) / 2.0};

// Distance beyond the body to the nearest obstacle that the proximity ring has in the window.
double NearestByProximity(const ProximityReadings& readings, const Window& window) {
  double largest = 0.0;
  for (int i = 0; i < sim::foot_bot::kProximitySensors; ++i) {
    const double reading = readings[static_cast<std::size_t>(i)];  // most are 0: cheaper to ask first
    if (reading > largest && window.Has(sim::ProximityBearing(i))) largest = reading;
  }
  return largest > 0.0 ? ProximityDistanceOf(largest) : kNothing;
}

bool EndsAtARobot(const sim::ScannerReading& ray, std::span<const SeenBody> bodies) {
  const sim::Vec2 end = (sim::foot_bot::kRadius + ray.distance) * sim::UnitVector(ray.bearing);
  return std::any_of(bodies.begin(), bodies.end(), [&](const SeenBody& body) {
    const sim::Vec2 offset = end - body.range * sim::UnitVector(body.bearing);
    const double reach = sim::foot_bot::kRadius + kBodyMargin;
    return offset.squaredNorm() <= reach * reach;
  });
}

double NearestByScanner(const BugView& view, const Window& window) {
  double nearest = kNothing;
  for (const sim::ScannerReading& ray : view.scan) {
    if (ray.distance < 0.0 || ray.distance >= nearest || !window.Has(ray.bearing)) continue;
    if (!EndsAtARobot(ray, view.bodies)) nearest = ray.distance;
  }
  return nearest;
}

}  // namespace

std::optional<DriveCommand> BugWalk::Next(const BugView& view) {
  if (!following_) {
    const Window way = {view.goal_bearing, settings_.goal_angle};
    if (NearestByProximity(view.proximity, way) > settings_.meet_distance) return std::nullopt;
    following_ = true;
    clear_ = 0;
  }
  clear_ = WayIsClear(view) ? clear_ + 1 : 0;
  if (clear_ >= settings_.clear_ticks) {
    following_ = false;
    return std::nullopt;
  }
  return Follow(view);
}

bool BugWalk::WayIsClear(const BugView& view) const {
  if (view.scan.empty()) return false;  // the scanner has only just been switched on
  const Window way = {view.goal_bearing, settings_.goal_angle};
  const double reach = std::min(kScannerRange, view.goal_distance - sim::foot_bot::kRadius);
  return NearestByProximity(view.proximity, way) > reach && NearestByScanner(view, way) > reach;
}

DriveCommand BugWalk::Follow(const BugView& view) const {
  const Window front = {0.0, settings_.front_angle};
  const bool blocked = NearestByProximity(view.proximity, front) < settings_.front_distance;
  if (blocked || view.scan.empty()) return {0.0, settings_.turn_rate};
  const double wall = std::min(NearestByProximity(view.proximity, kSide), NearestByScanner(view, kSide));
  if (wall > kScannerRange) return {kLostSpeed * settings_.speed, -settings_.lost_turn};
  const double turn = std::clamp(settings_.wall_gain * (settings_.wall_distance - wall), -settings_.wall_turn,
                                 settings_.wall_turn);
  return {kWallSpeed * settings_.speed, turn};
}

}  // namespace gauntlet::controllers
