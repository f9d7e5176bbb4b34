// A run of no interest, which prepares a process for those that are forked from it.
#pragma once

#include "sim/run_result.h"

namespace gauntlet::worker {

// Runs and sends a second of what is built in. What a process sets up in its first run, the registry's tables
// and the addresses of functions in libraries, is then there in every process that is forked from this one.
sim::RunResult Rehearse();

}  // namespace gauntlet::worker
