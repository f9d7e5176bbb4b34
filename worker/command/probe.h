// What tells installations of a simulator apart: a hash of what its probe prints. It stands for the program
// as the golden hash stands for a controller that is built in.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "base/result.h"
#include "proto/golden_hashes.h"
#include "worker/command/command_files.h"
#include "worker/worker_process.h"

namespace gauntlet::worker {

// Runs a definition's probe, after its setup, in a folder with its files; without one, only looks for the
// program. Uses RunWatched, as it is described there. Error: the program is not there, the probe failed or
// took more than a minute; with what it printed.
Result<std::uint64_t> ProbeOf(CommandFiles& files, const std::string& hash);

// Those of commands by their probes, which run in a process of its own; the others' by `built_in`, as all
// when no name is given.
Result<proto::GoldenHashes> GoldenHashesOf(const std::vector<std::string>& names,
                                           const GoldenHashFunction& built_in,
                                           const PluginSettings& settings);

}  // namespace gauntlet::worker
