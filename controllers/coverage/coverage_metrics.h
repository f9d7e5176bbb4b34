// How well a swarm covers an arena. Pure functions of positions, so that recorded swarms can be judged like
// simulated ones. `obstacles`: where the moving ones are (Observer::ObstaclesAt).
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "controllers/failure_descriptor.h"  // kNowhere
#include "sim/arena/occupancy_grid.h"

namespace gauntlet::controllers::coverage {

// A connected region that nobody sees.
struct Hole {
  double area = 0.0;                          // m^2
  sim::Vec2 centroid = {kNowhere, kNowhere};  // m
};

// One per cell of the grid, row by row: 1 = seen.
using CellMarks = std::vector<std::uint8_t>;

// The cells of 0.05 m that a robot's centre can reach from the start.
class CoverageMap {
 public:
  // `arena` outlives the map. Obstacles that move count where they begin.
  CoverageMap(const sim::Arena& arena, const sim::Vec2& start);

  CellMarks NothingSeen() const { return CellMarks(reachable_.size(), 0); }
  // Marks the cells whose centres are at most `radius` m from one of the robots and in its line of sight.
  void See(std::span<const sim::Vec2> robots, double radius, std::span<const sim::Vec2> obstacles,
           CellMarks& seen) const;
  // Of the reachable cells, 0 to 1; 0 when there are none.
  double ShareOf(const CellMarks& seen) const;
  // The largest 4-connected region of reachable cells that are not seen; of equal ones the lowest.
  Hole LargestHole(const CellMarks& seen) const;

 private:
  const sim::Arena& arena_;
  sim::OccupancyGrid grid_;
  CellMarks reachable_;
};

// Mean distance of a robot to the nearest other, m; 0 of fewer than two.
double NearestNeighbourDistance(std::span<const sim::Vec2> robots);

}  // namespace gauntlet::controllers::coverage
