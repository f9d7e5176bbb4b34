// gauntlet-worker as a helper program: one simulation outside of any campaign, and the golden hash of this
// machine.
#pragma once

#include <cstdint>

#include "base/result.h"
#include "sim/run_result.h"
#include "sim/run_spec.h"

namespace gauntlet::master {

// Simulates a run in a runner, under the limits of any run, and returns the result (not checked against
// anything).
Result<sim::RunResult> SimulateInRunner(const sim::RunSpec& spec);

// The hash of a fixed set of runs on this machine, as `gauntlet-worker --golden` prints it.
Result<std::uint64_t> GoldenHashOfThisMachine();

}  // namespace gauntlet::master
