// Whether a swarm fails before anything stands in its way: then no layout of obstacles is to blame.
#pragma once

#include <functional>

#include "base/result.h"
#include "master/dispatch/pool/worker_program.h"
#include "search/experiment/experiment.h"

namespace gauntlet {

// Simulates a few runs of the experiment's arena without obstacles. Errors: all of them fail
// (controllers::ScenarioInfo::failing); those of `simulate`.
Status CheckEmptyArena(
    const Experiment& experiment, const std::function<Result<sim::RunResult>(const sim::RunSpec&)>& simulate =
                                      [](const sim::RunSpec& spec) { return SimulateInRunner(spec); });

}  // namespace gauntlet
