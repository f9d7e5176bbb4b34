// Swarms that have the whole arena to themselves, rather than a way to go: what arenas they are given, where
// they begin, which of them are stuck, and words for the places in them. Aggregation, coverage and site
// selection share it.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "base/result.h"
#include "sim/arena/arena.h"
#include "sim/arena/validity.h"
#include "sim/observer.h"

namespace gauntlet::controllers {

struct OpenArena {
  int robots = 0;
  sim::Tick tick_limit = 0;
  double corner_distance = 0.0;  // m from the centre lines of a corner's walls to start and goal
  double open_share = 0.0;       // of the empty arena that obstacles must leave connected with the start

  // A way from the corner (+,+) to the corner (-,-), and an arena that is still open.
  sim::ArenaRequirements Requirements(const sim::TestCase& test_case) const;
};

// Where robots begin: the poses that the test case gives, else uniformly in its spawn area or in `area` where
// it has none, as many as it says or `robots`, each connected with `start`. Errors: "swarm-size: ...",
// "no-room-to-spawn: ...".
Result<std::vector<sim::Pose>> StartPoses(const sim::TestCase& test_case, int robots,
                                          const sim::Rectangle& area, const sim::Vec2& start,
                                          std::uint64_t seed);

// All robots at a tick, in robot order.
std::vector<sim::Vec2> PositionsAt(const sim::Observer& observer, sim::Tick tick);

// Ticks of the last `window` up to the end, one per second, the last tick among them; those before the first
// are left out.
std::vector<sim::Tick> LastSeconds(const sim::Observer& observer, sim::Tick window);

// A robot is stuck that kept within 0.05 m of its mean place for so long up to the end of the run (chosen);
// nobody is in a run that was shorter.
inline constexpr sim::Tick kStuckTicks = 60 * sim::kTicksPerSecond;
bool IsStuck(const sim::Observer& observer, sim::RobotIndex robot);

// The arena as nine equal parts, row by row from the corner (-,-): 0 to 8.
inline constexpr int kPlaces = 9;
int PlaceOf(const sim::Vec2& point, const sim::Arena& arena);
// "lower left", "middle", "upper right"...
std::string_view NameOfPlace(int place);

}  // namespace gauntlet::controllers
