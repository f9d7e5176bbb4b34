// Work in a process that is forked for it and ends with it: for code that may do anything to its process.
#pragma once

#include <sys/types.h>

#include <cstdint>
#include <functional>
#include <optional>
#include <string>

#include "base/result.h"
#include "base/system/unique_fd.h"
#include "proto/run_failure.h"

namespace gauntlet::worker {

using proto::kExitException;
using proto::kExitOfProgram;
using proto::kExitOutOfMemory;
using proto::kExitOverDisk;
using proto::kExitOverProcesses;
using proto::kExitSignalled;
using proto::kExitUnheard;
using proto::kExitWithoutMetrics;
using proto::kExitWithoutPlugin;
using proto::kExitWithoutResult;

// Whether a signal that ended a process was somebody else's: SIGKILL, SIGTERM and the like.
bool OnlyOthersSend(int signal);

// Calls `work`. What it throws ends this process, with words on stderr; so does a lack of memory, also in
// `work`'s callees and for the rest of the process' life.
std::string CallOrEnd(const std::function<std::string()>& work);

struct SeparateOptions {
  double cpu_limit_seconds = 0.0;        // 0 = no limit; rounded up to a whole second
  std::uint64_t memory_limit_bytes = 0;  // address space; 0 = as this process
  unsigned wall_limit_seconds = 0;       // 0 = no limit
  // Its working directory and that of its temporary files (TMPDIR), which gets the file output.txt with what
  // it prints; made when missing, and kept. "": one that is removed afterwards, for PreparedProcess only.
  std::string scratch = "";
};

struct SeparateOutcome {
  std::optional<std::string> bytes;  // what `work` returned; nothing when the process ended before
  int wait_status = 0;
  std::string output_tail;  // the end of what it printed
};

// How a process hands a result of up to 1 GiB to the one that has forked it: a file in memory, made before
// either is limited.
class ResultFile {
 public:
  static Result<ResultFile> Make();
  void Clear() const;
  // In the process that has the result; false with errno: it cannot be written.
  bool Write(const std::string& bytes) const;
  // What was written since it was cleared.
  std::optional<std::string> Read() const;
  int descriptor() const { return file_.get(); }

 private:
  UniqueFd file_;
};

// Calls `work` in a process that dies with this one, and waits for it. Whatever it has started goes with it,
// and so do all other children of this process, which takes orphans over. To be called while this process has
// one thread only. Error: no process could be made.
Result<SeparateOutcome> CallInSeparateProcess(const std::function<std::string()>& work,
                                              const SeparateOptions& options, const ResultFile& result);

// The parts of it, for processes that are started in another way.

// What such a process prints, in its folder.
inline constexpr const char* kOutputFile = "output.txt";
// This process gets that working directory, has its temporary files there, prints into it from now on, line
// by line, and reads nothing. False: it cannot.
bool MoveInto(const std::string& folder);
// Limits this process and all below it for good, so that they cannot raise the limits again; forbids them
// core dumps and files of more than 64 MiB.
void LimitForGood(const SeparateOptions& options);
// Limits the time of this process by signals, SIGXCPU and SIGALRM.
void LimitTime(const SeparateOptions& options);
// Waits for the child, with whatever of its process group is left, and reaps it. Its status, as of waitpid.
int WaitForGroup(pid_t child);
// The end of what was printed in the folder.
std::string OutputTail(const std::string& folder);
// User and system time of this process and of its children that have ended, s.
double SecondsWithChildren();

// Ends this process by the signal that ended another one. A signal as SIGTERM or SIGUSR1 that met that
// process alone came from what runs in it, so this one says so, with the name of `what` that is, and exits
// with kExitSignalled and its number; but SIGKILL, by which the kernel ends a process when memory is short,
// stays somebody else's.
[[noreturn]] void EndBySignal(int number, const char* what);
// Ends this process in the way in which a separate one ended without a result, after saying on stderr what
// that one printed last.
[[noreturn]] void EndAs(const SeparateOutcome& outcome);

}  // namespace gauntlet::worker
