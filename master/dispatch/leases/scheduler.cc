#include "master/dispatch/leases/scheduler.h"

#include <algorithm>
#include <string>

#include "base/check.h"
#include "base/hash.h"

namespace gauntlet {
namespace {

constexpr int kMostExcuses = 10;
// A lease that was sent and is not in a heartbeat of its worker was lost on the way, unless the two crossed.
// A worker that gets no turn reads it seconds later. Waiting costs little: messages are lost with their
// connection, and then the worker says hello.
constexpr int kCrossingHeartbeats = 10;
constexpr double kPredictionGain = 0.05;  // weight of the newest run in the predicted length

// The same runs in every session and for any number of workers.
bool Audited(RunId run, double share) {
  if (!(share > 0.0)) return false;
  Fnv1a64 hash;
  hash.AddUint64(run);
  return static_cast<double>(hash.value() >> 11) * 0x1p-53 < share;
}

void Erase(std::vector<Fence>& fences, Fence fence) {
  const auto found = std::find(fences.begin(), fences.end(), fence);
  if (found == fences.end()) return;
  *found = fences.back();
  fences.pop_back();
}

}  // namespace

Scheduler::Scheduler(const DispatchOptions& options, Fence first_fence)
    : options_(options), first_fence_(first_fence), next_fence_(first_fence) {
  GAUNTLET_CHECK(options.attempts >= 1 && options.credit >= 1 && options.lost_after >= 1 &&
                     options.heartbeat.count() > 0,
                 "dispatch options out of range");
}

void Scheduler::Advance(TimePoint now) {
  if (!started_) {
    started_ = true;
    last_now_ = now;
    return;
  }
  if (now > last_now_) {
    const Duration passed = std::min<Duration>(now - last_now_, options_.heartbeat);
    listening_ += passed;
    last_now_ = now;
    if (leasing_ && next_fence_ > first_fence_) {
      const double seconds = std::chrono::duration<double>(passed).count();
      const double idle = seconds * static_cast<double>(slots_ - busy_);
      statistics_.slot_seconds += seconds * static_cast<double>(slots_);
      statistics_.idle_seconds += idle;
      if (queue_.empty()) statistics_.barrier_seconds += idle;
    }
  }
}

void Scheduler::RunTook(double seconds) {
  if (!(seconds >= 0.0) || !std::isfinite(seconds)) return;
  predicted_seconds_ = predicted_seconds_ < 0.0
                           ? seconds
                           : predicted_seconds_ + kPredictionGain * (seconds - predicted_seconds_);
}

void Scheduler::Submit(RunRequest request) {
  const auto [run, added] = runs_.try_emplace(request.id);
  GAUNTLET_CHECK(added, "run " + std::to_string(request.id) + " submitted twice");
  run->second.spec = std::move(request.spec);
  run->second.batch = batch_;
  run->second.length = request.length;
  queue_.insert({batch_, request.length, request.id});
  ++unfinished_;
}

void Scheduler::Acknowledge(RunId id) {
  const auto found = runs_.find(id);
  if (found == runs_.end() || found->second.acknowledged) return;
  Run& run = found->second;
  GAUNTLET_CHECK(run.finished, "run " + std::to_string(id) + " acknowledged before it finished");
  run.acknowledged = true;
  if (!run.given_up) {
    orders_.acknowledgements.push_back({run.finished_by, run.accepted});
    leases_.erase(run.accepted);
  }
  if (!run.fences.empty()) loose_ends_.emplace_back(listening_, id);
  ForgetIfDone(id);
}

void Scheduler::WorkerJoined(InstanceId id, std::uint32_t slots, const std::vector<Fence>& held,
                             TimePoint now, const std::string& host) {
  Advance(now);
  Worker& worker = workers_[id];
  Unlist(id, worker);
  worker.slots = std::max<std::uint32_t>(1, slots);
  worker.host = host;
  worker.draining = false;
  worker.lost = false;
  Heard(id, worker);
  Reconcile(id, worker, held, Duration::zero());
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
  Reconcile(id, found->second, held, kCrossingHeartbeats * options_.heartbeat);
  return true;
}

bool Scheduler::WorkerDraining(InstanceId id) {
  const auto found = workers_.find(id);
  if (found == workers_.end()) return false;
  found->second.draining = true;
  List(id, found->second);
  return true;
}

bool Scheduler::WorkerLeft(InstanceId id) {
  const auto found = workers_.find(id);
  if (found == workers_.end()) return false;
  Worker& worker = found->second;
  worker.lost = true;  // gets nothing of what it gives back
  Unlist(id, worker);
  ReleaseAll(worker);
  Count(worker);
  while (!worker.loose.empty()) {
    const Fence fence = worker.loose.back();
    const RunId run = leases_.at(fence).run;
    EndLease(fence);
    ForgetIfDone(run);
  }
  workers_.erase(found);
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
    Lease& lease = leases_.at(fence);
    if (holds(fence) || listening_ - lease.granted < grace) continue;
    const RunId run = lease.run;
    EndLease(fence);
    if (Requeue(run, runs_.at(run))) ++statistics_.releases;
  }
  for (const Fence fence : std::vector<Fence>(worker.loose)) {
    Lease& lease = leases_.at(fence);
    const RunId run_id = lease.run;
    Run& run = runs_.at(run_id);
    if (!holds(fence)) {
      EndLease(fence);
      ForgetIfDone(run_id);
    } else if (lease.state == LeaseState::kOrphaned && !run.finished && !worker.record.quarantined) {
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

void Scheduler::Count(Worker& worker) {
  const std::uint32_t slots = Standing(worker) ? worker.slots : 0;
  const auto busy = static_cast<std::uint32_t>(std::min<std::size_t>(slots, worker.live.size()));
  slots_ = slots_ - std::exchange(worker.counted_slots, slots) + slots;
  busy_ = busy_ - std::exchange(worker.counted_busy, busy) + busy;
}

void Scheduler::List(InstanceId id, Worker& worker) {
  Count(worker);
  Unlist(id, worker);
  if (!Standing(worker) || worker.blocked || Slowed(id, worker)) return;
  // Work is only given ahead to who has done some.
  const std::uint32_t credit = worker.record.finished > 0 ? Credit() : options_.credit;
  const std::size_t least = std::size_t{worker.slots} * options_.credit;
  const std::size_t most = std::max(least, std::min(std::size_t{worker.slots} * credit, kMostAtAWorker));
  // Many short runs are leased at once, when half of them are done: then a message costs a fraction.
  worker.filled = worker.live.size() >= most ||
                  (worker.filled && credit > options_.credit && worker.live.size() > most / 2);
  if (worker.filled) return;
  worker.level = static_cast<std::uint32_t>(worker.live.size() / worker.slots);
  worker.listed = true;
  available_.emplace(worker.level, id);
}

void Scheduler::Unlist(InstanceId id, Worker& worker) {
  if (worker.listed) available_.erase({worker.level, id});
  worker.listed = false;
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

void Scheduler::EndLease(Fence fence) {
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
}

bool Scheduler::Requeue(RunId id, Run& run) {
  if (run.live > 0) return false;
  if (run.finished) {
    if (run.audit) audits_.insert(id);
    return false;
  }
  if (run.attempts.empty()) queue_.insert(PlaceOf(id, run));
  return true;
}

std::vector<RunId> Scheduler::ReleaseAll(Worker& worker) {
  std::vector<RunId> released;
  for (const Fence fence : std::vector<Fence>(worker.live)) {
    Lease& lease = leases_.at(fence);
    Loosen(fence, lease, LeaseState::kOrphaned);
    if (Requeue(lease.run, runs_.at(lease.run))) released.push_back(lease.run);
  }
  statistics_.releases += released.size();
  return released;
}

void Scheduler::Lose(InstanceId id, Worker& worker) {
  worker.lost = true;
  ++statistics_.lost;
  Unlist(id, worker);
  Count(worker);
  orders_.lost.push_back({id, ReleaseAll(worker)});
}

void Scheduler::Finish(RunId id, Run& run, InstanceId worker, Fence fence) {
  run.finished = true;
  run.finished_by = worker;
  run.accepted = fence;
  --unfinished_;
  queue_.erase(PlaceOf(id, run));
  failing_.erase(PlaceOf(id, run));
  for (const Fence other : run.fences) {
    Lease& lease = leases_.at(other);
    if (lease.state != LeaseState::kLive) continue;
    orders_.cancels.push_back({lease.worker, other});
    Loosen(other, lease, LeaseState::kCancelled);
  }
  run.audit = !run.given_up && Audited(id, options_.audit_share);
  if (!run.audit) {
    run.spec = {};
    return;
  }
  ++statistics_.audits_open;
  audits_.insert(id);
}

Answer Scheduler::CompareDuplicate(RunId id, Run& run, InstanceId worker, Fence fence, std::uint64_t hash) {
  ++statistics_.duplicates;
  orders_.acknowledgements.push_back({worker, fence});
  if (run.given_up || run.hash != hash) {
    ++statistics_.nondeterministic;
    orders_.mismatches.push_back({id, run.finished_by, worker, run.hash, hash});
  }
  if (run.audit && (worker != run.finished_by || Alone(worker))) EndAudit(id, run, worker);
  // Its only worker audited itself, and then others came.
  if (run.audit) Requeue(id, run);
  ForgetIfDone(id);
  return Answer::kDuplicate;
}

Answer Scheduler::Completed(InstanceId worker, Fence fence, RunId id, std::uint64_t hash) {
  const auto found = leases_.find(fence);
  if (found == leases_.end()) {
    const auto known = runs_.find(id);
    if (known == runs_.end() || fence >= first_fence_) {
      orders_.acknowledgements.push_back({worker, fence});
      return Answer::kUnwanted;
    }
    // Leased by an earlier master of this campaign.
    Run& run = known->second;
    if (run.finished && run.accepted == fence) {
      if (run.acknowledged) orders_.acknowledgements.push_back({worker, fence});
      return Answer::kRepeated;
    }
    if (run.finished) return CompareDuplicate(id, run, worker, fence, hash);
    run.hash = hash;
    Finish(id, run, worker, fence);
    Praise(worker, std::exchange(run.attempts, {}));
    return Answer::kAccepted;
  }

  const Lease& lease = found->second;
  if (lease.worker != worker || lease.run != id) return Misaddressed(worker, fence, lease);
  if (lease.state == LeaseState::kAnswered) return Answer::kRepeated;
  Run& run = runs_.at(id);
  EndLease(fence);
  if (run.finished) return CompareDuplicate(id, run, worker, fence, hash);
  run.hash = hash;
  leases_[fence] = Lease{id, worker, LeaseState::kAnswered, listening_};
  Finish(id, run, worker, fence);
  Praise(worker, std::exchange(run.attempts, {}));
  return Answer::kAccepted;
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

bool Scheduler::Works(InstanceId worker) const {
  const auto found = workers_.find(worker);
  return found != workers_.end() && !found->second.live.empty();
}

std::uint32_t Scheduler::LeasesOf(RunId run) const {
  const auto found = runs_.find(run);
  return found == runs_.end() ? 0 : found->second.leases;
}

void Scheduler::EndAudit(RunId id, Run& run, InstanceId by) {
  if (by == run.finished_by) ++statistics_.audits_alone;
  run.audit = false;
  run.spec = {};
  audits_.erase(id);
  --statistics_.audits_open;
  ++statistics_.audits;
}

void Scheduler::ForgetIfDone(RunId id) {
  const auto found = runs_.find(id);
  if (found == runs_.end()) return;
  const Run& run = found->second;
  if (run.acknowledged && run.fences.empty() && !run.audit) runs_.erase(found);
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

bool Scheduler::IsSilent(const Worker& worker) const {
  const Duration limit =
      options_.lost_after * options_.heartbeat - Duration(options_.heartbeat) / kChecksPerHeartbeat;
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
  if (listening_ - worker.heard < kMostExcuses * options_.lost_after * options_.heartbeat) {
    worker.excused = listening_;
  }
}

SchedulerOrders Scheduler::Decide(TimePoint now) {
  Advance(now);
  if (listening_ >= next_check_) {
    next_check_ = listening_ + Duration(options_.heartbeat) / kChecksPerHeartbeat;
    for (auto& [id, worker] : workers_) {
      if (IsSilent(worker)) Lose(id, worker);
      if (worker.record.failed_in_a_row >= WorkerRecord::kBlackHole) List(id, worker);
    }
    Purge();
    JudgeAll();
    Assign();
    AssignCopies();
  }
  for (const RunId run : std::exchange(unjudged_, {})) Judge(run);
  Assign();
  MoveWaiting();
  AssignAudits();
  return std::exchange(orders_, {});
}

}  // namespace gauntlet
