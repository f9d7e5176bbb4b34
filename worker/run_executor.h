// The pure function at the heart of everything: RunSpec in, RunResult out.
#pragma once

#include "sim/run_result.h"
#include "sim/run_spec.h"

namespace gauntlet::worker {

// Same spec, same bits, on any x86-64 machine. An invalid spec gives the verdict "refused" with the name of
// the broken rule.
sim::RunResult Run(const sim::RunSpec& spec);

// Runs and sends a second of what is built in. What a process sets up in its first run, the registry's tables
// and the addresses of functions in libraries, is then there in every process that is forked from this one.
sim::RunResult Rehearse();

}  // namespace gauntlet::worker
