#include "sim/sensors/distance_scanner.h"

#include <algorithm>

#include "sim/geometry/ray_cast.h"
#include "sim/geometry/trigonometry.h"
#include "sim/sensors/sensor_table.h"

namespace gauntlet::sim {
namespace {

constexpr double kShortRange = 0.26;    // m beyond the body
constexpr double kLongNearest = 0.12;   // m beyond the body
constexpr double kLongFarthest = 1.42;  // m beyond the body
constexpr double kMargin = 1e-6;        // m: a box that only rounding keeps out of reach is asked

// Distance from the surface of robot `self` to the first thing in this direction, or kNoHit beyond `range`.
double FirstHit(std::span<const BodyFrame> robots, std::size_t self,
                std::span<const OrientedBox* const> boxes, const Vec2& direction, double range) {
  const Vec2 origin = robots[self].position + foot_bot::kRadius * direction;
  double nearest = kNoHit;
  const auto see = [&nearest](double hit) {
    if (hit != kNoHit && (nearest == kNoHit || hit < nearest)) nearest = hit;
  };
  for (const OrientedBox* box : boxes) see(RayHit(*box, origin, direction, range));
  const double reach = range + foot_bot::kRadius + foot_bot::kGripperRadius;
  for (std::size_t i = 0; i < robots.size(); ++i) {
    if (i == self || (robots[i].position - origin).squaredNorm() > reach * reach) continue;
    see(RayHit(robots[i].position, foot_bot::kRadius, origin, direction, range));
    const Vec2 gripper = robots[i].position + foot_bot::kRadius * robots[i].direction;
    see(RayHit(gripper, foot_bot::kGripperRadius, origin, direction, range));
  }
  return nearest;
}

bool Reaches(const OrientedBox& box, const Vec2& center, double range) {
  const double reach = foot_bot::kRadius + range + kMargin;
  return SquaredDistance(box, center) <= reach * reach;
}

double ReadingOf(double hit, double nearest) {
  if (hit == kNoHit) return ScannerReading::kNothing;
  return hit < nearest ? ScannerReading::kTooNear : hit;
}

// The scanners of a swarm.
class DistanceScanners final : public Sensor {
 public:
  DistanceScanners(const Arena& arena, std::size_t robots) : boxes_(arena.fixed_boxes()), scanners_(robots) {
    boxes_.resize(boxes_.size() + arena.moving().size());
  }

  void Prepare(const Scene& scene) override {
    std::copy(scene.moving_boxes.begin(), scene.moving_boxes.end(),
              boxes_.end() - std::ssize(scene.moving_boxes));
  }
  void Read(const Scene& scene, RobotIndex robot, SensorReadings& readings) override {
    const auto index = static_cast<std::size_t>(robot);
    scanners_[index].Scan(scene.actuators[index].scanner, scene.robots, robot, boxes_);
    readings.scanner_short = scanners_[index].short_range();
    readings.scanner_long = scanners_[index].long_range();
  }
  void Blank(RobotIndex robot, SensorReadings& /*readings*/) override {
    scanners_[static_cast<std::size_t>(robot)].ForEachDistance(
        [](double /*distance*/) { return ScannerReading::kNothing; });
  }
  void Disturb(const Scene& /*scene*/, RobotIndex robot, DeviceErrors& errors,
               SensorReadings& /*readings*/) override {
    scanners_[static_cast<std::size_t>(robot)].ForEachDistance([&](double distance) {
      return distance >= 0.0 ? std::max(distance + errors.Draw(), 0.0) : distance;
    });
  }

 private:
  std::vector<OrientedBox> boxes_;         // fixed, then moving ones
  std::vector<DistanceScanner> scanners_;  // per robot
};

}  // namespace

void DistanceScanner::Scan(const ScannerCommand& command, std::span<const BodyFrame> robots, RobotIndex self,
                           std::span<const OrientedBox> boxes) {
  count_ = 0;
  near_short_.reserve(boxes.size());  // in the first tick, even when off: later ones allocate nothing
  near_long_.reserve(boxes.size());
  if (command.mode == ScannerCommand::Mode::kOff) return;
  const bool turning = command.mode == ScannerCommand::Mode::kSpeed;
  if (!turning) rotation_ = WrapAngle(command.value);
  const std::size_t rays = turning ? kRaysPerTick : 1;
  const double swept = turning ? command.value * kTickSeconds : 0.0;  // rad
  const std::size_t index = static_cast<std::size_t>(self);
  near_short_.clear();
  near_long_.clear();
  for (const OrientedBox& box : boxes) {
    if (!Reaches(box, robots[index].position, kLongFarthest)) continue;
    near_long_.push_back(&box);
    if (Reaches(box, robots[index].position, kShortRange)) near_short_.push_back(&box);
  }
  for (const double side : {0.0, kPi}) {
    for (std::size_t ray = 0; ray < rays; ++ray) {
      const double angle =
          rotation_ + side + swept * static_cast<double>(ray) / static_cast<double>(kRaysPerTick);
      const auto look = [&](std::span<const OrientedBox* const> near, double bearing, double range) {
        return FirstHit(robots, index, near, UnitVector(robots[index].heading + bearing), range);
      };
      const double across = angle + kPi / 2.0;
      short_[count_] = {.bearing = WrapAngle(angle),
                        .distance = ReadingOf(look(near_short_, angle, kShortRange), 0.0)};
      long_[count_] = {.bearing = WrapAngle(across),
                       .distance = ReadingOf(look(near_long_, across, kLongFarthest), kLongNearest)};
      ++count_;
    }
  }
  rotation_ = WrapAngle(rotation_ + swept);
}

std::unique_ptr<Sensor> MakeDistanceScanners(const Arena& arena, std::span<const RobotSensors> robots) {
  return std::make_unique<DistanceScanners>(arena, robots.size());
}

}  // namespace gauntlet::sim
