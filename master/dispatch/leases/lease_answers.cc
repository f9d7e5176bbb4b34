// What workers say of their leases, and what comes of it: results, failures, verdicts, quarantine.
#include <algorithm>

#include "master/dispatch/leases/scheduler.h"

namespace gauntlet {

Answer Scheduler::Completed(InstanceId worker, Fence fence, RunId id, std::uint64_t hash, bool to_its_end) {
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
    if (run.finished) return CompareDuplicate(id, run, worker, fence, hash, Duration::zero());
    Accept(id, run, worker, fence, hash, to_its_end);
    return Answer::kAccepted;
  }

  const Lease& lease = found->second;
  if (lease.worker != worker || lease.run != id) return Misaddressed(worker, fence, lease);
  if (lease.state == LeaseState::kAnswered) return Answer::kRepeated;
  Run& run = runs_.at(id);
  const Duration granted = lease.granted;
  EndLease(fence);
  if (run.finished) return CompareDuplicate(id, run, worker, fence, hash, granted);
  leases_[fence] = Lease{id, worker, LeaseState::kAnswered, listening_};
  Accept(id, run, worker, fence, hash, to_its_end);
  return Answer::kAccepted;
}

void Scheduler::Accept(RunId id, Run& run, InstanceId worker, Fence fence, std::uint64_t hash,
                       bool to_its_end) {
  run.hash = hash;
  if (to_its_end) trust_.reproducibility().Check(id, trust_.HostOf(worker));
  Finish(id, run, worker, fence);
  for (const InstanceId wrong : trust_.Finished(worker, id)) Quarantine(wrong);
}

void Scheduler::Finish(RunId id, Run& run, InstanceId worker, Fence fence) {
  run.finished = true;
  run.finished_by = worker;
  run.accepted = fence;
  --unfinished_;
  queue_.erase(PlaceOf(id, run));
  failing_.erase(PlaceOf(id, run));
  std::vector<InstanceId> hoarders;
  for (const Fence other : run.fences) {
    Lease& lease = leases_.at(other);
    if (lease.state != LeaseState::kLive) continue;
    if (HasBegun(other, lease) && TakesLong(lease)) hoarders.push_back(lease.worker);
    orders_.cancels.push_back({lease.worker, other});
    Loosen(other, lease, LeaseState::kCancelled);
  }
  for (const InstanceId hoarder : hoarders) {
    if (trust_.Hoarded(hoarder)) Quarantine(hoarder);
  }
  const Reproducibility& seen = trust_.reproducibility();
  run.audit = !run.given_up && (trust_.Audits(id) || seen.Checks(id));
  if (seen.observed()) run.audit_from = listening_ + Reproducibility::kPause;
  if (!run.audit) {
    run.spec = {};
    return;
  }
  ++statistics_.audits_open;
  audits_.insert(id);
}

Answer Scheduler::CompareDuplicate(RunId id, Run& run, InstanceId worker, Fence fence, std::uint64_t hash,
                                   Duration granted) {
  ++statistics_.duplicates;
  orders_.acknowledgements.push_back({worker, fence});
  const bool same = !run.given_up && run.hash == hash;
  if (!same) NoteDifference(id, run, worker, hash);
  if (run.audit && granted >= run.audit_from && (worker != run.finished_by || Alone(worker))) {
    if (same) trust_.reproducibility().Same(id, trust_.HostOf(worker));
    EndAudit(id, run, worker);
  }
  // Its only worker audited itself, and then others came.
  if (run.audit) Requeue(id, run);
  ForgetIfDone(id);
  return Answer::kDuplicate;
}

// `hash`: 0 of a failure.
void Scheduler::NoteDifference(RunId id, const Run& run, InstanceId worker, std::uint64_t hash) {
  if (!trust_.reproducibility().observed()) {
    ++statistics_.nondeterministic;
    orders_.mismatches.push_back({id, run.finished_by, worker, run.hash, hash});
  } else if (!run.killed) {
    ++statistics_.differences;
    trust_.reproducibility().Differs(id, trust_.HostOf(worker));
  }
}

void Scheduler::EndAudit(RunId id, Run& run, InstanceId by) {
  if (by == run.finished_by) ++statistics_.audits_alone;
  run.audit = false;
  run.spec = {};
  audits_.erase(id);
  --statistics_.audits_open;
  ++statistics_.audits;
}

Answer Scheduler::Failed(InstanceId worker, Fence fence, RunId id, const proto::RunnerFailure& failure) {
  const auto found = leases_.find(fence);
  if (found == leases_.end()) {
    orders_.acknowledgements.push_back({worker, fence});
    return Answer::kUnwanted;
  }
  const Lease& lease = found->second;
  if (lease.worker != worker || lease.run != id) return Misaddressed(worker, fence, lease);
  if (lease.state == LeaseState::kAnswered) return Answer::kRepeated;
  Run& run = runs_.at(id);
  EndLease(fence);
  orders_.acknowledgements.push_back({worker, fence});
  if (run.finished) {
    FailedAfterwards(id, run, worker, failure);
    return Answer::kUnwanted;
  }
  const bool leaves = !Standing(worker, workers_.at(worker));
  if (failure.kind != proto::FailureKind::kExternal || (failure.signal != 0 && !leaves)) {
    NoteAttempt(id, run, worker, failure);
    return Answer::kAccepted;
  }
  Requeue(id, run);
  if (!leaves && trust_.Returned(worker)) Quarantine(worker);
  return Answer::kAccepted;
}

// A run that has finished.
void Scheduler::FailedAfterwards(RunId id, Run& run, InstanceId worker, const proto::RunnerFailure& failure) {
  const bool own = failure.kind != proto::FailureKind::kExternal && !run.given_up;
  const bool once = own && trust_.reproducibility().first_ending_counts();
  if (once || (own && run.audit && ++run.audit_failures >= options_.attempts)) {
    NoteDifference(id, run, worker, 0);
    if (run.audit) EndAudit(id, run, worker);
  }
  Requeue(id, run);
  ForgetIfDone(id);
}

Answer Scheduler::Unreadable(InstanceId worker, Fence fence, RunId id) {
  const auto found = leases_.find(fence);
  if (found == leases_.end()) {
    orders_.acknowledgements.push_back({worker, fence});
    Strike(worker);
    return Answer::kUnwanted;
  }
  const Lease lease = found->second;
  if (lease.worker == worker && lease.state == LeaseState::kAnswered) {
    Strike(worker);
    return Answer::kRepeated;
  }
  Misaddressed(worker, fence, lease);
  return lease.worker == worker && lease.run == id ? Answer::kAccepted : Answer::kRejected;
}

// An answer to its own lease that says nothing of the run ends the lease; one to another's lease ends
// nothing.
Answer Scheduler::Misaddressed(InstanceId worker, Fence fence, const Lease& lease) {
  if (lease.worker == worker && lease.state != LeaseState::kAnswered) {
    const RunId id = lease.run;
    Run& run = runs_.at(id);
    EndLease(fence);
    orders_.acknowledgements.push_back({worker, fence});
    if (run.finished) {
      Requeue(id, run);
      ForgetIfDone(id);
    } else {
      NoteAttempt(id, run, worker, std::nullopt);
    }
  }
  Strike(worker);
  return Answer::kRejected;
}

void Scheduler::NoteAttempt(RunId id, const Run& run, InstanceId worker,
                            std::optional<proto::RunnerFailure> failure) {
  const bool alone = trust_.Failed(worker, id, std::move(failure), listening_);
  queue_.erase(PlaceOf(id, run));
  failing_.insert(PlaceOf(id, run));
  List(worker, workers_.at(worker));
  if (alone) Quarantine(worker);
}

void Scheduler::Strike(InstanceId worker) {
  if (trust_.Strike(worker)) Quarantine(worker);
}

void Scheduler::Judge(RunId id) {
  const auto found = runs_.find(id);
  if (found == runs_.end() || found->second.finished) return;
  Run& run = found->second;
  const std::optional<Verdict> verdict = trust_.Judge(id, AbleTo(run), !queue_.empty(), listening_);
  if (!verdict) return;
  run.given_up = true;
  run.killed = verdict->failure.kind == proto::FailureKind::kExternal;
  orders_.given_up.push_back({*verdict, id, run.leases});
  if (verdict->alone()) ++statistics_.lone_verdicts;
  Finish(id, run, verdict->worker, 0);
  trust_.Close(id);
}

void Scheduler::Quarantine(InstanceId id) {
  Worker& worker = workers_.at(id);
  orders_.quarantined.push_back({id, trust_.RecordOf(id)});
  List(id, worker);
  ReleaseAll(id, worker, LeaseState::kCancelled);
  Reconsider([&](RunId run) { return trust_.Disregard(id, run); });
}

void Scheduler::Reconsider(const std::function<bool(RunId)>& forget) {
  for (const Place& place : std::set<Place>(failing_)) {
    if (!forget(place.run) || trust_.InDoubt(place.run)) continue;
    failing_.erase(place);
    if (runs_.at(place.run).live == 0) queue_.insert(place);
  }
}

void Scheduler::ForgiveEndsFromOutside(InstanceId worker) {
  Reconsider([&](RunId run) { return trust_.Excuse(worker, run, listening_); });
}

}  // namespace gauntlet
