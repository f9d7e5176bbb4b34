// Which points are near each other: a list of pairs that is renewed only after somebody has moved some way
// (Verlet 1967). Serves physics and sensors, which ask the same swarm tick by tick.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "sim/geometry/vec2.h"

namespace gauntlet::sim {

class NeighbourPairs {
 public:
  struct Pair {
    std::size_t first;  // < second
    std::size_t second;
    bool operator==(const Pair&) const = default;
    auto operator<=>(const Pair&) const = default;
  };

  // `slack` (m, positive): how much more than asked for is listed. Two points that approach each other use it
  // up together.
  explicit NeighbourPairs(double slack) : slack_(slack) {}

  // Brings the list up to date for these points. Returns whether it was renewed. Allocates nothing while
  // there are as many points as before, unless they stand in each other by the dozen.
  bool Update(std::span<const Vec2> positions, double reach);
  // Of the last Update: a superset of the pairs whose distance is less than `reach` (m), in ascending order.
  std::span<const Pair> pairs() const { return pairs_; }

 private:
  bool StillHolds(std::span<const Vec2> positions, double reach) const;

  double slack_;
  double listed_reach_ = -1.0;     // every pair nearer than this at the anchors is listed
  std::vector<Vec2> anchors_;      // positions when the list was made
  std::vector<std::size_t> by_x_;  // points in ascending x
  std::vector<Pair> pairs_;
};

}  // namespace gauntlet::sim
