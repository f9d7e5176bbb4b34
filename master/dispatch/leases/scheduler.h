// Who does which run: the queue, leases with fencing numbers, heartbeats, retries, duplicates. It decides and
// does nothing: events go in, orders come out, the time is an argument. No sockets, no threads, no clock.
//
// A run is queued, leased (at least one live lease) or finished. A lease is
//   live       the worker is expected to answer; counts against its credit
//   orphaned   its worker vanished; a late answer is as good as any: same spec, same bits
//   cancelled  not needed any more; a late answer is a duplicate and is compared
//   answered   its result was accepted and waits to be stored (Acknowledge)
// so that no answer is ever refused for being late, and no run is finished twice.
//
// When the queue is empty, idle workers take over the leases that wait at others behind the run they are at,
// and get a second lease of runs that take unusually long (copy_after), or of finished runs that are to be
// audited; a finished run is remembered until its audit has been answered.
//
// No worker is believed alone while there are others: a run that failed goes to workers that have not failed
// it, and one whose runs only fail while others finish them gets no more (master/dispatch/trust). But of a
// program that is not known to be reproducible no run is leased twice for speed, and its first ending counts.
#pragma once

#include <cstdint>
#include <deque>
#include <functional>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <unordered_map>
#include <utility>
#include <vector>

#include "base/system/clock.h"
#include "master/dispatch/dispatch_options.h"
#include "master/dispatch/evaluation_backend.h"
#include "master/dispatch/leases/scheduler_orders.h"
#include "master/dispatch/leases/scheduler_state.h"
#include "master/dispatch/trust/trust_policy.h"

namespace gauntlet {

class Scheduler {
 public:
  // Fencing numbers are first_fence, first_fence + 1, ...; smaller ones belong to earlier masters.
  Scheduler(const DispatchOptions& options, Fence first_fence);

  // What is submitted from now on comes after what was submitted so far, whenever it is released.
  void BeginBatch() { ++batch_; }
  // Ids are new. Within a batch the longest go first (RunRequest::length), equals in the order of their ids.
  // The spec is kept until no lease of the run can be given any more.
  void Submit(RunRequest request);
  // The result of this finished run is stored durably.
  void Acknowledge(RunId id);
  void StopLeasing() { leasing_ = false; }  // for good

  // A worker said hello, for the first time or after a reconnect; `held`: leases it works on or has results
  // for; `host`: where it says it is, "" when it does not.
  void WorkerJoined(InstanceId id, std::uint32_t slots, const std::vector<Fence>& held, TimePoint now,
                    const std::string& host = "");
  // The following return false when the worker is unknown.
  void WorkerPaced(InstanceId id, Duration heartbeat);  // by which its silence is judged from now on
  bool WorkerHeard(InstanceId id, TimePoint now);
  bool WorkerHeartbeat(InstanceId id, const std::vector<Fence>& held, TimePoint now);
  bool WorkerDraining(InstanceId id);  // finishes what it has, wants nothing new
  bool WorkerLeft(InstanceId id);      // said goodbye: nothing will come from it any more
  bool WorkerDied(InstanceId id);      // its process is gone; what it sent before may still arrive

  // `to_its_end`: it was simulated so far, and not refused.
  Answer Completed(InstanceId worker, Fence fence, RunId id, std::uint64_t hash, bool to_its_end = true);
  Answer Failed(InstanceId worker, Fence fence, RunId id, const proto::RunnerFailure& failure);
  // It answered with something that is no result. That is its own fault: the run waits for others.
  Answer Unreadable(InstanceId worker, Fence fence, RunId id);
  // How long a run takes, as one that has just ended did: predicts the length of those to come.
  void RunTook(double seconds);
  // The lease could not be sent. The worker gets no other before it is heard of again.
  void Undelivered(Fence fence);

  // Workers that the next Decide takes for lost, unless they are heard or excused before.
  std::vector<InstanceId> Silent(TimePoint now);
  // It lives and merely waits for a processor: it may be silent as long again, ten times at most.
  void Excuse(InstanceId id);

  // Looks for silent workers, gives leases, and hands over all orders since the last call.
  SchedulerOrders Decide(TimePoint now);

  bool Known(InstanceId worker) const { return workers_.contains(worker); }
  bool Connected(InstanceId worker) const;  // known and not lost
  bool Works(InstanceId worker) const;      // has a lease that it has not answered
  std::uint32_t LeasesOf(RunId run) const;  // given so far; 0 for unknown and forgotten runs
  std::size_t queued() const;               // runs that nobody has
  std::size_t unfinished() const { return unfinished_; }
  WorkerStatistics Statistics() const;
  // Without labels and pids, in the order of the ids; times as of the last event. Runs that several workers
  // do are named with each.
  std::vector<std::pair<InstanceId, WorkerView>> DescribeWorkers() const;
  // Of the workers that are connected and want to work; none of them gets any: all are quarantined.
  bool AllQuarantined() const;

 private:
  static constexpr int kChecksPerHeartbeat = 8;  // for what is silent or slow
  // Leases, unless its slots need more: a worker keeps 4,096 that wait, and gives the others back.
  static constexpr std::size_t kMostAtAWorker = 4096;

  using LeaseState = scheduling::LeaseState;
  using Lease = scheduling::Lease;
  using Place = scheduling::Place;
  using Run = scheduling::Run;
  using Worker = scheduling::Worker;

  void Advance(TimePoint now);
  void ForgetIfDone(RunId id);
  static Place PlaceOf(RunId id, const Run& run) { return {run.batch, run.length, id}; }
  bool Standing(InstanceId id, const Worker& worker) const {
    return !worker.lost && !worker.draining && !trust_.RecordOf(id).quarantined;
  }

  // lease_assignment.cc
  void List(InstanceId id, Worker& worker);       // and, of a host with a limit, the others there
  void ListAlone(InstanceId id, Worker& worker);  // where it belongs in available_, slots_ and busy_
  bool IsFull(const std::string& host) const;     // it has as many leases as they say
  bool Slowed(InstanceId id, const Worker& worker) const;
  std::uint32_t Credit() const;  // leases per slot, by the predicted length of a run
  bool ManyWait() const;         // so many that nobody waits for a single one of them
  void Grant(InstanceId worker_id, RunId id);
  void Assign();
  void AssignFailing();
  void AssignAudits();
  void AssignChecks();  // the audits that tell whether the program is reproducible
  void AssignCopies();
  // It has been worked at unusually long, and short runs end before anybody could help.
  bool TakesLong(const Lease& lease) const;
  bool HasBegun(Fence fence, const Lease& lease) const;
  void MoveWaiting();
  std::vector<InstanceId> AbleTo(const Run& run) const;  // all but who has kept it too long already
  std::optional<InstanceId> HelperFor(RunId id) const;
  std::size_t FirstWaiting(const Worker& worker) const;  // in its live leases: certainly not begun
  bool Alone(InstanceId worker) const;                   // there is no other worker

  // lease_answers.cc
  void Accept(RunId id, Run& run, InstanceId worker, Fence fence, std::uint64_t hash, bool to_its_end);
  void Finish(RunId id, Run& run, InstanceId worker, Fence fence);
  Answer CompareDuplicate(RunId id, Run& run, InstanceId worker, Fence fence, std::uint64_t hash,
                          Duration granted);
  void NoteDifference(RunId id, const Run& run, InstanceId worker, std::uint64_t hash);
  void FailedAfterwards(RunId id, Run& run, InstanceId worker, const proto::RunnerFailure& failure);
  void EndAudit(RunId id, Run& run, InstanceId by);
  Answer Misaddressed(InstanceId worker, Fence fence, const Lease& lease);
  void NoteAttempt(RunId id, const Run& run, InstanceId worker, std::optional<proto::RunnerFailure> failure);
  void Judge(RunId id);
  void Strike(InstanceId worker);
  void Quarantine(InstanceId id);
  // Runs of which nobody says any more that they failed, after this, wait like those that nobody has tried.
  void Reconsider(const std::function<bool(RunId)>& forget);
  void ForgiveEndsFromOutside(InstanceId worker);  // it goes away

  // lease_expiry.cc
  void Heard(InstanceId id, Worker& worker);
  void Reconcile(InstanceId id, Worker& worker, const std::vector<Fence>& held, Duration grace);
  // Or will be before the next check, so that silence is noticed within its limit, not after it.
  bool IsSilent(const Worker& worker) const;
  void Lose(InstanceId id, Worker& worker);
  std::vector<RunId> ReleaseAll(InstanceId id, Worker& worker, LeaseState state);
  void Purge();
  void EraseLive(Worker& worker, Fence fence);  // the next in line begins
  void Loosen(Fence fence, Lease& lease, LeaseState state);
  RunId EndLease(Fence fence);  // of this run
  bool Requeue(RunId id, Run& run);

  DispatchOptions options_;
  Fence first_fence_;
  Fence next_fence_;
  TrustPolicy trust_;
  bool leasing_ = true;

  // Time in which the master was listening: it advances by at most one heartbeat per event, so that a master
  // that was itself frozen or busy does not take its workers for silent.
  Duration listening_{};
  TimePoint last_now_{};
  bool started_ = false;
  Duration next_check_{};
  double predicted_seconds_ = -1.0;  // of a run; negative: none has ended yet

  std::unordered_map<RunId, Run> runs_;
  std::set<Place> queue_;    // nobody has them, and nobody has failed them
  std::set<Place> failing_;  // somebody has failed them, and they are unfinished
  std::uint64_t batch_ = 0;
  std::size_t unfinished_ = 0;
  std::set<RunId> audits_;  // finished runs that wait for their second lease
  std::unordered_map<Fence, Lease> leases_;
  std::map<InstanceId, Worker> workers_;
  // Workers that can take a lease, least loaded first: (live leases / slots, id).
  std::set<std::pair<std::uint32_t, InstanceId>> available_;
  // Stored runs of which some lease was never answered, by the time they were stored.
  std::deque<std::pair<Duration, RunId>> loose_ends_;
  SchedulerOrders orders_;
  WorkerStatistics statistics_;  // all but the workers at the moment
  // Of workers that are neither lost nor leaving: slots, and those of them that have a lease.
  std::uint64_t slots_ = 0;
  std::uint64_t busy_ = 0;
};

}  // namespace gauntlet
