// A program of somebody else's: it is started in a folder and watched under limits, with all that it starts.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "base/result.h"
#include "worker/runner/control_group.h"

namespace gauntlet::worker {

struct WatchedOptions {
  std::vector<std::string> arguments;    // the first one is looked for as FindProgram says
  std::vector<std::string> environment;  // "NAME=value"
  std::string folder;                    // its working directory
  std::string stdout_file;               // in the folder, written anew
  std::string stderr_file;
  // Limits of all its processes together; 0: none.
  double wall_limit = 0.0;         // s
  double cpu_limit = 0.0;          // s, user and system time
  std::uint64_t memory_bytes = 0;  // in RAM; without a group, what two of them share counts twice
  std::uint64_t disk_bytes = 0;    // in the folder, and of any one file that it writes
  // As runs of plug-ins are (confinement.h). Without, programs may gain rights (setuid), and no number of
  // processes is too many.
  bool confine = true;
  // That of this process, which limits what it can; the rest is looked at. nullptr: everything is.
  ControlGroup* group = nullptr;
};

enum class ExceededLimit { kNone, kWall, kCpu, kMemory, kDisk, kProcesses };
// How many processes a program may have at the same time.
inline constexpr std::size_t kMostProcesses = 512;

struct WatchedOutcome {
  int wait_status = 0;  // of the program; its processes were killed when a limit was exceeded
  ExceededLimit exceeded = ExceededLimit::kNone;
  // User and system time of all its processes; without a group, but of those nobody has waited for.
  double cpu_seconds = 0.0;
};

// The path of a program: in the folder, or else in the environment's PATH; a name with a slash is a path.
// Error: kNotFound, it is nowhere or no file that may be executed; the sentence names it.
Result<std::string> FindProgram(const std::string& name, const std::vector<std::string>& environment,
                                const std::string& folder);

// Runs a program to its end, or to that of a limit, and ends whatever it has left. It has a session of its
// own, reads nothing, gets no file of ours and the usual signals, leaves no core dump and dies with this
// process. This process takes orphans over from now on, has one thread, and loses all other children that it
// may have. Errors: kNotFound when the program cannot be found or executed, with a sentence that names it;
// else what this process could not get.
Result<WatchedOutcome> RunWatched(const WatchedOptions& options);

// "ended with exit code 3", "exceeded its limit of 600 s of wall time".
std::string HowItEnded(const WatchedOptions& options, const WatchedOutcome& outcome);

// The last bytes of a file; nothing when there is none.
std::string TailOf(const std::string& path, std::size_t most_bytes);

}  // namespace gauntlet::worker
