// Random test cases for the tests of the arena, as the default generator makes them.
#pragma once

#include "sim/arena/occupancy_grid.h"
#include "sim/arena/validity.h"
#include "sim/random/random_stream.h"

namespace gauntlet::sim::testing {

// The flocking scenario's corners.
inline ArenaRequirements CornerToCorner() {
  ArenaRequirements requirements;
  requirements.start = {2.5, 2.5};
  requirements.goal = {-2.5, -2.5};
  return requirements;
}

inline ObstacleGene RandomGene(RandomStream& random, double longest = 2.0) {
  ObstacleGene gene;
  gene.x = random.Uniform(-3.0, 3.0);
  gene.y = random.Uniform(-3.0, 3.0);
  gene.length = random.Uniform(0.4, longest);
  gene.width = random.Uniform(0.1, 0.4);
  gene.orientation_deg = random.Below(360);
  return gene;
}

// Whatever comes, valid or not.
inline TestCase AnyTestCase(RandomStream& random, int obstacles, double longest = 2.0) {
  TestCase test_case;
  for (int i = 0; i < obstacles; ++i) test_case.obstacles.push_back(RandomGene(random, longest));
  return test_case;
}

inline TestCase ValidTestCase(RandomStream& random, int obstacles, const ArenaRequirements& requirements,
                              double longest = 2.0) {
  TestCase test_case;
  IncrementalValidity validity(test_case, requirements);
  while (test_case.obstacles.size() < static_cast<std::size_t>(obstacles)) {
    const ObstacleGene gene = RandomGene(random, longest);
    if (!validity.TryAppend(gene)) test_case.obstacles.push_back(gene);
  }
  return test_case;
}

// A square arena of 6 m with these obstacles.
inline OccupancyGrid GridWith(const Genome& genome, double inflation = OccupancyGrid::kDefaultInflation) {
  TestCase test_case;
  test_case.obstacles = genome;
  return OccupancyGrid(Arena(test_case), inflation);
}

}  // namespace gauntlet::sim::testing
