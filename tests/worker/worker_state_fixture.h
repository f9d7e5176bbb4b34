// A WorkerState whose clock is moved by hand, and what its actions are sorted into.
#pragma once

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "worker/worker_state.h"

namespace gauntlet::worker {

template <typename T>
std::vector<T> Only(const std::vector<WorkerAction>& actions) {
  std::vector<T> found;
  for (const WorkerAction& action : actions) {
    if (const auto* one = std::get_if<T>(&action)) found.push_back(*one);
  }
  return found;
}

template <typename Message>
std::vector<Message> Sent(const std::vector<WorkerAction>& actions) {
  std::vector<Message> found;
  for (const Send& send : Only<Send>(actions)) {
    if (const auto* message = std::get_if<Message>(&send.message)) found.push_back(*message);
  }
  return found;
}

// A state with a clock that is moved by hand.
class Worker {
 public:
  explicit Worker(std::uint32_t slots = 1, Duration orphan_timeout = std::chrono::seconds(600))
      : state_(Settings(slots, orphan_timeout), now_) {
    actions_ = state_.Start();
  }

  std::vector<WorkerAction> Do(WorkerEvent event) { return actions_ = state_.Handle(std::move(event), now_); }
  std::vector<WorkerAction> Hear(MasterMessage message) { return Do(WorkerEvent(std::move(message))); }
  // Time passes with a tick whenever the state wants one; all actions of that time.
  std::vector<WorkerAction> Pass(Duration time) {
    std::vector<WorkerAction> all;
    const TimePoint end = now_ + time;
    while (now_ < end) {
      now_ = std::min(end, std::max(state_.NextTick(), now_ + std::chrono::milliseconds(1)));
      for (WorkerAction& action : Do(ClockTick{})) all.push_back(std::move(action));
    }
    return all;
  }
  // Nothing is heard of time while it passes, as when the process is frozen.
  std::vector<WorkerAction> Jump(Duration time) {
    now_ += time;
    return Do(ClockTick{});
  }
  void Welcome(std::uint64_t epoch = 1) {
    Hear(worker::Welcome{.heartbeat = std::chrono::milliseconds(1000),
                         .epoch = epoch,
                         .cpu_limit_seconds = 60.0,
                         .memory_limit_bytes = 1 << 30,
                         .without_ways = true});
  }
  void Ready() {
    for (int slot = 0; slot < static_cast<int>(slots_); ++slot) Do(SlotBecameReady{slot});
  }
  std::vector<WorkerAction> Lease(Fence fence, std::uint32_t attempt = 1,
                                  std::chrono::milliseconds result_wait = {}) {
    return Hear(worker::Lease{.fence = fence,
                              .run_id = fence + 1000,
                              .spec = "spec" + std::to_string(fence),
                              .attempt = attempt,
                              .result_wait = result_wait});
  }
  std::vector<WorkerAction> Finish(int slot, std::string result = "result", double cpu_seconds = 0.5) {
    return Do(RunFinished{slot, std::move(result), cpu_seconds});
  }
  WorkerState& state() { return state_; }
  const std::vector<WorkerAction>& last() const { return actions_; }

 private:
  WorkerSettings Settings(std::uint32_t slots, Duration orphan_timeout) {
    slots_ = slots;
    WorkerSettings settings;
    settings.identity.campaign_id = "c0ffee";
    settings.identity.instance_id = 7;
    settings.identity.slots = slots;
    settings.orphan_timeout = orphan_timeout;
    return settings;
  }

  std::uint32_t slots_ = 1;
  TimePoint now_{std::chrono::seconds(1000)};
  WorkerState state_;
  std::vector<WorkerAction> actions_;
};

inline Worker WelcomedWorker(std::uint32_t slots = 1) {
  Worker worker(slots);
  worker.Welcome();
  worker.Ready();
  return worker;
}

}  // namespace gauntlet::worker
