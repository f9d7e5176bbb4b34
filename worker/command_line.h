// The command line of gauntlet-worker, for any program that brings a run function.
#pragma once

#include <functional>

#include "proto/golden_hashes.h"
#include "worker/runner.h"

namespace gauntlet::worker {

struct WorkerFunctions {
  RunFunction run;
  std::function<proto::GoldenHashes()> golden_hashes;  // of the controllers that `run` can simulate
};

// The exit code. To be called from main(), before any thread exists.
int RunWorkerCommandLine(int argc, char** argv, const WorkerFunctions& functions);

}  // namespace gauntlet::worker
