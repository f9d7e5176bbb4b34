// What happened in a failed run, in a few words: a function of that run alone.
#pragma once

#include <span>
#include <string>

#include "controllers/behaviour.h"
#include "sim/arena/test_case.h"
#include "sim/run_result.h"

namespace gauntlet {

// Whether a robot stayed where it was between two waypoints, which are 5 s apart.
bool StaysBetween(const sim::Vec2& before, const sim::Vec2& after);

// The words of the first of the scenario's failure kinds that the run is of. Where the scenario declares none
// that fits, what more than half of the failing robots did (those that were lost, where losing them is the
// failure and one was; else all), by their waypoints:
//   "stood still at obstacles"   moved less than 5 cm in most of the intervals between waypoints (5 s), and
//                                were within reach of an obstacle at most waypoints
//   "stood still in the open"    the same elsewhere
//   "stayed near the start"      never got farther from it than a quarter of the arena's longer side
//   "lost far from the start"    otherwise, where losing robots is the failure
//   "kept driving"               otherwise
// The bounds were chosen on 184 failing random cases of flocking, gathering and task partitioning (seed 1),
// so that what happens repeats within a case, and are frozen. "" where nothing is declared and no waypoints
// were kept.
std::string MechanismOf(const controllers::ScenarioInfo& scenario, const sim::TestCase& test_case,
                        controllers::MetricValues metrics, std::span<const sim::RobotSummary> robots);

}  // namespace gauntlet
