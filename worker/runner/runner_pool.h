// The supervisor's runners, one per slot: hands them jobs, collects their reports and their output, replaces
// those that ended. Never waits.
#pragma once

#include <poll.h>

#include <chrono>
#include <deque>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "worker/runner/fork_server.h"
#include "worker/worker_events.h"

namespace gauntlet::worker {

// Thread-safety: one calling thread.
class RunnerPool {
 public:
  using TimePoint = std::chrono::steady_clock::time_point;

  // Asks for `slots` runners at once; `server` must outlive the pool.
  RunnerPool(ForkServer& server, int slots);

  // What to poll for, in an order that Process expects.
  std::vector<pollfd> Descriptors() const;
  // Works off what poll found in Descriptors() (same order, untouched since): SlotBecameReady, RunFinished,
  // RunnerDied, NoRunnerStarted and, as the last one, AllRunnersLost. `now` paces repeated starts.
  std::vector<WorkerEvent> Process(std::span<const pollfd> polled, TimePoint now);

  // The slot must have been reported ready. When it has jobs already, this one follows them: RunFinished
  // comes in their order, RunnerDied is about the first one and ends all. Sent by Flush at the latest.
  void StartJob(int slot, const RunnerJob& job);
  // Sends what waits, as far as possible. Call before sleeping on Descriptors().
  void Flush();
  // SIGKILL; the slot is heard of again by RunnerDied (or a report that was under way).
  void Kill(int slot);

 private:
  struct Slot {
    pid_t pid = -1;  // -1: no runner
    UniqueFd pipe;
    UniqueFd output;
    FrameBuffer reports;
    std::string unsent;       // what is left of the jobs' frames
    std::string output_tail;  // what the jobs since it was last without printed, its end
    std::size_t jobs = 0;     // that it has not reported
    // Of them, those whose frames have not been sent to the end, and their bytes.
    std::deque<std::size_t> unsent_frames;
    bool broke_protocol = false;       // was killed for it: its own fault
    double process_cpu_seconds = 0.0;  // as of the last report
  };

  void HandleServer(std::vector<WorkerEvent>& events, TimePoint now);
  void Started(RunnerStarted started, std::vector<WorkerEvent>& events);
  void Exited(const RunnerExited& exited, std::vector<WorkerEvent>& events);
  void ReadReports(int slot, std::vector<WorkerEvent>& events);
  void ReadOutput(Slot& slot);
  void SendRest(Slot& slot);
  void BreakOff(Slot& slot);

  ForkServer& server_;
  std::vector<Slot> slots_;
  bool lost_ = false;
  std::optional<TimePoint> retry_at_;
  int to_retry_ = 0;
};

}  // namespace gauntlet::worker
