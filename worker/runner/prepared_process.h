// Work in processes of its own, each of which finds something prepared: a library that was loaded. It is
// prepared once, in a process that does nothing else, and the process of every call is forked from that one:
// it finds what was prepared as it was then, whatever earlier calls have done. That process is confined
// (confinement.h), also when it prepares: neither it nor a call does anything to other processes, raises its
// limits, or leaves processes behind.
#pragma once

#include <sys/types.h>

#include <cstdint>
#include <functional>
#include <optional>
#include <set>
#include <string>

#include "base/result.h"
#include "base/system/unique_fd.h"
#include "worker/runner/confinement.h"
#include "worker/runner/pipe.h"
#include "worker/runner/scratch_folder.h"
#include "worker/runner/separate_process.h"

namespace gauntlet::worker {

class PreparedProcess {
 public:
  // `prepare` ends its process when it fails. A process that prints, leaves files, descriptors, threads or
  // children when it prepares is not fit for being forked from: then every call prepares for itself. `files`:
  // those descriptors of this process that the two may use.
  PreparedProcess(std::function<void()> prepare, std::function<std::string(const std::string&)> work,
                  std::set<int> files = {})
      : prepare_(std::move(prepare)), work_(std::move(work)), files_(std::move(files)) {}
  PreparedProcess(const PreparedProcess&) = delete;
  PreparedProcess& operator=(const PreparedProcess&) = delete;
  ~PreparedProcess() { End(); }

  // As CallInSeparateProcess, of work(request). When `prepare` ended its process, that is the outcome.
  Result<SeparateOutcome> Call(const std::string& request, const SeparateOptions& options);
  // Ends the process, which is started again when it is needed.
  void End();
  // User and system time of the process and of those of its calls, s; of what has ended since, nothing.
  double cpu_seconds() const { return cpu_seconds_; }

 private:
  // Nothing: it is ready for calls. Otherwise how it ended.
  Result<std::optional<SeparateOutcome>> Start(const SeparateOptions& options);
  [[noreturn]] void Live(UniqueFd pipe, pid_t parent, const SeparateOptions& options);
  [[noreturn]] void Serve(UniqueFd pipe, const ResultFile& result) const;
  // The next answer; nothing when the process has ended. `cpu_limit`: of all that it starts, s.
  std::optional<std::string> Answer(double cpu_limit);
  SeparateOutcome Reap();
  // Makes the folder new unless nobody can tell it from a new one.
  Status RenewFolder();

  std::function<void()> prepare_;
  std::function<std::string(const std::string&)> work_;
  std::set<int> files_;
  pid_t process_ = 0;                     // 0: there is none
  std::uint64_t memory_limit_bytes_ = 0;  // of the process, and the most that a call can have
  bool for_each_call_ = false;
  UniqueFd pipe_;
  FrameBuffer answers_;
  std::optional<TreeGuard> guard_;       // of the process
  std::optional<ScratchFolder> folder_;  // of preparing, then of one call after the other
  bool over_limit_ = false;              // the last call was ended for its CPU time
  double cpu_seconds_ = 0.0;
};

}  // namespace gauntlet::worker
