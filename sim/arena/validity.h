// The rules a test case must obey (thesis 3.2.1), named one by one, and judged gene by gene in
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
  kFiniteNumbers,      // "finite-numbers": every number is finite
  kPositiveSize,       // "positive-size": length and width > 0, arena sides positive
  kContainedObstacle,  // "contained-obstacle": an obstacle lies wholly inside an earlier one
  kStartBlocked,       // "start-blocked": the start cell is not free
  kGoalBlocked,        // "goal-blocked": the goal cell is not free
  kClearance,     // "clearance": an obstacle is closer than the scenario's clearance to one of its places
  kNoPath,        // "no-path": no path from start to goal for a robot's body
  kLimits,        // "limits": a number beyond what is simulated (constants below)
  kOutsideArena,  // "outside-arena": an obstacle nowhere reaches into the arena, also not on its path
  kKeepOut,       // "keep-out": an obstacle touches what the scenario keeps free, also on its path
  kOpenArea,      // "open-area": too little of the arena is left to a robot that begins at the start
};
std::string_view NameOf(ValidityRule rule);

struct Violation {
  ValidityRule rule;
  int gene = -1;        // index of the offending gene, -1 when none is to blame
  std::string message;  // names the value and what would be right
};

// The limits: wide enough for any sensible arena, narrow enough for every computation to end soon.
inline constexpr double kMinArenaSide = 1.0;       // m
inline constexpr double kMaxArenaSide = 100.0;     // m
inline constexpr double kMinThickness = 0.001;     // m; of walls and obstacles
inline constexpr double kMaxObstacleSize = 200.0;  // m
inline constexpr double kMaxCoordinate = 1000.0;   // m
inline constexpr std::size_t kMaxObstacles = 1000;
inline constexpr double kMaxCells = 4e6;  // of a grid; the largest arena has as many by default

// What a scenario demands of its arenas.
struct ArenaRequirements {
  Vec2 start = Vec2::Zero();  // start of the swarm, or the nest
  Vec2 goal = Vec2::Zero();   // destination, or the food
  double clearance = 0.0;     // m kept free around start and goal; 0 = none
  double inflation = OccupancyGrid::kDefaultInflation;
  double cell_size = OccupancyGrid::kCellSize;  // m; robots with less room need finer cells
  bool asks_for_path = true;                    // false: start and goal mean nothing, no path is looked for
  std::vector<Vec2> further_goals = {};         // each connected with the start, as the goal is
  std::vector<RoundedBox> keep_outs = {};       // what no obstacle may touch
  std::vector<RoundedBox> standing = {};        // what blocks robots in the arena itself
  double least_side = kMinArenaSide;            // m, of the arena
  bool anywhere = false;                        // the arena's centre need not be the origin
  double open_share = 0.0;  // of what the start is connected with in the empty arena, as much must be left
};

// The arena as robots of the scenario may go about in it. The test case obeys the rules up to "limits".
OccupancyGrid GridFor(const TestCase& test_case, const ArenaRequirements& requirements);

// The first broken rule, or nothing: the arena first, then gene by gene in the order finite-numbers,
// positive-size, limits, outside-arena, contained-obstacle, clearance, keep-out, start-blocked, goal-blocked,
// no-path, open-area. Gene ranges are not checked here (they belong to the generator), nor is whether the
// swarm fits (see Spawn). An obstacle that moves is judged where it begins, its distance from what is kept
// free on its whole path. Messages count obstacles from 1.
std::optional<Violation> CheckValidity(const TestCase& test_case, const ArenaRequirements& requirements);

// Judges one gene after another, as generation and repair need it: O(cells) per gene instead of a fresh
// start. Copies are independent, so a valid prefix can be kept and continued in several ways.
class IncrementalValidity {
 public:
  // Takes the arena's size from `empty_arena`; its obstacles are ignored.
  IncrementalValidity(const TestCase& empty_arena, const ArenaRequirements& requirements);
  // Appends the gene when it breaks no rule; otherwise changes nothing and returns the violation. An arena
  // that breaks a rule by itself takes no gene.
  std::optional<Violation> TryAppend(const ObstacleGene& gene);
  // The same without the dearest rules, that a path and an open area are left. Obstacles only ever take them
  // away: when they are left in the end, each gene would have left them.
  std::optional<Violation> TryAppendWhateverPathIsLeft(const ObstacleGene& gene);
  // Whether the start is connected with every goal and with as much of the arena as is asked for.
  bool LeavesPath() const;

  // The rule that the arena breaks without any obstacle.
  const std::optional<Violation>& arena_violation() const { return arena_violation_; }
  // Number of genes appended.
  std::size_t size() const { return boxes_.size(); }
  // With all genes appended so far. Of a stand-in arena when there is an arena_violation().
  const OccupancyGrid& grid() const { return grid_; }

 private:
  // The rules but that a path is left. Nothing: candidate_ is the grid with the gene.
  std::optional<Violation> JudgeGene(const ObstacleGene& gene);
  // Cells that the start is connected with.
  std::size_t OpenCells(const OccupancyGrid& grid) const;
  void Take(const ObstacleGene& gene);

  ArenaRequirements requirements_;
  Vec2 center_;  // m, of the arena
  Vec2 outer_;   // half sides to the outer faces of the walls, m
  std::optional<Violation> arena_violation_;
  OccupancyGrid grid_;
  OccupancyGrid candidate_;  // grid_ with the gene under judgement; kept to reuse its memory
  std::vector<OrientedBox> boxes_;
  double least_open_ = 0.0;  // cells that the start must be connected with
};

}  // namespace gauntlet::sim
