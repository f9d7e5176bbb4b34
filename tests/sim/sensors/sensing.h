// What tests of single sensors need around them.
#pragma once

#include <span>
#include <utility>
#include <vector>

#include "base/bits.h"
#include "sim/sensors/proximity.h"
#include "sim/sensors/sensor_table.h"

namespace gauntlet::sim {

// Of all sensors of a robot: 0 of those that hit nothing.
inline ProximityReadings ReadingsOf(const ProximityRing& ring) {
  ProximityReadings readings{};
  ForEachBit(ring.hits(), [&](std::size_t sensor) { readings[sensor] = ring.Reading(sensor); });
  return readings;
}

// A place with lamps and radio beacons, and a swarm in it.
struct SensingPlace final : Surroundings {
  Arena arena{TestCase{}};
  std::vector<BodyFrame> robots;
  std::vector<RobotSensors> sensors;  // one for each robot
  std::vector<Signals> signals;       // one for each robot, or none
  Occluders occluders;                // nothing stands between if nothing is added, not even a wall
  std::vector<Light> lamps;
  std::vector<RadioBeacon> beacons;

  std::span<const Light> lights() const override { return lamps; }
  std::span<const RadioBeacon> radio_beacons() const override { return beacons; }

  // What each robot reads by this sensor; `use` is called with each one's readings while they are valid.
  template <typename Make, typename Use>
  void Read(const Make& make, const Use& use) {
    signals.resize(robots.size());
    std::vector<Vec2> positions;
    for (const BodyFrame& robot : robots) positions.push_back(robot.position);
    std::vector<OrientedBox> boxes;
    for (std::size_t i = 0; i < occluders.size(); ++i) boxes.push_back(occluders.box(i));
    bool any_ring_lit = false;
    for (const Signals& one : signals) any_ring_lit = any_ring_lit || one.RingLit();
    RobotPairs pairs(sensors, boxes);
    pairs.Update(positions, signals, occluders, any_ring_lit);
    const std::vector<Actuators> actuators(robots.size());
    const Grippers grippers(std::vector<bool>(robots.size(), false));
    const World world = {
        .poses = {}, .signals = signals, .actuators = actuators, .surroundings = *this, .grippers = grippers};
    const Scene scene = {world, robots, positions, occluders, pairs, any_ring_lit};
    const std::unique_ptr<Sensor> sensor = make(arena, sensors);
    sensor->Prepare(scene);
    for (std::size_t i = 0; i < robots.size(); ++i) {
      SensorReadings readings;
      sensor->Read(scene, static_cast<RobotIndex>(i), readings);
      use(readings);
    }
  }
};

}  // namespace gauntlet::sim
