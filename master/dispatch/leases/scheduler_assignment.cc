// Which worker gets which lease.
#include <algorithm>

#include "master/dispatch/leases/scheduler.h"

namespace gauntlet {

std::uint32_t Scheduler::Credit() const {
  if (predicted_seconds_ < 0.0) return options_.credit;
  const auto runs_of = [this](std::chrono::milliseconds work) {
    const double runs = std::chrono::duration<double>(work).count() / std::max(predicted_seconds_, 1e-6);
    return static_cast<std::uint32_t>(std::min<double>(options_.most_credit, runs));
  };
  std::uint32_t credit = std::max(options_.credit, runs_of(options_.work_ahead));
  if (ManyWait()) {
    const auto waiting =
        static_cast<std::uint32_t>(std::min<std::uint64_t>(queue_.size() / slots_, options_.most_credit));
    credit = std::max(credit, std::min(waiting, runs_of(options_.most_work_ahead)));
  }
  return credit;
}

bool Scheduler::ManyWait() const {
  return slots_ > 0 && queue_.size() >= options_.many_waiting * slots_;
}

void Scheduler::Grant(InstanceId worker_id, RunId id) {
  Worker& worker = workers_.at(worker_id);
  Run& run = runs_.at(id);
  const Fence fence = next_fence_++;
  const bool result_may_wait = ManyWait();
  leases_.emplace(fence, Lease{id, worker_id, LeaseState::kLive, listening_, listening_, result_may_wait});
  run.fences.push_back(fence);
  ++run.live;
  ++run.leases;
  worker.live.push_back(fence);
  worker.slowed_until = listening_ + Duration(options_.heartbeat);
  List(worker_id, worker);
  const auto result_wait = result_may_wait ? options_.result_wait : std::chrono::milliseconds(0);
  orders_.leases.push_back({worker_id, {fence, id, run.spec, run.leases, result_wait}});
}

// A run that failed goes to who has not failed it, even if that one is busy now; to another host first.
std::optional<InstanceId> Scheduler::NextFor(const Run& run) const {
  const Tally tally = TallyOf(run);
  const Others others = OthersFor(run, tally);
  const bool enough = tally.failures >= options_.attempts;
  if (enough && others.all == 0) return std::nullopt;  // it waits to be judged
  std::optional<InstanceId> best;
  std::pair<bool, std::ptrdiff_t> best_rank;
  for (const auto& [level, id] : available_) {
    const Worker& worker = workers_.at(id);
    const bool trusted = worker.record.trusted();
    if (others.all > 0) {
      if (FailedOn(run, id) || (others.elsewhere && worker.host == *tally.only_host)) continue;
      // Whom nobody trusts yet can say little, and may earn trust meanwhile. Where nobody has finished
      // anything, those who have failed something have said enough.
      const bool said_enough =
          !somebody_finished_ && worker.record.tried() && tally.workers >= options_.attempts;
      if (enough && !trusted && (!queue_.empty() || said_enough)) continue;
    }
    // Trusted ones first, then those that have tried it least often.
    const std::pair rank{trusted, -std::ranges::count(run.attempts, id, &Attempt::worker)};
    if (best && rank <= best_rank) continue;
    best = id;
    best_rank = rank;
  }
  return best;
}

void Scheduler::AssignFailing() {
  for (const Place& place : failing_) {
    if (available_.empty()) return;
    const Run& run = runs_.at(place.run);
    if (run.live > 0) continue;
    if (const std::optional<InstanceId> next = NextFor(run)) Grant(*next, place.run);
  }
}

// An idle worker for a second lease: one that is known to bring results, if there is one, and rather none
// that has failed the run.
std::optional<InstanceId> Scheduler::HelperFor(const Run& run, InstanceId owner) const {
  std::optional<InstanceId> best;
  std::pair<bool, bool> best_rank;
  for (const auto& [level, id] : available_) {
    const Worker& worker = workers_.at(id);
    if (id == owner || worker.live.size() >= worker.slots) continue;
    const bool failed = FailedOn(run, id);
    if (failed && TallyOf(run).failures >= options_.attempts) continue;
    const std::pair rank{!failed, worker.record.trusted()};
    if (best && rank <= best_rank) continue;
    best = id;
    best_rank = rank;
  }
  return best;
}

void Scheduler::Assign() {
  if (!leasing_) return;
  AssignFailing();
  while (!queue_.empty() && !available_.empty()) {
    const RunId id = queue_.begin()->run;
    queue_.erase(queue_.begin());
    Grant(available_.begin()->second, id);
  }
}

std::size_t Scheduler::FirstWaiting(const Worker& worker) const {
  if (worker.live.size() <= worker.slots) return worker.live.size();
  // The first ones may have ended: a worker holds back fewer results than leases wait there.
  const std::size_t behind = worker.live.size() - worker.slots;
  const auto may_wait = static_cast<std::size_t>(
      std::ranges::count_if(worker.live, [this](Fence fence) { return leases_.at(fence).result_may_wait; }));
  return worker.slots + std::min(may_wait, (behind - 1) / 2);
}

void Scheduler::MoveWaiting() {
  // A shorter one has begun before the message arrives.
  constexpr double kWorthMoving = 0.002;  // s
  if (!leasing_ || !queue_.empty() || predicted_seconds_ < kWorthMoving) return;
  while (!available_.empty() && available_.begin()->first == 0) {
    std::optional<Place> first;
    Fence moved = 0;
    for (const auto& [id, worker] : workers_) {
      for (std::size_t i = FirstWaiting(worker); i < worker.live.size(); ++i) {
        const RunId run_id = leases_.at(worker.live[i]).run;
        const Run& run = runs_.at(run_id);
        if (run.finished || run.live != 1 || !run.attempts.empty() ||
            (first && !(PlaceOf(run_id, run) < *first)))
          continue;
        first = PlaceOf(run_id, run);
        moved = worker.live[i];
      }
    }
    if (!first) return;
    Lease& lease = leases_.at(moved);
    const std::optional<InstanceId> idle = HelperFor(runs_.at(first->run), lease.worker);
    if (!idle) return;
    orders_.cancels.push_back({lease.worker, moved});
    Loosen(moved, lease, LeaseState::kCancelled);
    Grant(*idle, first->run);
  }
}

bool Scheduler::Alone(InstanceId worker) const {
  return std::none_of(workers_.begin(), workers_.end(), [worker](const auto& other) {
    return other.first != worker && Standing(other.second);
  });
}

void Scheduler::AssignAudits() {
  if (!leasing_ || !queue_.empty() || available_.empty()) return;
  for (auto next = audits_.begin(); next != audits_.end() && !available_.empty();) {
    const RunId id = *next;
    const InstanceId first = runs_.at(id).finished_by;
    const auto other = std::find_if(available_.begin(), available_.end(),
                                    [&](const auto& place) { return place.second != first || Alone(first); });
    if (other == available_.end()) return;
    next = audits_.erase(next);
    Grant(other->second, id);
  }
}

void Scheduler::AssignCopies() {
  if (!leasing_ || !queue_.empty() || predicted_seconds_ < 0.0 || !(options_.copy_after > 0.0)) return;
  // Short runs end before anybody could help.
  const double late =
      std::max(options_.copy_after * predicted_seconds_,
               std::chrono::duration<double>(options_.heartbeat).count() / kChecksPerHeartbeat);
  struct Slow {
    Duration begun;
    RunId run;
    InstanceId owner;
  };
  std::vector<Slow> slow;
  for (const auto& [id, worker] : workers_) {
    for (const Fence fence : worker.live) {
      const Lease& lease = leases_.at(fence);
      const Run& run = runs_.at(lease.run);
      const double seconds = std::chrono::duration<double>(listening_ - lease.begun).count();
      if (!run.finished && run.live == 1 && seconds > late) slow.push_back({lease.begun, lease.run, id});
    }
  }
  // What has taken longest gets help first.
  std::sort(slow.begin(), slow.end(), [](const Slow& a, const Slow& b) {
    return a.begun != b.begun ? a.begun < b.begun : a.run < b.run;
  });
  for (const Slow& one : slow) {
    if (available_.empty()) return;
    const std::optional<InstanceId> idle = HelperFor(runs_.at(one.run), one.owner);
    if (!idle) continue;
    ++statistics_.copies;
    Grant(*idle, one.run);
  }
}

}  // namespace gauntlet
