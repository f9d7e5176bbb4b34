// Worker processes that the master itself keeps running; local_pool.h starts them on this machine.
#pragma once

#include <sys/types.h>

#include <string>
#include <vector>

#include "base/result.h"
#include "base/system/clock.h"
#include "master/dispatch/evaluation_backend.h"

namespace gauntlet {

// What the master knows of its workers and its work, for pools that grow and shrink.
struct PoolView {
  struct Worker {
    std::string allocation;  // as the worker was told at its start, "" for none
    bool busy = false;       // has a lease
  };
  int unfinished_runs = 0;
  std::vector<Worker> workers;  // connected ones
};

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
  // Whether what runs are the workers themselves, here; otherwise batch jobs, in which some are elsewhere.
  virtual bool OnThisMachine() const { return false; }
  // From now on ended processes are not replaced.
  virtual void StopReplacing() = 0;
  virtual void SignalAll(int signal) = 0;
  virtual std::vector<DispatchEvent> TakeEvents() = 0;
  // Comes before each Supervise.
  virtual void Observe(const PoolView& /*view*/, TimePoint /*now*/) {}
  // The batch jobs of an elastic pool.
  virtual std::vector<AllocationView> Allocations() const { return {}; }
  // This master leaves to a successor: what runs is left to it. False when workers end with their master.
  virtual bool Release() { return false; }
  // Why there are fewer workers than could be used, in a sentence; "" when all is well.
  virtual std::string Trouble(TimePoint /*now*/) const { return ""; }
};

}  // namespace gauntlet
