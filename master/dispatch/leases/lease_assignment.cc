// Who can take a lease, and which worker gets which.
#include <algorithm>

#include "master/dispatch/leases/scheduler.h"

namespace gauntlet {

void Scheduler::List(InstanceId id, Worker& worker) {
  ListAlone(id, worker);
  if (!options_.LimitsHosts()) return;
  const std::string& host = trust_.HostOf(id);
  for (auto& [other, beside] : workers_) {
    if (other != id && trust_.HostOf(other) == host) ListAlone(other, beside);
  }
}

bool Scheduler::IsFull(const std::string& host) const {
  if (!options_.LimitsHosts()) return false;
  std::size_t leases = 0;
  std::size_t slots = 0;
  for (const auto& [id, worker] : workers_) {
    if (trust_.HostOf(id) != host) continue;
    leases += worker.live.size();
    slots += worker.slots;
  }
  const std::size_t side_by_side =
      std::max<std::size_t>(1, slots / static_cast<std::size_t>(options_.cores_per_run));
  const auto most = static_cast<std::size_t>(options_.most_per_host);
  return leases >= (most == 0 ? side_by_side : std::min(most, side_by_side));
}

void Scheduler::ListAlone(InstanceId id, Worker& worker) {
  const std::uint32_t slots = Standing(id, worker) ? worker.slots : 0;
  const auto busy = static_cast<std::uint32_t>(std::min<std::size_t>(slots, worker.live.size()));
  slots_ = slots_ - std::exchange(worker.counted_slots, slots) + slots;
  busy_ = busy_ - std::exchange(worker.counted_busy, busy) + busy;
  if (std::exchange(worker.listed, false)) available_.erase({worker.level, id});
  if (slots == 0 || worker.blocked || Slowed(id, worker) || IsFull(trust_.HostOf(id))) return;
  // Work is only given ahead to who has done some.
  // What waits at a worker cannot be moved to another one where it might then have two endings.
  const bool one_by_one = trust_.reproducibility().first_ending_counts();
  const std::uint32_t least_credit = one_by_one ? 1 : options_.credit;
  const std::uint32_t credit = trust_.RecordOf(id).finished > 0 && !one_by_one ? Credit() : least_credit;
  const std::size_t least = std::size_t{worker.slots} * least_credit;
  const std::size_t most = std::max(least, std::min(std::size_t{worker.slots} * credit, kMostAtAWorker));
  // Many short runs are leased at once, when half of them are done: then a message costs a fraction.
  worker.filled = worker.live.size() >= most ||
                  (worker.filled && credit > options_.credit && worker.live.size() > most / 2);
  if (worker.filled) return;
  worker.level = static_cast<std::uint32_t>(worker.live.size() / worker.slots);
  worker.listed = true;
  available_.emplace(worker.level, id);
}

// A worker on which one run after the other fails is free again at once, and would draw most of the work. It
// is given one run per heartbeat as long as others do better, or may.
bool Scheduler::Slowed(InstanceId id, const Worker& worker) const {
  if (!trust_.RecordOf(id).black_hole()) return false;
  if (worker.live.empty() && listening_ >= worker.slowed_until) return false;
  return trust_.PatienceLasts(listening_) || std::ranges::any_of(workers_, [&](const auto& other) {
           return other.first != id && Standing(other.first, other.second) &&
                  !trust_.RecordOf(other.first).black_hole();
         });
}

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

void Scheduler::Assign() {
  if (!leasing_) return;
  AssignFailing();
  while (!queue_.empty() && !available_.empty()) {
    const RunId id = queue_.begin()->run;
    queue_.erase(queue_.begin());
    Grant(available_.begin()->second, id);
  }
}

void Scheduler::AssignFailing() {
  for (const Place& place : failing_) {
    if (available_.empty()) return;
    const Run& run = runs_.at(place.run);
    if (run.live > 0 || trust_.Waits(place.run, listening_)) continue;
    std::vector<InstanceId> free;
    for (const auto& [level, id] : available_) free.push_back(id);
    const auto next = trust_.NextFor(place.run, free, AbleTo(run), !queue_.empty());
    if (next) Grant(*next, place.run);
  }
}

std::vector<InstanceId> Scheduler::AbleTo(const Run& run) const {
  const Duration longest = std::chrono::duration_cast<Duration>(
      std::chrono::duration<double>(std::max(options_.cpu_limit_seconds, 1.0)));
  const auto keeps_it_too_long = [&](InstanceId id) {
    return std::ranges::any_of(run.fences, [&](Fence fence) {
      const Lease& lease = leases_.at(fence);
      return lease.worker == id && lease.state == LeaseState::kLive && listening_ - lease.granted > longest;
    });
  };
  std::vector<InstanceId> able;
  for (const auto& [id, worker] : workers_) {
    if (Standing(id, worker) && !keeps_it_too_long(id)) able.push_back(id);
  }
  return able;
}

// An idle worker, without the run, for another lease of it.
std::optional<InstanceId> Scheduler::HelperFor(RunId id) const {
  const std::vector<Fence>& fences = runs_.at(id).fences;
  const auto has_it = [&](InstanceId worker) {
    return std::ranges::any_of(fences, [&](Fence fence) { return leases_.at(fence).worker == worker; });
  };
  std::vector<InstanceId> idle;
  for (const auto& [level, candidate] : available_) {
    const Worker& worker = workers_.at(candidate);
    if (worker.live.size() < worker.slots && !has_it(candidate)) idle.push_back(candidate);
  }
  return trust_.HelperFor(id, idle);
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
  if (trust_.reproducibility().first_ending_counts()) return;
  while (!available_.empty() && available_.begin()->first == 0) {
    std::optional<Place> first;
    Fence moved = 0;
    for (const auto& [id, worker] : workers_) {
      for (std::size_t i = FirstWaiting(worker); i < worker.live.size(); ++i) {
        const RunId run_id = leases_.at(worker.live[i]).run;
        const Run& run = runs_.at(run_id);
        if (run.finished || run.live != 1 || trust_.InDoubt(run_id) ||
            (first && !(PlaceOf(run_id, run) < *first)))
          continue;
        first = PlaceOf(run_id, run);
        moved = worker.live[i];
      }
    }
    if (!first) return;
    Lease& lease = leases_.at(moved);
    const std::optional<InstanceId> idle = HelperFor(first->run);
    if (!idle) return;
    orders_.cancels.push_back({lease.worker, moved});
    Loosen(moved, lease, LeaseState::kCancelled);
    Grant(*idle, first->run);
  }
}

bool Scheduler::Alone(InstanceId worker) const {
  return std::none_of(workers_.begin(), workers_.end(), [&](const auto& other) {
    return other.first != worker && Standing(other.first, other.second);
  });
}

void Scheduler::AssignAudits() {
  if (!leasing_ || !queue_.empty() || available_.empty()) return;
  for (auto next = audits_.begin(); next != audits_.end() && !available_.empty();) {
    const RunId id = *next;
    if (listening_ < runs_.at(id).audit_from || trust_.reproducibility().Checks(id)) {
      ++next;
      continue;
    }
    const InstanceId first = runs_.at(id).finished_by;
    const auto other = std::find_if(available_.begin(), available_.end(),
                                    [&](const auto& place) { return place.second != first || Alone(first); });
    if (other == available_.end()) return;
    next = audits_.erase(next);
    Grant(other->second, id);
  }
}

// Before runs that wait: until this is known, nobody helps anybody.
void Scheduler::AssignChecks() {
  if (!leasing_) return;
  for (const auto& open : trust_.reproducibility().open()) {
    const RunId id = open.first;
    const Run& run = runs_.at(id);
    const auto waiting = audits_.find(id);
    if (waiting == audits_.end() || listening_ < run.audit_from) continue;
    // On another host, if there is one, else by another worker. If those are busy they are waited for.
    const auto rank = [&](InstanceId worker) {
      return trust_.HostOf(worker) != open.second ? 2 : worker != run.finished_by ? 1 : 0;
    };
    int best = 0;
    for (const InstanceId worker : AbleTo(run)) best = std::max(best, rank(worker));
    const auto free =
        std::ranges::find_if(available_, [&](const auto& place) { return rank(place.second) == best; });
    if (free == available_.end()) continue;
    audits_.erase(waiting);
    Grant(free->second, id);
  }
}

bool Scheduler::TakesLong(const Lease& lease) const {
  if (predicted_seconds_ < 0.0 || !(options_.copy_after > 0.0)) return false;
  const double late =
      std::max(options_.copy_after * predicted_seconds_,
               std::chrono::duration<double>(options_.heartbeat).count() / kChecksPerHeartbeat);
  return std::chrono::duration<double>(listening_ - lease.begun).count() > late;
}

bool Scheduler::HasBegun(Fence fence, const Lease& lease) const {
  const Worker& worker = workers_.at(lease.worker);
  return std::ranges::find(worker.live, fence) - worker.live.begin() < std::ptrdiff_t{worker.slots};
}

void Scheduler::AssignCopies() {
  if (!leasing_ || !queue_.empty() || trust_.reproducibility().first_ending_counts()) return;
  struct Slow {
    Duration begun;
    RunId run;
  };
  const auto live = [this](Fence fence) { return leases_.at(fence).state == LeaseState::kLive; };
  const auto long_or_not_live = [&](Fence fence) { return !live(fence) || TakesLong(leases_.at(fence)); };
  std::vector<Slow> slow;
  for (const auto& [id, worker] : workers_) {
    for (const Fence fence : worker.live) {
      const Lease& lease = leases_.at(fence);
      const Run& run = runs_.at(lease.run);
      // All who have it may be slow, or keep it for nothing: each of them is waited for as long.
      const bool first = fence == *std::ranges::find_if(run.fences, live);
      if (first && !run.finished && std::ranges::all_of(run.fences, long_or_not_live))
        slow.push_back({lease.begun, lease.run});
    }
  }
  // What has taken longest gets help first.
  std::sort(slow.begin(), slow.end(), [](const Slow& a, const Slow& b) {
    return a.begun != b.begun ? a.begun < b.begun : a.run < b.run;
  });
  for (const Slow& one : slow) {
    if (available_.empty()) return;
    const std::optional<InstanceId> idle = HelperFor(one.run);
    if (!idle) continue;
    ++statistics_.copies;
    Grant(*idle, one.run);
  }
}

}  // namespace gauntlet
