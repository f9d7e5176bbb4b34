// Which robots could see or hear each other, where they are from each other and whether a box stands between:
// worked out once per tick and shared by the cameras and by range-and-bearing.
#pragma once

#include <span>
#include <vector>

#include "sim/physics/nearby_boxes.h"
#include "sim/robot/foot_bot.h"
#include "sim/sensors/body_frame.h"
#include "sim/sensors/neighbour_grid.h"
#include "sim/sensors/occluders.h"

namespace gauntlet::sim {

class RobotPairs {
 public:
  // How far robot i takes part. A pair counts when either robot's camera or radio reaches the other.
  struct Reach {
    double camera = 0.0;  // m, half side of a world-aligned square; 0 = no camera
    double radio = 0.0;   // m; 0 = no range-and-bearing
  };
  explicit RobotPairs(std::span<const Reach> reaches);

  // Another robot as one robot has it.
  struct Neighbour {
    RobotIndex robot = 0;
    Vec2 offset = Vec2::Zero();  // m, from this robot's centre to the other's
    bool clear = false;          // no box between the centres
    double distance = 0.0;       // m, horizontal; only when clear
  };

  // `occluders` has the same boxes at every call. `ring_seen`: lights up to kRingRadius off the other's
  // centre can be seen. Allocates nothing while every robot has at most 64 neighbours.
  void Update(std::span<const BodyFrame> robots, const Occluders& occluders, bool ring_seen);
  // Of the last Update, in robot order.
  std::span<const Neighbour> NeighboursOf(RobotIndex robot) const {
    const std::size_t index = static_cast<std::size_t>(robot);
    return std::span(neighbours_).subspan(first_[index], count_[index]);
  }

 private:
  struct Pair {
    std::size_t a;
    std::size_t b;
    Neighbour view;  // of b by a
  };

  // Whether a pair counts; then `view` is b as a has it. `box_between` is asked for two places.
  template <typename BoxBetween>
  bool Find(std::span<const BodyFrame> robots, const BoxBetween& box_between, double extra, std::size_t a,
            std::size_t b, Neighbour& view) const;
  static Neighbour Back(const Neighbour& view, std::size_t a);
  void UpdateFew(std::span<const BodyFrame> robots, const Occluders& occluders, double extra);
  void UpdateMany(std::span<const BodyFrame> robots, const Occluders& occluders, double extra);

  std::vector<Reach> reaches_;
  double largest_reach_ = 0.0;  // m, radius around a centre
  NeighbourGrid grid_;
  NearbyBoxes boxes_;        // of many robots: what may stand between one and those it reaches
  std::vector<Pair> pairs_;  // only of many robots; a < b, ordered by a, then b
  std::vector<std::size_t> first_;
  std::vector<std::size_t> count_;
  std::vector<Neighbour> neighbours_;
};

}  // namespace gauntlet::sim
