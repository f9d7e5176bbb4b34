// The command line of gauntlet-worker, for any program that brings a run function.
#pragma once

#include "worker/plugin/describe_plugin.h"
#include "worker/worker_process.h"

namespace gauntlet::worker {

struct WorkerFunctions {
  RunFunction run;
  GoldenHashFunction golden_hashes;
  LoadPluginFunction load_plugin = {};  // without: it is never given a plug-in, as the next
  DescribePluginFunction describe_plugin = {};
  DescribeBeginningFunction describe_beginning = {};
  std::string version = "gauntlet-worker";  // what --version prints
};

// The exit code. To be called from main(), before any thread exists.
int RunWorkerCommandLine(int argc, char** argv, const WorkerFunctions& functions);

}  // namespace gauntlet::worker
