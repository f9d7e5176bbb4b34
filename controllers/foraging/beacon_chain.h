// The path of thesis 5.1.1: a chain of beacons between the nest and the food, each in range and in sight of
// the next.
#pragma once

#include <span>
#include <vector>

#include "sim/arena/arena.h"

namespace gauntlet::controllers {

struct ChainEnds {
  sim::Vec2 nest = sim::Vec2::Zero();
  sim::Vec2 food = sim::Vec2::Zero();
};

// The chain with the fewest beacons: nest, beacons, food. Empty when there is none; without any beacon there
// is no chain, however near the food is. `obstacles`: where the moving ones are (Observer::ObstaclesAt).
std::vector<sim::Vec2> FindBeaconChain(const sim::Arena& arena, const ChainEnds& ends,
                                       std::span<const sim::Vec2> beacons, double range,
                                       std::span<const sim::Vec2> obstacles = {});

}  // namespace gauntlet::controllers
