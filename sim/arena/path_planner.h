// Basic Theta* (Nash et al. 2007): shortest any-angle paths on the inflated occupancy grid. 8-connected
// expansion without cutting corners, Euclidean cost and heuristic, line of sight between cells sampled every
// 0.02 m.
#pragma once

#include <vector>

#include "sim/arena/occupancy_grid.h"

namespace gauntlet::sim {

// Waypoints from start to goal, both included (the exact points, not their cells' centres); empty when there
// is no path. Ties are broken by cell index, so the path is a function of its inputs.
std::vector<Vec2> PlanPath(const OccupancyGrid& grid, const Vec2& start, const Vec2& goal);

}  // namespace gauntlet::sim
