// The pure function at the heart of everything: RunSpec in, RunResult out.
#pragma once

#include "sim/run_result.h"
#include "sim/run_spec.h"

namespace gauntlet::worker {

// Same spec, same bits, on any x86-64 machine. An invalid spec gives the verdict "refused" with the name of
// the broken rule.
sim::RunResult Run(const sim::RunSpec& spec);

}  // namespace gauntlet::worker
