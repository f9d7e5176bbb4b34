// log/master.log: one line per event, with run ids and fencing numbers as the events give them.
#pragma once

#include <cstddef>
#include <string>

#include "base/result.h"

namespace gauntlet {

struct LogLimits {
  std::size_t bytes = 16U << 20;  // a file that would grow beyond becomes master.1.log
  std::size_t former = 4;         // files kept beside the current one
};

// From now on spdlog's default logger writes to this file; every line is in the file when the call that logs
// it returns. The folder is made when there is none. Logging is no reason to stop: when the file cannot be
// opened nothing is logged. kInvalidInput when the folder or the file is something else, a link too: who
// knows what would be written to.
Status OpenMasterLog(const std::string& path, const LogLimits& limits = {});

}  // namespace gauntlet
