// The command line of gauntlet-worker, for any program that brings a run function.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "worker/runner.h"

namespace gauntlet::worker {

struct WorkerFunctions {
  RunFunction run;
  std::function<std::uint64_t()> golden_hash;
  std::vector<std::string> controllers = {};  // names of those that `run` can simulate
};

// The exit code. To be called from main(), before any thread exists.
int RunWorkerCommandLine(int argc, char** argv, const WorkerFunctions& functions);

}  // namespace gauntlet::worker
