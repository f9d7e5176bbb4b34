// Whether a swarm fails before anything stands in its way: then no layout of obstacles is to blame.
#pragma once

#include <functional>

#include "base/result.h"
#include "master/dispatch/pool/worker_program.h"
#include "search/experiment/experiment.h"
#include "search/failure_tally.h"

namespace gauntlet {

using SimulateRun = std::function<Result<sim::RunResult>(const sim::RunSpec&)>;

// Simulates the first 5 of the runs of the experiment's arena without obstacles that `gauntlet baseline` asks
// for; `all`: also when one has not failed (controllers::ScenarioInfo::failing). Errors: those of `simulate`.
Result<FailureTally> FirstEmptyRuns(
    const Experiment& experiment, bool all,
    const SimulateRun& simulate = [](const sim::RunSpec& spec) { return SimulateInRunner(spec); });

// Error: all of them fail.
Status CheckEmptyArena(const Experiment& experiment, const FailureTally& first_runs);

}  // namespace gauntlet
