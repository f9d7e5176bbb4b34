// How leases end without an answer: their worker is silent, dead or gone, or does not hold them (any more).
#include <algorithm>

#include "master/dispatch/leases/scheduler.h"

namespace gauntlet {
namespace {

constexpr int kMostExcuses = 10;
// A lease that was sent and is not in a heartbeat of its worker was lost on the way, unless the two crossed.
// A worker that gets no turn reads it seconds later. Waiting costs little: messages are lost with their
// connection, and then the worker says hello.
constexpr int kCrossingHeartbeats = 10;

void Erase(std::vector<Fence>& fences, Fence fence) {
  const auto found = std::find(fences.begin(), fences.end(), fence);
  if (found == fences.end()) return;
  *found = fences.back();
  fences.pop_back();
}

}  // namespace

void Scheduler::WorkerJoined(InstanceId id, std::uint32_t slots, const std::vector<Fence>& held,
                             TimePoint now, const std::string& host) {
  Advance(now);
  trust_.Meet(id, host);
  Worker& worker = workers_[id];
  worker.slots = std::max<std::uint32_t>(1, slots);
  worker.pace = options_.heartbeat;
  worker.draining = false;
  worker.lost = false;
  Heard(id, worker);
  Reconcile(id, worker, held, Duration::zero());
}

void Scheduler::WorkerPaced(InstanceId id, Duration heartbeat) {
  if (const auto found = workers_.find(id); found != workers_.end()) found->second.pace = heartbeat;
}

bool Scheduler::WorkerHeard(InstanceId id, TimePoint now) {
  Advance(now);
  const auto found = workers_.find(id);
  if (found == workers_.end()) return false;
  Heard(id, found->second);
  return true;
}

bool Scheduler::WorkerHeartbeat(InstanceId id, const std::vector<Fence>& held, TimePoint now) {
  Advance(now);
  const auto found = workers_.find(id);
  if (found == workers_.end()) return false;
  if (std::exchange(found->second.lost, false)) orders_.back.push_back(id);
  Heard(id, found->second);
  Reconcile(id, found->second, held, kCrossingHeartbeats * found->second.pace);
  return true;
}

bool Scheduler::WorkerDraining(InstanceId id) {
  const auto found = workers_.find(id);
  if (found == workers_.end()) return false;
  found->second.draining = true;
  List(id, found->second);
  ForgiveEndsFromOutside(id);
  return true;
}

bool Scheduler::WorkerLeft(InstanceId id) {
  const auto found = workers_.find(id);
  if (found == workers_.end()) return false;
  Worker& worker = found->second;
  worker.lost = true;  // gets nothing of what it gives back
  List(id, worker);
  ForgiveEndsFromOutside(id);
  ReleaseAll(id, worker, LeaseState::kOrphaned);
  while (!worker.loose.empty()) ForgetIfDone(EndLease(worker.loose.back()));
  workers_.erase(found);
  trust_.Forget(id);
  return true;
}

bool Scheduler::WorkerDied(InstanceId id) {
  const auto found = workers_.find(id);
  if (found == workers_.end()) return false;
  if (!found->second.lost) Lose(id, found->second);
  return true;
}

void Scheduler::Heard(InstanceId id, Worker& worker) {
  worker.heard = listening_;
  worker.blocked = false;
  List(id, worker);
}

void Scheduler::Reconcile(InstanceId id, Worker& worker, const std::vector<Fence>& held, Duration grace) {
  std::vector<Fence> sorted(held);
  std::sort(sorted.begin(), sorted.end());
  const auto holds = [&sorted](Fence fence) {
    return std::binary_search(sorted.begin(), sorted.end(), fence);
  };

  for (const Fence fence : std::vector<Fence>(worker.live)) {
    if (holds(fence) || listening_ - leases_.at(fence).granted < grace) continue;
    const RunId run = EndLease(fence);
    if (Requeue(run, runs_.at(run))) ++statistics_.releases;
  }
  for (const Fence fence : std::vector<Fence>(worker.loose)) {
    Lease& lease = leases_.at(fence);
    const RunId run_id = lease.run;
    Run& run = runs_.at(run_id);
    if (!holds(fence)) {
      ForgetIfDone(EndLease(fence));
    } else if (lease.state == LeaseState::kOrphaned && !run.finished && !trust_.RecordOf(id).quarantined) {
      // Back in time. Should somebody else have the run by now, the first answer counts and ends the other's
      // lease: this worker has done more of it.
      lease.state = LeaseState::kLive;
      Erase(worker.loose, fence);
      worker.live.push_back(fence);
      ++run.live;
      queue_.erase(PlaceOf(run_id, run));
    } else {
      lease.state = LeaseState::kCancelled;
      orders_.cancels.push_back({id, fence});
    }
  }
  // What the worker still holds although it was told to forget it: the message was lost. Leases of earlier
  // masters may still bring a result.
  for (const Fence fence : sorted) {
    if (fence >= first_fence_ && !leases_.contains(fence)) orders_.acknowledgements.push_back({id, fence});
  }
  List(id, worker);
}

bool Scheduler::IsSilent(const Worker& worker) const {
  const Duration limit =
      options_.lost_after * worker.pace - Duration(options_.heartbeat) / kChecksPerHeartbeat;
  return !worker.lost && listening_ - std::max(worker.heard, worker.excused) >= limit;
}

std::vector<InstanceId> Scheduler::Silent(TimePoint now) {
  Advance(now);
  std::vector<InstanceId> silent;
  if (listening_ < next_check_) return silent;
  for (const auto& [id, worker] : workers_) {
    if (IsSilent(worker)) silent.push_back(id);
  }
  return silent;
}

void Scheduler::Excuse(InstanceId id) {
  Worker& worker = workers_.at(id);
  if (listening_ - worker.heard < kMostExcuses * options_.lost_after * worker.pace) {
    worker.excused = listening_;
  }
}

void Scheduler::Lose(InstanceId id, Worker& worker) {
  worker.lost = true;
  ForgiveEndsFromOutside(id);
  ++statistics_.lost;
  List(id, worker);
  orders_.lost.push_back({id, ReleaseAll(id, worker, LeaseState::kOrphaned)});
}

std::vector<RunId> Scheduler::ReleaseAll(InstanceId id, Worker& worker, LeaseState state) {
  std::vector<RunId> released;
  for (const Fence fence : std::vector<Fence>(worker.live)) {
    Lease& lease = leases_.at(fence);
    if (state == LeaseState::kCancelled) orders_.cancels.push_back({id, fence});
    Loosen(fence, lease, state);
    if (Requeue(lease.run, runs_.at(lease.run))) released.push_back(lease.run);
  }
  statistics_.releases += released.size();
  return released;
}

void Scheduler::Undelivered(Fence fence) {
  const auto found = leases_.find(fence);
  if (found == leases_.end() || found->second.state != LeaseState::kLive) return;
  const Lease lease = found->second;
  workers_.at(lease.worker).blocked = true;
  EndLease(fence);
  Run& run = runs_.at(lease.run);
  --run.leases;
  Requeue(lease.run, run);
}

void Scheduler::EraseLive(Worker& worker, Fence fence) {
  const auto found = std::find(worker.live.begin(), worker.live.end(), fence);
  const bool had_begun = found - worker.live.begin() < std::ptrdiff_t{worker.slots};
  if (found != worker.live.end()) worker.live.erase(found);
  if (had_begun && worker.live.size() >= worker.slots)
    leases_.at(worker.live[worker.slots - 1]).begun = listening_;
}

void Scheduler::Loosen(Fence fence, Lease& lease, LeaseState state) {
  Worker& worker = workers_.at(lease.worker);
  lease.state = state;
  EraseLive(worker, fence);
  worker.loose.push_back(fence);
  --runs_.at(lease.run).live;
  List(lease.worker, worker);
}

RunId Scheduler::EndLease(Fence fence) {
  const auto found = leases_.find(fence);
  const Lease lease = found->second;
  leases_.erase(found);
  Run& run = runs_.at(lease.run);
  Erase(run.fences, fence);
  Worker& worker = workers_.at(lease.worker);
  if (lease.state == LeaseState::kLive) {
    --run.live;
    EraseLive(worker, fence);
  } else {
    Erase(worker.loose, fence);
  }
  List(lease.worker, worker);
  return lease.run;
}

bool Scheduler::Requeue(RunId id, Run& run) {
  if (run.live > 0) return false;
  if (run.finished) {
    if (run.audit) audits_.insert(id);
    return false;
  }
  if (!trust_.InDoubt(id)) queue_.insert(PlaceOf(id, run));
  return true;
}

void Scheduler::Purge() {
  for (auto it = workers_.begin(); it != workers_.end();) {
    const InstanceId id = it->first;
    const bool forget = it->second.lost && listening_ - it->second.heard > options_.forget_after;
    ++it;
    if (!forget) continue;
    orders_.forgotten.push_back(id);
    WorkerLeft(id);
  }
  while (!loose_ends_.empty() && listening_ - loose_ends_.front().first > options_.forget_after) {
    const RunId id = loose_ends_.front().second;
    loose_ends_.pop_front();
    const auto found = runs_.find(id);
    if (found == runs_.end()) continue;
    if (found->second.audit) {
      loose_ends_.emplace_back(listening_, id);
      continue;
    }
    for (const Fence fence : std::vector<Fence>(found->second.fences)) EndLease(fence);
    ForgetIfDone(id);
  }
}

}  // namespace gauntlet
