#include "worker/worker_state.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "base/check.h"

namespace gauntlet::worker {
namespace {

// Silence after which access.json is looked at and Hello said again, in case the master has forgotten this
// worker, and after which the connection is given up.
constexpr int kUneasyHeartbeats = 3;
constexpr int kSilentHeartbeats = 10;
constexpr int kHellosPerConnection = 10;
constexpr int kResendHeartbeats = 10;
// CPU time of the runs that a runner may have ahead, s, and how many at most.
constexpr double kWorkAhead = 1e-3;
constexpr std::size_t kMostAhead = 64;
// With fewer ahead there is nothing to gain from a nap.
constexpr std::size_t kLeastAheadForNap = 4;
constexpr double kForget = 0.95;  // per run: so fast a long run is forgotten
// Leases beyond the slots wait here; a master that sends more is told to take them elsewhere.
constexpr std::size_t kMaxWaiting = 4096;

// Ticks come at least every heartbeat; whatever lies further apart, this process was frozen in between.
constexpr Duration kLongestStep = std::chrono::seconds(5);

double Seconds(Duration duration) {
  return std::chrono::duration<double>(duration).count();
}

}  // namespace

WorkerState::WorkerState(WorkerSettings settings, TimePoint now)
    : settings_(std::move(settings)),
      now_(now),
      last_heard_(now),
      connected_(now),
      last_hello_(now),
      last_heartbeat_(now),
      slots_(settings_.identity.slots) {}

std::vector<WorkerAction> WorkerState::Start() {
  Greet();
  return std::exchange(actions_, {});
}

std::vector<WorkerAction> WorkerState::Handle(WorkerEvent event, TimePoint now) {
  if (phase_ == Phase::kExited) return {};
  awake_ += std::clamp<Duration>(now - now_, Duration::zero(), kLongestStep);
  now_ = std::max(now_, now);
  std::visit([this](auto& concrete) { On(concrete); }, event);
  if (phase_ != Phase::kExited) StartWaitingRuns();
  SendHeldBackIfDue();
  if (phase_ != Phase::kExited && drain_) ContinueDrain();
  return std::exchange(actions_, {});
}

TimePoint WorkerState::NextTick() const {
  TimePoint next = phase_ == Phase::kGreeting ? last_hello_ + settings_.hello_interval
                                              : last_heartbeat_ + welcome_.heartbeat;
  if (drain_ && drain_->drop_at && RunningCount() > 0) next = std::min(next, *drain_->drop_at);
  if (drain_ && drain_->leave_at) next = std::min(next, *drain_->leave_at);
  if (!held_back_.empty() && phase_ == Phase::kWelcomed) next = std::min(next, send_held_back_at_);
  return next;
}

const Lease* WorkerState::LeaseIn(int slot) const {
  const Slot& there = slots_.at(static_cast<std::size_t>(slot));
  return there.state == SlotState::kRunning ? &there.runs.front().lease : nullptr;
}

std::vector<Fence> WorkerState::HeldLeases() const {
  std::vector<Fence> fences;
  fences.reserve(finished_.size() + slots_.size() + waiting_.size());
  for (const auto& [fence, finished] : finished_) fences.push_back(fence);
  for (const Slot& slot : slots_) {
    for (const Given& run : slot.runs) {
      if (run.wanted) fences.push_back(run.lease.fence);
    }
  }
  for (const Lease& lease : waiting_) fences.push_back(lease.fence);
  std::sort(fences.begin(), fences.end());
  return fences;
}

// --- The master's messages ---

void WorkerState::On(MasterMessage& message) {
  last_heard_ = now_;
  heard_awake_ = awake_;
  asked_ = false;
  std::visit([this](auto& concrete) { On(concrete); }, message);
}

void WorkerState::On(const Welcome& welcome) {
  if (welcome.epoch < welcome_.epoch) {
    Act(Note{"old-master", fmt::format("a master of epoch {} answered, epoch {} is known: not listened to",
                                       welcome.epoch, welcome_.epoch)});
    return;
  }
  welcome_ = welcome;
  if (phase_ != Phase::kWelcomed) {  // otherwise the answer to a repeated Hello
    phase_ = Phase::kWelcomed;
    last_heartbeat_ = now_;
    held_back_.clear();
    for (auto& [fence, finished] : finished_) {
      finished.sent = now_;
      Act(Send{finished.result});
    }
  }
  if (drain_) Act(Send{Drain{drain_->reason, true}});
}

void WorkerState::On(Lease& lease) {
  if (phase_ != Phase::kWelcomed) {
    Act(Note{"early-lease", "a lease before the welcome: dropped"});
    return;
  }
  if (const auto finished = finished_.find(lease.fence); finished != finished_.end()) {
    finished->second.sent = now_;
    Act(Send{finished->second.result});
    return;
  }
  if (Holds(lease.fence)) return;
  if (drain_) return GiveBack(lease, "the worker is leaving");
  if (waiting_.size() >= kMaxWaiting) return GiveBack(lease, "too many leases wait here already");
  waiting_.push_back(std::move(lease));
}

void WorkerState::On(const Acknowledge& acknowledge) {
  for (const Fence fence : acknowledge.fences) Forget(fence);
}

void WorkerState::On(const Drain& drain) {
  if (!drain_) drain_ = DrainPlan{.reason = drain.reason};
  if (!drain.finish_current) drain_->drop_at = now_;
}

// --- Runners ---

void WorkerState::On(const SlotBecameReady& ready) {
  without_runners_.reset();
  Slot& slot = slots_.at(static_cast<std::size_t>(ready.slot));
  slot.state = SlotState::kIdle;
  slot.used = false;
}

void WorkerState::On(RunFinished& finished) {
  Slot& slot = slots_.at(static_cast<std::size_t>(finished.slot));
  if (slot.state != SlotState::kRunning) return;  // its lease was given up while the report was under way
  const Given run = std::move(slot.runs.front());
  slot.runs.pop_front();
  slot.begun = awake_;
  if (slot.runs.empty()) slot.state = SlotState::kIdle;
  lately_longest_ = std::max(finished.cpu_seconds, kForget * lately_longest_);
  if (!run.wanted) return;
  HandIn(run.lease, {.result = std::move(finished.result), .cpu_seconds = finished.cpu_seconds});
}

void WorkerState::On(RunnerDied& died) {
  Slot& slot = slots_.at(static_cast<std::size_t>(died.slot));
  const bool reported = slot.state == SlotState::kRunning;
  slot.state = SlotState::kStarting;
  if (!reported) return;
  if (IsWithoutPlugin(died.failure)) return GiveUp(died.failure.stderr_tail, kExitRefused);
  const Given run = std::move(slot.runs.front());
  EndRuns(slot);
  if (!run.wanted) return;
  HandIn(run.lease, {.failure = std::move(died.failure), .cpu_seconds = died.cpu_seconds});
}

void WorkerState::On(const NoRunnerStarted& failed) {
  if (std::ranges::any_of(
          slots_, [](SlotState state) { return state != SlotState::kStarting; }, &Slot::state)) {
    without_runners_.reset();
  } else if (!without_runners_) {
    without_runners_ = awake_;
  } else if (awake_ - *without_runners_ >= kNoRunnerPatience) {
    GiveUp(failed.reason, kExitInternal);
  }
}

// This worker cannot simulate any more: it gives everything back and leaves.
void WorkerState::GiveUp(const std::string& reason, int exit_code) {
  if (drain_ && drain_->exit_code != kExitDone) return;
  for (Slot& slot : slots_) {
    GiveBackRuns(slot, reason);
    slot.state = SlotState::kStarting;
  }
  for (const Lease& lease : std::exchange(waiting_, {})) GiveBack(lease, reason);
  const bool tell = !drain_;
  drain_ = DrainPlan{.reason = reason,
                     .exit_code = exit_code,
                     .drop_at = now_,
                     .leave_at = now_ + settings_.acknowledge_wait};
  if (tell && phase_ == Phase::kWelcomed) Act(Send{Drain{drain_->reason, false}});
}

// --- Connection, signals and time ---

void WorkerState::On(const ConnectionRestored&) {
  connected_ = now_;
  Greet();
}

void WorkerState::On(const StopRequested& stop) {
  if (!drain_) {
    drain_ = DrainPlan{.reason = stop.reason,
                       .drop_at = now_ + settings_.stop_finish,
                       .leave_at = now_ + settings_.stop_leave};
    if (phase_ == Phase::kWelcomed) Act(Send{Drain{stop.reason, true}});
    return;
  }
  // The second signal: what runs is dropped; a drain of the master's becomes one with a deadline.
  const bool hurry = drain_->drop_at && drain_->leave_at;
  const auto earlier = [](const std::optional<TimePoint>& planned, TimePoint wanted) {
    return planned ? std::min(*planned, wanted) : wanted;
  };
  drain_->drop_at = earlier(drain_->drop_at, hurry ? now_ : now_ + settings_.stop_finish);
  drain_->leave_at =
      earlier(drain_->leave_at, now_ + (hurry ? settings_.acknowledge_wait : settings_.stop_leave));
}

void WorkerState::Kill(std::size_t index) {
  slots_[index].state = SlotState::kKilling;
  Act(KillRunner{static_cast<int>(index)});
}

void WorkerState::EndBlockedRuns() {
  if (welcome_.cpu_limit_seconds <= 0.0) return;
  const double limit = kWallPerCpu * welcome_.cpu_limit_seconds;
  for (std::size_t i = 0; i < slots_.size(); ++i) {
    Slot& slot = slots_[i];
    if (slot.state != SlotState::kRunning || Seconds(awake_ - slot.begun) < limit) continue;
    Kill(i);
    const Given run = std::move(slot.runs.front());
    EndRuns(slot);
    if (run.wanted) HandIn(run.lease, {.failure = WaitedTooLong(limit)});
  }
}

void WorkerState::On(const ClockTick&) {
  EndBlockedRuns();
  const Duration silence = now_ - last_heard_;
  if (phase_ == Phase::kGreeting) {
    // Of the time that this process was frozen, the master's silence says nothing.
    if (const Duration unheard = awake_ - heard_awake_; unheard >= settings_.orphan_timeout) {
      return Leave(kExitOrphaned, fmt::format("no word from a master for {:.0f} s", Seconds(unheard)));
    }
    if (now_ - last_hello_ < settings_.hello_interval) return;
    if (silence >= kUneasyHeartbeats * settings_.hello_interval) {
      Act(Note{
          "unanswered",
          fmt::format("no master answers: it has ended, cannot be reached from here, or does not know this "
                      "worker's keys; trying for {:.0f} s in all",
                      Seconds(settings_.orphan_timeout))});
    }
    if (now_ - connected_ >= kHellosPerConnection * settings_.hello_interval) return GreetAgain();
    Act(CheckAccess{});
    return Greet();
  }
  if (silence >= kSilentHeartbeats * welcome_.heartbeat) {
    Act(Note{"silence",
             fmt::format("no word from the master for {:.1f} s: connecting again", Seconds(silence))});
    return GreetAgain();
  }
  if (now_ - last_heartbeat_ < welcome_.heartbeat) return;
  last_heartbeat_ = now_;
  Act(Send{Heartbeat{++sequence_, HeldLeases()}});
  ResendLateResults();
  if (silence < kUneasyHeartbeats * welcome_.heartbeat) return;
  // Once: before a master that is merely frozen they would pile up.
  if (!std::exchange(asked_, true)) SayHello();
  Act(CheckAccess{});
}

void WorkerState::Greet() {
  phase_ = Phase::kGreeting;
  last_hello_ = now_;
  SayHello();
}

void WorkerState::SayHello() {
  Hello hello = settings_.identity;
  hello.held_leases = HeldLeases();
  Act(Send{std::move(hello)});
}

void WorkerState::GreetAgain() {
  connected_ = now_;
  Act(Reconnect{});
  Greet();
}

void WorkerState::ResendLateResults() {
  for (auto& [fence, finished] : finished_) {
    if (now_ - finished.sent < kResendHeartbeats * welcome_.heartbeat) continue;
    finished.sent = now_;
    Act(Send{finished.result});
  }
}

// --- Leases ---

bool WorkerState::Holds(Fence fence) const {
  const auto given = [fence](const Given& run) { return run.wanted && run.lease.fence == fence; };
  return finished_.contains(fence) || std::ranges::find(waiting_, fence, &Lease::fence) != waiting_.end() ||
         std::ranges::any_of(slots_,
                             [&given](const Slot& slot) { return std::ranges::any_of(slot.runs, given); });
}

void WorkerState::Forget(Fence fence) {
  if (finished_.erase(fence) > 0) {
    std::erase(held_back_, fence);
    return;
  }
  std::erase_if(waiting_, [&](const Lease& lease) { return lease.fence == fence; });
  for (std::size_t i = 0; i < slots_.size(); ++i) {
    Slot& slot = slots_[i];
    const auto run =
        std::ranges::find(slot.runs, fence, [](const Given& given) { return given.lease.fence; });
    if (run == slot.runs.end()) continue;
    run->wanted = false;
    if (run != slot.runs.begin()) continue;  // it is short: not worth a runner
    Kill(i);
    EndRuns(slot);
  }
}

void WorkerState::EndRuns(Slot& slot) {
  // From the end, so that the order stays.
  for (; slot.runs.size() > 1; slot.runs.pop_back()) {
    if (slot.runs.back().wanted) waiting_.push_front(std::move(slot.runs.back().lease));
  }
  slot.runs.clear();
}

std::size_t WorkerState::RunsAhead() const {
  if (lately_longest_ < 0.0) return 1;
  const double runs = kWorkAhead / std::max(lately_longest_, 1e-9);
  return runs >= static_cast<double>(kMostAhead) ? kMostAhead
                                                 : std::max<std::size_t>(1, static_cast<std::size_t>(runs));
}

void WorkerState::StartNext(std::size_t index) {
  Slot& slot = slots_[index];
  if (slot.runs.empty()) slot.begun = awake_;
  slot.state = SlotState::kRunning;
  slot.used = true;
  slot.runs.push_back({std::move(waiting_.front())});
  waiting_.pop_front();
  Act(StartRun{static_cast<int>(index),
               {.spec = slot.runs.back().lease.spec,
                .cpu_limit_seconds = welcome_.cpu_limit_seconds,
                .memory_limit_bytes = welcome_.memory_limit_bytes,
                .max_result_bytes = kMaxResultBytes,
                .without_ways = welcome_.without_ways}});
}

void WorkerState::StartWaitingRuns() {
  if (drain_) return;
  for (std::size_t i = 0; i < slots_.size() && !waiting_.empty(); ++i) {
    if (slots_[i].state != SlotState::kIdle) continue;
    // What former runs have left in a runner must not be what fails a run again.
    if (waiting_.front().attempt > 1 && slots_[i].used) {
      Kill(i);
    } else {
      StartNext(i);
    }
  }
  // Refilled when half empty, so that many go at once.
  const std::size_t ahead = RunsAhead();
  for (std::size_t i = 0; i < slots_.size(); ++i) {
    const Slot& slot = slots_[i];
    if (slot.state != SlotState::kRunning || slot.runs.size() > ahead / 2) continue;
    if (slot.runs.front().lease.attempt > 1) continue;
    while (slot.runs.size() < ahead && !waiting_.empty() && waiting_.front().attempt == 1) StartNext(i);
  }
}

Duration WorkerState::Nap() const {
  const std::size_t ahead = RunsAhead();
  if (ahead < kLeastAheadForNap || drain_ || slots_.empty()) return Duration::zero();
  const bool all_busy = std::ranges::all_of(slots_, [&](const Slot& slot) {
    return slot.state == SlotState::kRunning && slot.runs.size() > ahead / 2;
  });
  if (!all_busy) return Duration::zero();
  return std::chrono::duration_cast<Duration>(std::chrono::duration<double>(kWorkAhead / 2));
}

void WorkerState::HandIn(const Lease& lease, LeaseResult result) {
  result.fence = lease.fence;
  result.run_id = lease.run_id;
  const bool hold_back = lease.result_wait.count() > 0 && !result.failure;
  if (hold_back) {
    const TimePoint until = now_ + lease.result_wait;
    send_held_back_at_ = held_back_.empty() ? until : std::min(send_held_back_at_, until);
    held_back_.push_back(lease.fence);
  } else if (phase_ == Phase::kWelcomed) {
    Act(Send{result});
  }
  finished_.insert_or_assign(lease.fence, Finished{std::move(result), now_});
}

void WorkerState::SendHeldBackIfDue() {
  if (held_back_.empty() || phase_ != Phase::kWelcomed) return;
  const bool more_to_come = waiting_.size() > held_back_.size() && !drain_;
  if (!more_to_come || now_ >= send_held_back_at_) SendHeldBack();
}

void WorkerState::SendHeldBack() {
  for (const Fence fence : std::exchange(held_back_, {})) {
    Finished& finished = finished_.at(fence);
    finished.sent = now_;
    Act(Send{finished.result});
  }
}

void WorkerState::GiveBack(const Lease& lease, const std::string& why) {
  HandIn(lease, {.failure = RunnerFailure{.kind = FailureKind::kExternal, .stderr_tail = why}});
}

void WorkerState::GiveBackRuns(Slot& slot, const std::string& why) {
  for (const Given& run : std::exchange(slot.runs, {})) {
    if (run.wanted) GiveBack(run.lease, why);
  }
}

void WorkerState::DropRunning(const std::string& why) {
  for (std::size_t i = 0; i < slots_.size(); ++i) {
    if (slots_[i].state != SlotState::kRunning) continue;
    Kill(i);
    GiveBackRuns(slots_[i], why);
  }
}

std::size_t WorkerState::RunningCount() const {
  return static_cast<std::size_t>(std::ranges::count(slots_, SlotState::kRunning, &Slot::state));
}

// --- Leaving ---

void WorkerState::ContinueDrain() {
  for (const Lease& lease : std::exchange(waiting_, {})) GiveBack(lease, "drained before it began");
  if (drain_->drop_at && now_ >= *drain_->drop_at) DropRunning("drained while it ran");
  const bool runs = RunningCount() > 0;
  if (!runs && !drain_->leave_at) drain_->leave_at = now_ + settings_.acknowledge_wait;
  const bool handed_in = !runs && finished_.empty();
  if (!handed_in && (!drain_->leave_at || now_ < *drain_->leave_at)) return;
  if (phase_ == Phase::kWelcomed) Act(Send{Goodbye{drain_->reason}});
  Leave(drain_->exit_code, drain_->reason);
}

void WorkerState::Leave(int code, const std::string& reason) {
  phase_ = Phase::kExited;
  Act(Exit{code, reason});
}

}  // namespace gauntlet::worker
