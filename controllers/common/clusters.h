// Robots that hang together: a cluster is a set of robots in which everybody is linked with everybody else,
// over others if need be. Two robots are linked when they are nearer than a range and see each other.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "sim/arena/arena.h"

namespace gauntlet::controllers {

// Keeps its memory from one call to the next.
class Clusters {
 public:
  // The numbers of robots of all clusters, in the order of their first robots. `link_range`: m between
  // centres, exclusive. `obstacles`: where the moving ones are (Observer::ObstaclesAt). Valid until the next
  // call.
  std::span<const int> SizesOf(std::span<const sim::Vec2> robots, const sim::Arena& arena, double link_range,
                               std::span<const sim::Vec2> obstacles);

  // Of the last call; valid until the next one. The cluster of each robot, as an index into the sizes.
  std::span<const int> members() const { return members_; }
  // The cluster with most robots, of several the one of the first robot; 0 of nobody.
  int Largest() const;

 private:
  std::vector<int> members_;
  std::vector<std::size_t> open_;
  std::vector<int> sizes_;
};

}  // namespace gauntlet::controllers
