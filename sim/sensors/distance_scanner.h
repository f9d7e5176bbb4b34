// The foot-bot's distance scanner: two short-range and two long-range rays on a turntable (ARGoS
// footbot_distance_scanner; measured in tests/golden/argos/sensors/scan.csv).
#pragma once

#include <array>
#include <span>
#include <vector>

#include "sim/sensors/sensor.h"

namespace gauntlet::sim {

class DistanceScanner {
 public:
  // One tick. Held at an angle it has one ray per sensor; turning, six, spread evenly over the angle of this
  // tick from where the last one ended; off, none. Others' gripper discs are seen, heights do not matter
  // (every box and body is higher than the scanner).
  void Scan(const ScannerCommand& command, std::span<const BodyFrame> robots, RobotIndex self,
            std::span<const OrientedBox> boxes);

  // Of the last Scan: of each tick the rays of the sensor at rotation + 0 (short) or + 90 degrees (long) in
  // the order of the sweep, then those of the opposite sensor.
  std::span<const ScannerReading> short_range() const { return std::span(short_).first(count_); }
  std::span<const ScannerReading> long_range() const { return std::span(long_).first(count_); }
  // Puts change(distance) in the place of each distance: short range first, each in its order.
  template <typename Change>
  void ForEachDistance(const Change& change) {
    for (auto* const rays : {&short_, &long_}) {
      for (ScannerReading& ray : std::span(*rays).first(count_)) ray.distance = change(ray.distance);
    }
  }

 private:
  static constexpr std::size_t kRaysPerTick = 6;

  double rotation_ = 0.0;  // rad from the heading
  std::size_t count_ = 0;
  std::vector<const OrientedBox*>
      near_short_;  // boxes that a ray of this tick can reach; kept for their memory
  std::vector<const OrientedBox*> near_long_;
  std::array<ScannerReading, 2 * kRaysPerTick> short_;
  std::array<ScannerReading, 2 * kRaysPerTick> long_;
};

}  // namespace gauntlet::sim
