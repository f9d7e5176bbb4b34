// Range-and-bearing (ARGoS range_and_bearing_medium_sensor; measured in tests/golden/argos/sensors/rab*.csv).
#pragma once

#include <span>
#include <vector>

#include "sim/robot/signals.h"
#include "sim/robot/surroundings.h"
#include "sim/sensors/body_frame.h"
#include "sim/sensors/occluders.h"
#include "sim/sensors/robot_pairs.h"

namespace gauntlet::sim {

// The radios of a whole swarm.
class Radios {
 public:
  struct Radio {
    double range = 0.0;        // m, how far it is heard; 0 = the robot has none
    bool bodies_block = true;  // it does not hear through other robots
  };
  explicit Radios(std::span<const Radio> radios);

  struct Scene {
    std::span<const BodyFrame> robots;
    const Occluders& occluders;
    const RobotPairs& pairs;
    std::span<const Signals> signals;
    std::span<const RadioBeacon> beacons;
  };
  // Every radio hears those that are strictly nearer than the sender's range when no box and, if bodies
  // block, no third robot stands between. Allocates nothing unless a robot hears more than 64 robots.
  void Listen(const Scene& scene);

  // Of the last Listen: robots in robot order, then the beacons in theirs.
  std::span<const Message> MessagesOf(RobotIndex robot) const {
    const std::size_t index = static_cast<std::size_t>(robot);
    return std::span(messages_).subspan(first_[index], first_[index + 1] - first_[index]);
  }

 private:
  void HearRobots(const Scene& scene, std::size_t listener);
  void HearBeacons(const Scene& scene, std::size_t listener);

  std::vector<Radio> radios_;
  std::vector<Message> messages_;
  std::vector<std::size_t> first_;
};

}  // namespace gauntlet::sim
