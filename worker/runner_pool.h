// The supervisor's runners, one per slot: hands them jobs, collects their reports and their output, replaces
// those that ended. Never waits.
#pragma once

#include <poll.h>

#include <chrono>
#include <deque>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "worker/fork_server.h"
#include "worker/runner.h"

namespace gauntlet::worker {

// A slot has a runner that waits for a job.
struct SlotReady {
  int slot = 0;
};
struct SlotFinished {
  int slot = 0;
  RunnerReport report;
};
// The slot's runner ended during its first job. SlotReady follows when it is replaced.
struct SlotFailed {
  int slot = 0;
  proto::RunnerFailure failure;
  double cpu_seconds = 0.0;  // of the job
};
// The slot's runner ended, but not during a job.
struct SlotEmptied {
  int slot = 0;
};
// No runner could be started for some slot; it is tried again.
struct SlotNotStarted {
  int error = 0;  // errno
};
// The fork server is gone and all runners with it; nothing more will come.
struct RunnersLost {};
using PoolEvent = std::variant<SlotReady, SlotFinished, SlotFailed, SlotEmptied, SlotNotStarted, RunnersLost>;

// For a person, with what may be the matter: "cannot start a runner: Resource temporarily unavailable (...)".
std::string Describe(const SlotNotStarted& event);

// Thread-safety: one calling thread.
class RunnerPool {
 public:
  using TimePoint = std::chrono::steady_clock::time_point;

  // Asks for `slots` runners at once; `server` must outlive the pool.
  RunnerPool(ForkServer& server, int slots);

  // What to poll for, in an order that Process expects.
  std::vector<pollfd> Descriptors() const;
  // Works off what poll found in Descriptors() (same order, untouched since). `now` paces repeated starts.
  std::vector<PoolEvent> Process(std::span<const pollfd> polled, TimePoint now);

  // The slot must have been reported ready. When it has jobs already, this one follows them: SlotFinished
  // comes in their order, SlotFailed is about the first one and ends all. Sent by Flush at the latest.
  void StartJob(int slot, const RunnerJob& job);
  // Sends what waits, as far as possible. Call before sleeping on Descriptors().
  void Flush();
  // SIGKILL; the slot is heard of again by SlotFailed or SlotEmptied (or a report that was under way).
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

  void HandleServer(std::vector<PoolEvent>& events, TimePoint now);
  void Started(RunnerStarted started, std::vector<PoolEvent>& events);
  void Exited(const RunnerExited& exited, std::vector<PoolEvent>& events);
  void ReadReports(int slot, std::vector<PoolEvent>& events);
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
