// Which robots are near each other: a list of pairs that is renewed only after somebody has moved some way.
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

  // Allocates; Find() does not, unless robots stand in each other by the dozen.
  void SetRobots(std::size_t robots);
  // A superset of the pairs whose distance is less than `reach` (m), in ascending order.
  std::span<const Pair> Find(std::span<const Vec2> positions, double reach);

 private:
  bool StillHolds(std::span<const Vec2> positions, double reach) const;

  double listed_reach_ = -1.0;     // every pair nearer than this at the anchors is listed
  std::vector<Vec2> anchors_;      // positions when the list was made
  std::vector<std::size_t> by_x_;  // robots in ascending x
  std::vector<Pair> pairs_;
};

}  // namespace gauntlet::sim
