// Where a worker logs to.
#pragma once

#include <cstddef>
#include <string>

#include "base/result.h"

namespace gauntlet::worker {

struct LogLimits {
  std::size_t bytes = 4U << 20;  // worker-1.log that would grow beyond becomes worker-1.1.log
  std::size_t former = 1;        // files kept beside the current one
};

// From now on spdlog's default logger writes to this file, errors to stderr too; with "" everything goes to
// stderr. `quiet`: warnings and errors only. Every line is written when the call that logs it returns.
// Error: the file cannot be opened.
Status StartLogging(const std::string& file, bool quiet, const LogLimits& limits = {});

}  // namespace gauntlet::worker
