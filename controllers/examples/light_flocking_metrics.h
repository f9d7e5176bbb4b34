// How a swarm that flocks towards a light ended. Pure functions of positions, so that recorded swarms can be
// judged like simulated ones.
#pragma once

#include <span>
#include <vector>

#include "sim/arena/arena.h"

namespace gauntlet::controllers::light_flocking {

// Mean distance of the robots from `point`, m; 0 of nobody.
double MeanDistance(std::span<const sim::Vec2> robots, const sim::Vec2& point);

// Connected components when robots are linked whose centres are less than `link_range` (m) apart and that no
// obstacle stands between.
int CountClusters(std::span<const sim::Vec2> robots, const sim::Arena& arena, double link_range,
                  std::span<const sim::Vec2> obstacles = {});

// Share of robots that `samples` ([time][robot]) never find at `threshold` (m) or more from where the first
// sample has them; 0 of nobody.
double ShareStopped(const std::vector<std::vector<sim::Vec2>>& samples, double threshold);

}  // namespace gauntlet::controllers::light_flocking
