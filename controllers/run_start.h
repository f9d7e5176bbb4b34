// How a run begins, for a master, which builds a scenario for this alone. Of a scenario that a plug-in
// brings, a master asks another process (PluginInfo::begin).
#pragma once

#include "base/result.h"
#include "sim/run_spec.h"
#include "sim/run_start.h"

namespace gauntlet::controllers {

// What the spec's scenario demands of its arena. Error: there is no such scenario, its parameters are wrong,
// or why the plug-in that brings it gives no answer.
Result<sim::ArenaRequirements> RequirementsOf(const sim::RunSpec& spec);

// Start poses are those of the spec's seed. Error: as CreateScenario, or why the swarm cannot be put into the
// arena ("no-room-to-spawn: ...").
Result<sim::RunStart> StartOf(const sim::RunSpec& spec);

// The size of the spec's swarm, provided that it can be put into the arena at all. Start places
// are random, so a few seeds are tried, and one that works is enough: from the spec's on, or, of a scenario
// that a plug-in brings, the same ones for all specs, so that one answer does for those that differ in their
// seed alone. Error: as StartOf, of the last try.
Result<sim::SwarmSize> CountSwarm(const sim::RunSpec& spec);

// Both answers at once, from the scenario's row in this process. Error: as RequirementsOf.
Result<sim::RunBeginning> BeginningOf(const sim::RunSpec& spec);

}  // namespace gauntlet::controllers
