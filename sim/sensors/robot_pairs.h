// Which robots could see or hear each other, where they are from each other and whether a box stands between:
// worked out once per tick and shared by the cameras and by range-and-bearing.
#pragma once

#include <span>
#include <vector>

#include "sim/geometry/nearby_boxes.h"
#include "sim/geometry/neighbour_pairs.h"
#include "sim/robot/devices.h"
#include "sim/robot/foot_bot.h"
#include "sim/sensors/occluders.h"

namespace gauntlet::sim {

// A robot as its sensors need it.
struct RobotSensors {
  DeviceSet devices;
  double camera_range = 0.0;                             // m, half side of a world-aligned square
  double radio_range = foot_bot::kRangeAndBearingRange;  // m, how far it is heard
  bool bodies_block_radio = true;                        // it does not hear through other robots

  // 0 for a robot that has none.
  double CameraReach() const { return devices.Has(Device::kOmnidirectionalCamera) ? camera_range : 0.0; }
  double RadioReach() const { return devices.Has(Device::kRangeAndBearing) ? radio_range : 0.0; }
};

class RobotPairs {
 public:
  // A pair counts when either robot's camera or radio reaches the other.
  RobotPairs(std::span<const RobotSensors> robots, std::span<const OrientedBox> fixed_boxes);

  // Another robot as one robot has it.
  struct Neighbour {
    RobotIndex robot = 0;
    Vec2 offset = Vec2::Zero();  // m, from this robot's centre to the other's
    bool clear = false;          // no box between the centres
    double distance = 0.0;       // m, horizontal; only when clear
  };

  // `occluders` has the fixed boxes in their order. `ring_seen`: lights up to kRingRadius off the other's
  // centre can be seen. Allocates nothing while every robot has at most 64 others
  // in reach or nearly so.
  void Update(std::span<const Vec2> positions, const Occluders& occluders, bool ring_seen);
  // Of the last Update, in robot order.
  std::span<const Neighbour> NeighboursOf(RobotIndex robot) const {
    const std::size_t index = static_cast<std::size_t>(robot);
    return std::span(neighbours_).subspan(first_[index], count_[index]);
  }

 private:
  struct Reach {
    double camera;  // m
    double radio;   // m
  };

  void MakeRoom();

  std::vector<Reach> reaches_;
  double largest_reach_ = 0.0;  // m, radius around a centre
  NeighbourPairs near_;
  NearbyBoxes boxes_;                // of many robots: what may stand between one and those it reaches
  std::vector<std::size_t> framed_;  // of few: what may stand between any two of them
  std::vector<std::size_t>
      first_;  // where the neighbours of a robot begin, with room for all that are listed
  std::vector<std::size_t> count_;
  std::vector<Neighbour> neighbours_;
};

}  // namespace gauntlet::sim
