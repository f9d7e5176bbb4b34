// Worker processes that the master itself keeps running; local_pool.h starts them on this machine.
#pragma once

#include <sys/types.h>

#include <vector>

#include "master/dispatch/clock.h"
#include "master/dispatch/evaluation_backend.h"
#include "sim/base/result.h"

namespace gauntlet::master {

// Thread-safety: one thread.
class WorkerPool {
 public:
  virtual ~WorkerPool() = default;
  // Reaps processes that have ended, starts others in their place and returns the pids of the ended ones.
  // Error: no worker can be kept running; it comes again with every call.
  virtual Result<std::vector<pid_t>> Supervise(TimePoint now) = 0;
  // Descriptors that become readable when Supervise has something to do.
  virtual void AppendWaitFds(std::vector<int>& fds) const = 0;
  virtual int running() const = 0;
  // From now on ended processes are not replaced.
  virtual void StopReplacing() = 0;
  virtual void SignalAll(int signal) = 0;
  virtual std::vector<DispatchEvent> TakeEvents() = 0;
};

}  // namespace gauntlet::master
