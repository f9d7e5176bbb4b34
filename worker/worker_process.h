// What gauntlet-worker does once its command line is read: serve a master, or simulate one spec. The run
// function comes from outside, so that tests can bring one that crashes.
#pragma once

#include <sys/types.h>

#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "base/result.h"
#include "proto/golden_hashes.h"
#include "worker/runner/runner.h"

namespace gauntlet::worker {

// Of those of these controllers that a run function can simulate; of all when none is named.
using GoldenHashFunction = std::function<proto::GoldenHashes(const std::vector<std::string>& controllers)>;

struct WorkerOptions {
  std::string access_path;  // access.json; waited for up to orphan_timeout_seconds
  int slots = 1;            // runs simulated at the same time
  pid_t parent = 0;         // > 0: end with this process, which started us
  double orphan_timeout_seconds = 600.0;
  std::string log_file;    // "": stderr
  bool quiet = false;      // warnings and errors only
  std::string allocation;  // told to the master, which may keep a pool of batch jobs
  std::string software_version;
  GoldenHashFunction golden_hashes;
  PluginSettings plugins = {};
};

// Serves until the master lets it go; the exit code (worker_state.h). To be called from main(), before any
// thread exists. Changes signal masks and dispositions of the process.
int RunWorker(const WorkerOptions& options, const RunFunction& run);

struct LogLimits {
  std::size_t bytes = 4U << 20;  // worker-1.log that would grow beyond becomes worker-1.1.log
  std::size_t former = 1;        // files kept beside the current one
};

// From now on spdlog's default logger writes to this file, errors to stderr too; with "" everything goes to
// stderr. `quiet`: warnings and errors only. Every line is written when the call that logs it returns.
// Error: the file cannot be opened.
Status StartLogging(const std::string& file, bool quiet, const LogLimits& limits = {});

struct SpecOptions {
  std::string spec_file = "-";  // a serialized RunSpec; "-": stdin
  bool quiet = false;           // nothing is said of a run that gave a result
  double cpu_limit_seconds = 600.0;
  std::uint64_t memory_limit_bytes = std::uint64_t{2} << 30;
  pid_t parent = 0;  // > 0: end with this process, which started us
  PluginSettings plugins = {};
};

// The bytes of a serialized RunSpec; "-": of stdin. Error: they cannot be read.
Result<std::string> ReadSpec(const std::string& file);

// Simulates one spec in a runner, under limits, and writes the serialized RunResult to stdout. A run that
// ends its runner gives a result too, with the verdict and message of proto/README.md; what it printed goes
// to stderr. Exit code 0 when a result was written, 2 when the spec could not be read or its plug-in cannot
// be had, 4 when the runner was ended from outside.
int RunOneSpec(const SpecOptions& options, const RunFunction& run);

}  // namespace gauntlet::worker
