// Basic Theta* (Nash et al. 2007): shortest any-angle paths on the inflated occupancy grid. 8-connected
// expansion without cutting corners, Euclidean cost and heuristic, line of sight between cells sampled every
// 0.02 m.
#pragma once

#include <vector>

#include "sim/arena/occupancy_grid.h"

namespace gauntlet::sim {

// Largest distance between two samples of a line of sight, m, and in grids of finer cells, in cells.
inline constexpr double kPathSampleDistance = 0.02;
inline constexpr double kPathSampleCells = 0.4;

// Waypoints from start to goal, both included (the exact points, not their cells' centres); empty when there
// is no path. Ties are broken by cell index, so the path is a function of its inputs. Never longer than the
// shortest path from cell to neighbouring cell.
std::vector<Vec2> PlanPath(const OccupancyGrid& grid, const Vec2& start, const Vec2& goal);

// Whether every sample of the segment a-b lies in a free cell: n equal steps of at most kPathSampleDistance
// (to 1e-8 m), ends included.
bool PathIsFree(const OccupancyGrid& grid, const Vec2& a, const Vec2& b);

}  // namespace gauntlet::sim
