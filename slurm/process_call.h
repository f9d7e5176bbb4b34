// Runs one short program and waits for it, never longer than a deadline.
#pragma once

#include <chrono>
#include <string>
#include <vector>

#include "sim/base/result.h"

namespace gauntlet::slurm {

struct CallOutput {
  int exit_code = 0;  // 128 + signal when a signal ended it
  std::string out;    // at most 16 MB are kept
  std::string err;
};

// `arguments[0]` is looked for in PATH; `input` goes to its standard input. The environment is this process'
// without SLURM_* and SBATCH_* (an enclosing job's settings would leak into what is submitted), except
// SLURM_CONF, which says which cluster is meant. At the deadline the program is killed. Errors: kNotFound
// when there is no such program, kIo when it did not end in time. Thread-safe.
Result<CallOutput> CallProcess(const std::vector<std::string>& arguments, const std::string& input,
                               std::chrono::milliseconds deadline);

}  // namespace gauntlet::slurm
