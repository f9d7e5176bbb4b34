// The rules a test case must obey (thesis 3.2.1, spec 1.1), named one by one, and judged gene by gene in
// order.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "sim/arena/arena.h"
#include "sim/arena/occupancy_grid.h"
#include "sim/arena/test_case.h"

namespace gauntlet::sim {

// Names are part of the command line's contract (`refused` in JSON).
enum class ValidityRule {
  kFiniteNumbers,  // "finite-numbers": every number is finite
  kPositiveSize,   // "positive-size": length and width > 0, arena sides positive
  kGeneRange,  // "gene-range": a generated gene stays inside the experiment's ranges (not for imported cases)
  kContainedObstacle,  // "contained-obstacle": an obstacle lies wholly inside an earlier one
  kStartBlocked,       // "start-blocked": the start cell is not free
  kGoalBlocked,        // "goal-blocked": the goal cell is not free
  kClearance,      // "clearance": an obstacle is closer than the scenario's clearance to one of its places
  kNoPath,         // "no-path": no path from start to goal for a robot's body
  kNoRoomToSpawn,  // "no-room-to-spawn": the swarm does not fit even in the enlarged spawn area
};
std::string_view NameOf(ValidityRule rule);

struct Violation {
  ValidityRule rule;
  int gene = -1;        // index of the offending gene, -1 when none is to blame
  std::string message;  // names the value and what would be right
};

// What a scenario demands of its arenas.
struct ArenaRequirements {
  Vec2 start = Vec2::Zero();  // start of the swarm, or the nest
  Vec2 goal = Vec2::Zero();   // destination, or the food
  double clearance = 0.0;     // m kept free around start and goal; 0 = none
  double inflation = OccupancyGrid::kDefaultInflation;
};

// The first broken rule, or nothing. Gene ranges are not checked here (they belong to the generator).
std::optional<Violation> CheckValidity(const TestCase& test_case, const ArenaRequirements& requirements);

// Judges one gene after another, as generation and repair need it: O(cells) per gene instead of a fresh
// start.
class IncrementalValidity {
 public:
  IncrementalValidity(const TestCase& empty_arena, const ArenaRequirements& requirements);
  // Appends the gene when it breaks no rule; otherwise changes nothing and returns the violation.
  std::optional<Violation> TryAppend(const ObstacleGene& gene);

 private:
  ArenaRequirements requirements_;
  OccupancyGrid grid_;
  std::vector<OrientedBox> boxes_;
};

}  // namespace gauntlet::sim
