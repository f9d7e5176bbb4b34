// Where robots begin: uniformly in an area, without overlap, only where the start can be reached.
#pragma once

#include <cstdint>
#include <vector>

#include "base/result.h"
#include "sim/arena/occupancy_grid.h"
#include "sim/arena/test_case.h"
#include "sim/random/random_stream.h"

namespace gauntlet::sim {

struct SpawnRequest {
  int count = 0;
  Rectangle area;                   // m; clipped to the free interior
  bool disc = false;                // the area is the disc inscribed in `area` instead of the rectangle
  double robot_radius = 0.0;        // m
  std::vector<Vec2> occupied = {};  // centres of robots that are there already
  Vec2 start = Vec2::Zero();        // spawn only in the component of the grid that this point is in
};

// Poses in spawn order with uniform headings, bodies at least 0.01 m apart and off obstacles and walls;
// draws from `random` only. After 100 tries for a robot the area is enlarged by 10 % about its centre, up to
// twice its sides, and stays so for the robots that follow. Error "no-room-to-spawn: ..." when they do not
// fit or the request makes no sense.
Result<std::vector<Pose>> Spawn(const SpawnRequest& request, const OccupancyGrid& grid, RandomStream& random);
// The same with the stream of the run's start poses, on the arena's grid of OccupancyGrid::kDefaultInflation.
Result<std::vector<Pose>> Spawn(const SpawnRequest& request, const Arena& arena, std::uint64_t seed);

}  // namespace gauntlet::sim
