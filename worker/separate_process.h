// Work in a process that is forked for it and ends with it: for code that may do anything to its process.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>

#include "base/result.h"

namespace gauntlet::worker {

// Exit codes by which a process says why it gave up. Outside the range that programs commonly use.
inline constexpr int kExitOutOfMemory = 86;
inline constexpr int kExitException = 87;
inline constexpr int kExitWithoutPlugin = 88;  // the plug-in that it needs cannot be had here
inline constexpr int kExitWithoutResult = 89;  // somebody called exit(0) before there was a result

// Calls `work`. What it throws ends this process, with words on stderr; so does a lack of memory, also in
// `work`'s callees and for the rest of the process' life.
std::string CallOrEnd(const std::function<std::string()>& work);

struct SeparateOptions {
  double cpu_limit_seconds = 0.0;        // 0 = no limit; rounded up to a whole second
  std::uint64_t memory_limit_bytes = 0;  // address space; 0 = as this process
  unsigned wall_limit_seconds = 0;       // 0 = no limit
  // Its working directory, which gets the file output.txt with what it prints; made when missing, and kept.
  // "": one that is removed afterwards.
  std::string scratch = "";
};

struct SeparateOutcome {
  std::optional<std::string> bytes;  // what `work` returned; nothing when the process ended before
  int wait_status = 0;
  std::string output_tail;  // the end of what it printed
};

// Calls `work` in a process that dies with this one, and waits for it. Whatever it has started goes with it.
// To be called while this process has one thread only. Error: no process or no folder could be made.
Result<SeparateOutcome> CallInSeparateProcess(const std::function<std::string()>& work,
                                              const SeparateOptions& options);

// Ends this process in the way in which a separate one ended without a result, after saying on stderr what
// that one printed last.
[[noreturn]] void EndAs(const SeparateOutcome& outcome);

}  // namespace gauntlet::worker
