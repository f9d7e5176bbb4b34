// What is made of failures: who is believed, when a run is given up, who gets nothing more to do.
//
// A run that fails on every worker is at fault itself, one that fails on a single worker among many is not.
// So each failed attempt is remembered with its worker, and the run goes to others. It is given up
//   - when `attempts` workers that have shown that they can work have failed it, not all of them on one host
//     while there are others;
//   - or when nobody is left to ask, after `attempts` attempts on those there are;
//   - and while no run at all has been finished, only after some patience, once every worker has had a run: a
//     bad worker may be the first to say hello.
#include <algorithm>
#include <tuple>

#include "master/dispatch/leases/scheduler.h"

namespace gauntlet {
namespace {

auto Told(const proto::RunnerFailure& failure) {
  return std::tuple(failure.kind, failure.signal, failure.exit_code);
}

}  // namespace

bool Scheduler::FailedOn(const Run& run, InstanceId worker) {
  return std::ranges::count(run.attempts, worker, &Attempt::worker) > 0;
}

bool Scheduler::PatienceLasts() const {
  if (somebody_finished_) return false;
  return !first_failure_ || listening_ - *first_failure_ < options_.lost_after * options_.heartbeat;
}

bool Scheduler::Trusted(const Attempt& attempt) const {
  const auto found = workers_.find(attempt.worker);
  return found == workers_.end() ? attempt.trusted : found->second.record.trusted();
}

Scheduler::Tally Scheduler::TallyOf(const Run& run) const {
  Tally tally;
  std::vector<InstanceId> seen;
  for (const Attempt& attempt : run.attempts) {
    if (!attempt.failure) continue;
    if (tally.failures++ == 0) {
      tally.only_host = attempt.host;
    } else if (tally.only_host != attempt.host) {
      tally.only_host.reset();
    }
    if (std::ranges::count(seen, attempt.worker) > 0) continue;
    seen.push_back(attempt.worker);
    ++tally.workers;
    if (Trusted(attempt)) ++tally.trusted;
  }
  return tally;
}

Scheduler::Others Scheduler::OthersFor(const Run& run, const Tally& tally) const {
  const Duration longest = std::chrono::duration_cast<Duration>(
      std::chrono::duration<double>(std::max(options_.cpu_limit_seconds, 1.0)));
  const auto keeps_it_too_long = [&](InstanceId id) {
    return std::ranges::any_of(run.fences, [&](Fence fence) {
      const Lease& lease = leases_.at(fence);
      return lease.worker == id && lease.state == LeaseState::kLive && listening_ - lease.granted > longest;
    });
  };
  Others others;
  for (const auto& [id, worker] : workers_) {
    if (!Standing(worker) || FailedOn(run, id) || keeps_it_too_long(id)) continue;
    ++others.all;
    if (!worker.record.tried()) ++others.untried;
    if (tally.only_host && worker.host != *tally.only_host) others.elsewhere = true;
  }
  return others;
}

bool Scheduler::Condemned(const Tally& tally, const Others& others) const {
  if (tally.failures < options_.attempts || PatienceLasts()) return false;
  // With other work to do, one of those that failed it may still show that it can be trusted.
  if (others.all == 0) return tally.trusted > 0 || !somebody_finished_ || queue_.empty();
  if (others.elsewhere) return false;
  if (somebody_finished_) return tally.trusted >= options_.attempts;
  return others.untried == 0 && tally.workers >= options_.attempts;
}

void Scheduler::Judge(RunId id) {
  const auto found = runs_.find(id);
  if (found == runs_.end() || found->second.finished) return;
  Run& run = found->second;
  const Tally tally = TallyOf(run);
  if (!Condemned(tally, OthersFor(run, tally))) return;
  // What is told most often, by trusted workers if there are any: it must not depend on who else is there.
  const Attempt* verdict = nullptr;
  std::uint32_t most = 0;
  for (const Attempt& attempt : run.attempts) {
    if (!attempt.failure || (tally.trusted > 0 && !Trusted(attempt))) continue;
    const auto alike =
        static_cast<std::uint32_t>(std::ranges::count_if(run.attempts, [&](const Attempt& other) {
          return other.failure && Told(*other.failure) == Told(*attempt.failure) &&
                 (tally.trusted == 0 || Trusted(other));
        }));
    if (verdict == nullptr || alike > most ||
        (alike == most && Told(*attempt.failure) <= Told(*verdict->failure))) {
      verdict = &attempt;
      most = alike;
    }
  }
  run.given_up = true;
  orders_.given_up.push_back(
      {id, verdict->worker, run.leases, *verdict->failure, most, tally.failures, tally.workers});
  if (tally.workers == 1) ++statistics_.lone_verdicts;
  Finish(id, run, verdict->worker, 0);
  run.attempts.clear();
}

void Scheduler::JudgeAll() {
  for (const Place& place : std::set<Place>(failing_)) Judge(place.run);
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
    if (run.audit && failure.kind != proto::FailureKind::kExternal &&
        ++run.audit_failures >= options_.attempts) {
      ++statistics_.nondeterministic;
      orders_.mismatches.push_back({id, run.finished_by, worker, run.hash, 0});
      EndAudit(id, run, worker);
    }
    Requeue(id, run);
    ForgetIfDone(id);
    return Answer::kUnwanted;
  }
  if (failure.kind == proto::FailureKind::kExternal) {
    Requeue(id, run);
  } else {
    NoteAttempt(id, run, worker, failure);
  }
  return Answer::kAccepted;
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

void Scheduler::NoteAttempt(RunId id, Run& run, InstanceId worker_id,
                            std::optional<proto::RunnerFailure> failure) {
  Worker& worker = workers_.at(worker_id);
  const bool again = FailedOn(run, worker_id);
  const bool own = failure.has_value();
  run.attempts.push_back({worker_id, worker.host, worker.record.trusted(), std::move(failure)});
  queue_.erase(PlaceOf(id, run));
  failing_.insert(PlaceOf(id, run));
  unjudged_.push_back(id);
  if (own) {
    if (!first_failure_) first_failure_ = listening_;
    ++worker.record.failed;
    if (!again) ++worker.record.failed_in_a_row;
    // It is the run, as it seems: nobody looks like a black hole for it.
    if (TallyOf(run).workers > 1) {
      for (const Attempt& attempt : run.attempts) {
        if (const auto known = workers_.find(attempt.worker); known != workers_.end() && attempt.failure)
          known->second.record.failed_in_a_row = 0;
      }
    }
  }
  List(worker_id, worker);
}

void Scheduler::Praise(InstanceId worker_id, const std::vector<Attempt>& contradicted) {
  const auto found = workers_.find(worker_id);
  if (found == workers_.end() || found->second.record.quarantined) return;
  somebody_finished_ = true;
  ++found->second.record.finished;
  found->second.record.failed_in_a_row = 0;
  std::set<InstanceId> seen{worker_id};
  for (const Attempt& attempt : contradicted) {
    const auto known = workers_.find(attempt.worker);
    if (!attempt.failure || known == workers_.end() || !seen.insert(attempt.worker).second) continue;
    ++known->second.record.contradicted;
    QuarantineIfDue(attempt.worker, known->second);
  }
}

void Scheduler::Strike(InstanceId worker) {
  const auto found = workers_.find(worker);
  if (found == workers_.end()) return;
  ++found->second.record.strikes;
  QuarantineIfDue(worker, found->second);
}

void Scheduler::QuarantineIfDue(InstanceId id, Worker& worker) {
  if (!worker.record.deserves_quarantine()) return;
  worker.record.quarantined = true;
  orders_.quarantined.push_back({id, worker.record});
  Unlist(id, worker);
  Count(worker);
  for (const Fence fence : std::vector<Fence>(worker.live)) {
    Lease& lease = leases_.at(fence);
    orders_.cancels.push_back({id, fence});
    Loosen(fence, lease, LeaseState::kCancelled);
    if (Requeue(lease.run, runs_.at(lease.run))) ++statistics_.releases;
  }
  for (const Place& place : std::set<Place>(failing_)) {
    Run& run = runs_.at(place.run);
    if (std::erase_if(run.attempts, [id](const Attempt& attempt) { return attempt.worker == id; }) == 0)
      continue;
    unjudged_.push_back(place.run);
    if (!run.attempts.empty()) continue;
    failing_.erase(place);
    if (run.live == 0) queue_.insert(place);
  }
}

bool Scheduler::AllQuarantined() const {
  const auto connected = [](const auto& worker) { return !worker.second.lost && !worker.second.draining; };
  return std::ranges::any_of(workers_, connected) && std::ranges::all_of(workers_, [&](const auto& worker) {
           return !connected(worker) || worker.second.record.quarantined;
         });
}

// A worker on which one run after the other fails is free again at once, and would draw most of the work. It
// is given one run per heartbeat as long as others do better, or may.
bool Scheduler::Slowed(InstanceId id, const Worker& worker) const {
  if (worker.record.failed_in_a_row < WorkerRecord::kBlackHole) return false;
  if (worker.live.empty() && listening_ >= worker.slowed_until) return false;
  return PatienceLasts() || std::ranges::any_of(workers_, [id](const auto& other) {
           return other.first != id && Standing(other.second) &&
                  other.second.record.failed_in_a_row < WorkerRecord::kBlackHole;
         });
}

}  // namespace gauntlet
