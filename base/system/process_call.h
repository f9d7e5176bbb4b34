// Starts programs; and runs one and waits for it: the one way in which others are called and listened to.
#pragma once

#include <sys/types.h>

#include <array>
#include <chrono>
#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/result.h"

namespace gauntlet {

struct SpawnOptions {
  std::array<int, 3> streams;  // what becomes its stdin, stdout and stderr; -1: ours
  int flags = 0;               // POSIX_SPAWN_SETSID, POSIX_SPAWN_SETPGROUP
  // Which of our environment's entries ("NAME=value") it gets; default: all.
  std::function<bool(std::string_view)> inherits = nullptr;
};

// Starts a program, which is looked for in PATH, without any other descriptor of ours and with the usual
// signals: none is blocked, and those that we may handle or ignore do to it what they do by default. Its
// number goes to `child`. The errno, 0 = none. Thread-safe.
int Spawn(const std::vector<std::string>& arguments, const SpawnOptions& options, pid_t& child);

struct CallOutput {
  int exit_code = 0;  // 128 + signal when a signal ended it
  int signal = 0;     // 0 when it exited
  std::string out;    // at most CallOptions::most_output bytes
  std::string err;    // likewise; "" of a part of ourselves
};

struct CallOptions {
  // A part of ourselves is ended by a Ctrl-C as we are, and its stderr is ours. Somebody else's program is in
  // a process group of its own, for Ctrl-C is ours to handle.
  bool part_of_us = false;
  // Then the program is killed; none: it takes its time.
  std::optional<std::chrono::milliseconds> deadline = std::nullopt;
  std::size_t most_output = std::size_t{16} << 20;  // bytes that are kept of each output
  // Which of our environment's entries ("NAME=value") it gets; default: all.
  std::function<bool(std::string_view)> inherits = nullptr;
};

// `arguments[0]` is looked for in PATH; `input` goes to its standard input. Errors: kNotFound when there is
// no such program, kIo when it did not end in time. Thread-safe.
Result<CallOutput> CallProcess(const std::vector<std::string>& arguments, std::string_view input,
                               const CallOptions& options);

}  // namespace gauntlet
