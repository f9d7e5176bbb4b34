// Real processes for drills: start, read, signal, wait with a deadline. Nothing outlives the object.
#pragma once

#include <sys/types.h>

#include <chrono>
#include <functional>
#include <string>
#include <vector>

#include "tests/support/sanitizer.h"

namespace gauntlet::testing_support {

// Long enough for anything on a busy machine.
inline constexpr std::chrono::seconds kPatience{kSanitized ? 300 : 60};

struct ProcessResult {
  int exit_code = -1;  // -1 when it ended by a signal
  int signal = 0;
  std::string out;
  std::string err;
};

class Process {
 public:
  // Starts argv[0] (a path) in its own process group with `environment` ("KEY=value") added to ours. stdout
  // and stderr go to temporary files, stdin is /dev/null.
  explicit Process(const std::vector<std::string>& argv, const std::vector<std::string>& environment = {});
  Process(const Process&) = delete;
  Process& operator=(const Process&) = delete;
  // Kills (SIGKILL) and reaps it when it still runs.
  ~Process();

  pid_t pid() const { return pid_; }
  bool Running();
  void Signal(int signal) const;
  // Waits for its end; kills it at the deadline and reports signal 9.
  ProcessResult Wait(std::chrono::seconds deadline = 2 * kPatience);
  // What it has written so far.
  std::string Out() const;
  std::string Err() const;

 private:
  bool Reap(bool block);

  pid_t pid_ = -1;
  bool reaped_ = false;
  int status_ = 0;
  int out_fd_ = -1;
  int err_fd_ = -1;
};

// Process and Wait in one.
ProcessResult RunProcess(const std::vector<std::string>& argv,
                         const std::vector<std::string>& environment = {},
                         std::chrono::seconds deadline = 2 * kPatience);

// Polls until `condition` holds; false at the deadline.
bool Eventually(const std::function<bool()>& condition, std::chrono::milliseconds deadline);

// Pids of the living processes whose parent is `pid` (zombies left out).
std::vector<pid_t> ChildrenOf(pid_t pid);
// Pids below `pid`, at any depth.
std::vector<pid_t> DescendantsOf(pid_t pid);
bool Alive(pid_t pid);

// A directory that is deleted with the object.
class TemporaryDirectory {
 public:
  TemporaryDirectory();
  TemporaryDirectory(const TemporaryDirectory&) = delete;
  TemporaryDirectory& operator=(const TemporaryDirectory&) = delete;
  ~TemporaryDirectory();
  const std::string& path() const { return path_; }
  std::string operator/(const std::string& name) const { return path_ + "/" + name; }

 private:
  std::string path_;
};

}  // namespace gauntlet::testing_support
