// Runs one program and waits for it: the one way in which other programs are called and listened to.
#pragma once

#include <chrono>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/result.h"

namespace gauntlet {

struct CallOutput {
  int exit_code = 0;  // 128 + signal when a signal ended it
  int signal = 0;     // 0 when it exited
  std::string out;    // at most 16 MiB are kept, of a part of ourselves 1 GiB
  std::string err;    // "" of a part of ourselves
};

enum class Callee {
  // A command of the batch system: in a process group of its own, for Ctrl-C is ours to handle, and without
  // SLURM_* and SBATCH_*, for an enclosing job's settings would leak into what is submitted; except
  // SLURM_CONF, which says which cluster is meant.
  kBatchSystem,
  // A program of ours: Ctrl-C ends both, it has our environment, and its stderr is ours.
  kPartOfUs,
};

// `arguments[0]` is looked for in PATH; `input` goes to its standard input. At the deadline, if there is one,
// the program is killed. Errors: kNotFound when there is no such program, kIo when it did not end in time.
// Thread-safe.
Result<CallOutput> CallProcess(const std::vector<std::string>& arguments, std::string_view input,
                               std::optional<std::chrono::milliseconds> deadline,
                               Callee callee = Callee::kBatchSystem);

}  // namespace gauntlet
