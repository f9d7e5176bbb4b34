// Which robots could see or hear each other, where they are from each other and whether a box stands between:
// worked out once per tick and shared by the cameras and by range-and-bearing.
#pragma once

#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "sim/geometry/nearby_boxes.h"
#include "sim/geometry/neighbour_pairs.h"
#include "sim/robot/controller.h"
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
  // m, how far away it hears others at most
  double listening_range = std::numeric_limits<double>::infinity();

  // 0 for a robot that has none.
  double CameraReach() const { return devices.Has(Device::kOmnidirectionalCamera) ? camera_range : 0.0; }
  double RadioReach() const { return devices.Has(Device::kRangeAndBearing) ? radio_range : 0.0; }
  double EarReach() const { return devices.Has(Device::kRangeAndBearing) ? listening_range : 0.0; }
};

class RobotPairs {
 public:
  RobotPairs(std::span<const RobotSensors> robots, std::span<const OrientedBox> fixed_boxes);

  // Another robot as one robot has it.
  struct Neighbour {
    Vec2 offset = Vec2::Zero();  // m, from this robot's centre to the other's
    double distance = 0.0;       // m, horizontal
    RobotIndex robot = 0;
    bool clear = false;  // no box between the centres
  };

  // Finds every pair of which either robot's camera or radio reaches the other, and some beyond; for cameras
  // the other must have had its beacon or ring lit since the beginning. `occluders` has the fixed boxes in
  // their order. `ring_seen`: lights up to kRingRadius off the other's centre can be seen; else those behind
  // boxes are left out. Allocates nothing while every robot has at most 64 others in reach or nearly so.
  void Update(std::span<const Vec2> positions, std::span<const Signals> signals, const Occluders& occluders,
              bool ring_seen);
  // m; no robot has driven farther since the beginning. It grows as they drive.
  double driven() const { return most_driven_; }
  // Of the last Update, in robot order.
  std::span<const Neighbour> NeighboursOf(RobotIndex robot) const {
    const std::size_t index = static_cast<std::size_t>(robot);
    return std::span(neighbours_).subspan(first_[index], count_[index]);
  }

 private:
  struct Reach {
    double camera;  // m
    double radio;   // m, how far it is heard
    double ear;     // m, how far it hears
  };
  enum class Standing : std::uint32_t { kOutOfReach, kHidden, kClear };
  // What is known of two robots until one of them has driven so far.
  struct Pair {
    std::uint32_t a;
    std::uint32_t b;
    Standing standing;
    double until_a;  // m, driven since the beginning
    double until_b;
  };

  void Drive(std::span<const Vec2> positions);
  bool SeeNewLights(std::span<const Signals> signals);
  void ListPairs();
  void Judge(Pair& pair, std::span<const Vec2> positions, const Occluders& occluders);
  // m, around a centre; beyond, neither hears the other or sees its lights.
  double ReachOf(const Pair& pair) const;

  std::vector<Reach> reaches_;
  double largest_reach_ = 0.0;  // m, radius around a centre
  NeighbourPairs near_;
  NearbyBoxes boxes_;  // what may stand between a robot and those it reaches
  std::vector<Pair> pairs_;
  std::vector<Vec2> positions_;  // of the last Update
  std::vector<double> driven_;   // m, by each robot since the beginning
  double most_driven_ = 0.0;     // m, sum of the longest way of every tick
  std::vector<char> was_lit_;    // per robot: since the beginning
  std::vector<std::size_t>
      first_;  // where the neighbours of a robot begin, with room for all that are listed
  std::vector<std::size_t> count_;
  std::vector<Neighbour> neighbours_;
};

}  // namespace gauntlet::sim
