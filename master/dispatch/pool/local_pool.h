// A pool of gauntlet-worker processes on this machine.
#pragma once

#include <chrono>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "base/result.h"
#include "base/system/clock.h"
#include "base/system/program_path.h"
#include "base/system/unique_fd.h"
#include "master/dispatch/pool/worker_pool.h"

namespace gauntlet {

struct LocalPoolOptions {
  int workers = 1;
  std::string program = WorkerProgramPath();
  std::string access_file;    // how workers find the master
  std::string log_directory;  // must exist; worker K writes to worker-K.log in it
  // A worker that ends of itself sooner than this after its start has failed to start; after more than
  // `start_attempts` such ends in a row the pool gives up. SIGKILL and SIGTERM come from outside and do not
  // count.
  std::chrono::milliseconds start_time{2000};
  int start_attempts = 5;
};

// Starts its processes in sessions of their own: a Ctrl-C reaches the master alone, which then decides.
// Workers end with the thread that started them (PR_SET_PDEATHSIG), so call everything from the main thread.
class LocalPool final : public WorkerPool {
 public:
  // Error: the program or the log file cannot be had.
  static Result<std::unique_ptr<LocalPool>> Start(const LocalPoolOptions& options, TimePoint now);
  // Ends what still runs (SIGTERM, after a second SIGKILL) and waits for it.
  ~LocalPool() override;
  LocalPool(const LocalPool&) = delete;
  LocalPool& operator=(const LocalPool&) = delete;

  Result<std::vector<pid_t>> Supervise(TimePoint now) override;
  void AppendWaitFds(std::vector<int>& fds) const override;
  int running() const override;
  bool OnThisMachine() const override { return true; }
  void StopReplacing() override { replacing_ = false; }
  void SignalAll(int signal) override;
  std::vector<DispatchEvent> TakeEvents() override { return std::exchange(events_, {}); }

  std::vector<pid_t> pids() const;

 private:
  struct Slot {
    pid_t pid = -1;  // -1: not running
    UniqueFd pidfd;  // invalid: not running, or the kernel has none
    TimePoint started{};
    TimePoint start_again{};
    int failed_starts = 0;
    std::string log_file;
  };

  explicit LocalPool(const LocalPoolOptions& options);
  Status StartWorker(Slot& slot, TimePoint now);
  // What to say about an ended worker; sets error_ when it is one too many.
  void Bury(Slot& slot, int status, TimePoint now);
  // After the system refused a process (or its log file): sets error_ when that lasts and none is left.
  void Postpone(Slot& slot, const Status& failure, TimePoint now);

  LocalPoolOptions options_;
  std::vector<Slot> slots_;
  bool replacing_ = true;
  Status error_ = Ok{};
  std::vector<DispatchEvent> events_;
};

}  // namespace gauntlet
