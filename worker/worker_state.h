// The supervisor's decisions as a pure state machine: events with a clock value in, actions out. No sockets,
// no processes, no time of its own.
//
//                 Welcome                       10 heartbeats of silence
//   greeting  ----------------->  welcomed  ------------------------------->  greeting (reconnected)
//      | Refused: exit 2              | Drain or signal
//      | orphan_timeout: exit 3       v
//      +------------------------> draining: finish or drop, hand in, Goodbye, exit 0
//
// Invariants: a lease is held (queued, running or finished) until its result is acknowledged, it is cancelled
// or this process ends; every held lease stands in Hello and in every heartbeat; a finished result is sent
// after every Welcome and again after ten heartbeats without an acknowledgement.
//
// A result whose lease says so (Lease::result_wait) is held back and sent with those that follow it, so that
// they wake the master once: until fewer leases wait here than results do, or the first of them has waited
// long enough, or this worker leaves.
//
// A runner has one run at a time, except when runs are very short: then about a millisecond of them is handed
// to it ahead, because waking each other for every single one costs more than such runs. What did not begin
// when the runner ends begins elsewhere. A run that was leased before goes alone, so that what a runner
// printed before it died is certainly that run's.
#pragma once

#include <chrono>
#include <deque>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "worker/worker_events.h"

namespace gauntlet::worker {

using TimePoint = std::chrono::steady_clock::time_point;
using Duration = std::chrono::steady_clock::duration;

// Exit codes of gauntlet-worker.
inline constexpr int kExitDone = 0;
inline constexpr int kExitRefused = 2;   // by the master, a wrong command line, or without a plug-in it needs
inline constexpr int kExitOrphaned = 3;  // no master within orphan_timeout
inline constexpr int kExitInternal = 4;

// A worker that has had no runner for so long, and could start none, gives its leases back and leaves. A full
// process table may empty itself within seconds, when other jobs of the node end.
inline constexpr std::chrono::seconds kNoRunnerPatience{10};

struct WorkerSettings {
  Hello identity;  // all but held_leases
  Duration orphan_timeout = std::chrono::seconds(600);
  Duration hello_interval = std::chrono::seconds(1);
  // After a signal: running runs are dropped, then the worker leaves, acknowledged or not. Slurm and systemd
  // send SIGKILL 30 s after SIGTERM.
  Duration stop_finish = std::chrono::seconds(20);
  Duration stop_leave = std::chrono::seconds(25);
  // When nothing runs any more, how long a draining worker waits for the last acknowledgements.
  Duration acknowledge_wait = std::chrono::seconds(5);
};

// Thread-safety: one calling thread.
class WorkerState {
 public:
  WorkerState(WorkerSettings settings, TimePoint now);

  // The connection stands (or is being made): the first Hello.
  std::vector<WorkerAction> Start();
  // After Exit, events give no actions.
  std::vector<WorkerAction> Handle(WorkerEvent event, TimePoint now);
  // When the next ClockTick is due at the latest.
  TimePoint NextTick() const;

  // So long nobody needs this process, whatever happens: every runner has more very short runs ahead. Waking
  // for each of their reports would cost more than the runs.
  Duration Nap() const;

  bool welcomed() const { return phase_ == Phase::kWelcomed; }
  bool draining() const { return drain_.has_value(); }
  std::vector<Fence> HeldLeases() const;
  // What the slot's runner works on; nullptr when it has nothing.
  const Lease* LeaseIn(int slot) const;

 private:
  enum class Phase { kGreeting, kWelcomed, kExited };
  enum class SlotState { kStarting, kIdle, kRunning, kKilling };
  struct Given {
    Lease lease;
    bool wanted = true;  // its result will be handed in
  };
  struct Slot {
    SlotState state = SlotState::kStarting;
    std::deque<Given> runs;  // when running: the first is being simulated, the others follow
    Duration begun{};        // value of awake_ when the first began
    bool used = false;       // its runner has had a run
  };
  struct Finished {
    LeaseResult result;
    TimePoint sent;  // or held back
  };
  struct DrainPlan {
    std::string reason;
    int exit_code = kExitDone;
    std::optional<TimePoint> drop_at = {};   // running runs are given up
    std::optional<TimePoint> leave_at = {};  // exit, whatever is not acknowledged
  };

  void On(MasterMessage& message);
  void On(const Welcome& welcome);
  void On(const Refused& refused) { Leave(kExitRefused, refused.reason); }
  void On(Lease& lease);
  void On(const Acknowledge& acknowledge);
  void On(const Heartbeat&) {}
  void On(const Cancel& cancel) { Forget(cancel.fence); }
  void On(const Drain& drain);
  void On(const SlotBecameReady& ready);
  void On(RunFinished& finished);
  void On(RunnerDied& died);
  void On(const NoRunnerStarted& failed);
  void On(const AllRunnersLost&) { GiveUp("the fork server ended", kExitInternal); }
  void On(const MasterMoved&) { GreetAgain(); }
  void On(const ConnectionRestored& restored);
  void On(const StopRequested& stop);
  void On(const ClockTick& tick);

  void Act(WorkerAction action) { actions_.push_back(std::move(action)); }
  void SayHello();
  void Greet();
  void GreetAgain();
  void ResendLateResults();
  void Kill(std::size_t index);  // the slot's runner; another takes its place
  void EndBlockedRuns();
  void Forget(Fence fence);
  bool Holds(Fence fence) const;
  void StartWaitingRuns();
  void StartNext(std::size_t index);
  std::size_t RunsAhead() const;  // how many runs a runner may have, 1 or more
  void EndRuns(Slot& slot);       // all but the first wait again
  // The lease's result, whose other members are given.
  void HandIn(const Lease& lease, LeaseResult result);
  void SendHeldBack();
  void SendHeldBackIfDue();
  void GiveBack(const Lease& lease, const std::string& why);
  void GiveBackRuns(Slot& slot, const std::string& why);
  void DropRunning(const std::string& why);
  void GiveUp(const std::string& reason, int exit_code);
  void ContinueDrain();
  void Leave(int code, const std::string& reason);
  std::size_t RunningCount() const;

  WorkerSettings settings_;
  Phase phase_ = Phase::kGreeting;
  TimePoint now_;
  Duration awake_{};  // time that passed, without what passed while this process was frozen
  TimePoint last_heard_;
  Duration heard_awake_{};  // value of awake_ then
  TimePoint connected_;     // last (re)connect while greeting
  bool asked_ = false;      // Hello was said for the silence that lasts
  TimePoint last_hello_;
  TimePoint last_heartbeat_;
  std::uint64_t sequence_ = 0;
  Welcome welcome_;  // the newest; its heartbeat also paces what happens before the first
  std::vector<Slot> slots_;
  std::optional<Duration> without_runners_;  // since this value of awake_, and none could be started
  std::deque<Lease> waiting_;
  double lately_longest_ = -1.0;  // CPU time of recent runs, s; negative: none has ended
  std::map<Fence, Finished> finished_;
  std::vector<Fence> held_back_;  // of finished_, in the order in which they ended
  TimePoint send_held_back_at_;   // when there are any
  std::optional<DrainPlan> drain_;
  std::vector<WorkerAction> actions_;
};

}  // namespace gauntlet::worker
