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
// When no run waits, idle workers get a second lease of runs that take unusually long (copy_after), or of
// finished runs that are to be audited; a finished run is remembered until its audit has been answered.
#pragma once

#include <array>
#include <cstdint>
#include <deque>
#include <map>
#include <set>
#include <tuple>
#include <unordered_map>
#include <utility>
#include <vector>

#include "base/system/clock.h"
#include "master/dispatch/dispatch_options.h"
#include "master/dispatch/evaluation_backend.h"
#include "master/dispatch/scheduler_orders.h"

namespace gauntlet::master {

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
  // No lease is given from now on.
  void StopLeasing() { leasing_ = false; }

  // A worker said hello, for the first time or after a reconnect; `held`: the leases it works on or has
  // results for.
  void WorkerJoined(InstanceId id, std::uint32_t slots, const std::vector<Fence>& held, TimePoint now);
  // The following return false when the worker is unknown.
  bool WorkerHeard(InstanceId id, TimePoint now);
  bool WorkerHeartbeat(InstanceId id, const std::vector<Fence>& held, TimePoint now);
  bool WorkerDraining(InstanceId id);  // finishes what it has, wants nothing new
  bool WorkerLeft(InstanceId id);      // said goodbye: nothing will come from it any more
  bool WorkerDied(InstanceId id);      // its process is gone; what it sent before may still arrive

  Answer Completed(InstanceId worker, Fence fence, RunId id, std::uint64_t hash);
  Answer Failed(InstanceId worker, Fence fence, RunId id, const proto::RunnerFailure& failure);
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
  bool Works(InstanceId worker) const;      // has a lease that it has not answered
  std::uint32_t LeasesOf(RunId run) const;  // given so far; 0 for unknown runs
  std::size_t queued() const { return queue_.size(); }
  std::size_t unfinished() const { return unfinished_; }
  std::size_t remembered_runs() const { return runs_.size(); }  // all that takes memory
  WorkerStatistics Statistics() const;
  // Without labels and pids, in the order of the ids; times as of the last event. Runs that several workers
  // do are named with each.
  std::vector<std::pair<InstanceId, WorkerView>> DescribeWorkers() const;

 private:
  static constexpr int kChecksPerHeartbeat = 8;  // for what is silent or slow
  // Leases, unless its slots need more: a worker keeps 4,096 that wait, and gives the others back.
  static constexpr std::size_t kMostAtAWorker = 4096;

  enum class LeaseState { kLive, kOrphaned, kCancelled, kAnswered };
  struct Lease {
    RunId run = 0;
    InstanceId worker = 0;
    LeaseState state = LeaseState::kLive;
    Duration granted{};
  };
  struct Place {  // in the queue
    std::uint64_t batch = 0;
    double length = 0.0;
    RunId run = 0;
    bool operator<(const Place& other) const {
      return std::tie(batch, other.length, run) < std::tie(other.batch, length, other.run);
    }
  };
  struct Run {
    proto::EncodedSpec spec;  // empty when the run has finished and its audit is not open
    std::uint64_t batch = 0;
    double length = 0.0;
    std::vector<Fence> fences;  // live, orphaned and cancelled leases
    std::uint32_t live = 0;
    std::uint32_t leases = 0;  // given so far
    std::uint32_t own_failures = 0;
    std::array<std::uint32_t, proto::kFailureKinds> failures_of_kind{};
    bool finished = false;
    bool given_up = false;
    bool acknowledged = false;
    bool audit = false;  // is to be simulated once more, and has not been
    std::uint32_t audit_failures = 0;
    Fence accepted = 0;
    InstanceId finished_by = 0;
    std::uint64_t hash = 0;
  };
  struct Worker {
    std::uint32_t slots = 1;
    std::vector<Fence> live;
    std::vector<Fence> loose;  // orphaned and cancelled
    Duration heard{};
    Duration excused{};  // value of listening_ at the last excuse
    bool lost = false;
    bool draining = false;
    bool blocked = false;  // the last lease could not be delivered
    bool filled = false;   // was given as many leases as it may have, and has not worked off half of them
    // Its part in the sums slots_ and busy_.
    std::uint32_t counted_slots = 0;
    std::uint32_t counted_busy = 0;
    // Its place in available_, when it has one.
    bool listed = false;
    std::uint32_t level = 0;
  };

  void Advance(TimePoint now);
  std::uint32_t Credit() const;  // leases per slot, by the predicted length of a run
  void Heard(InstanceId id, Worker& worker);
  void Reconcile(InstanceId id, Worker& worker, const std::vector<Fence>& held, Duration grace);
  void List(InstanceId id, Worker& worker);    // puts it where it belongs in available_
  void Unlist(InstanceId id, Worker& worker);  // takes it out of available_
  void Loosen(Fence fence, Lease& lease, LeaseState state);
  void EndLease(Fence fence);
  bool Requeue(RunId id, Run& run);
  void Count(Worker& worker);  // its slots and leases, for the statistics
  std::vector<RunId> ReleaseAll(Worker& worker);
  // Or will be before the next check, so that silence is noticed within its limit, not after it.
  bool IsSilent(const Worker& worker) const;
  void Lose(InstanceId id, Worker& worker);
  void Finish(RunId id, Run& run, InstanceId worker, Fence fence);
  Answer CompareDuplicate(RunId id, Run& run, InstanceId worker, Fence fence, std::uint64_t hash);
  void EndAudit(RunId id, Run& run, InstanceId by);
  void ForgetIfDone(RunId id);
  void Purge();
  void Grant(InstanceId worker_id, RunId id);
  void Assign();
  void AssignAudits();
  void AssignCopies();
  bool Alone(InstanceId worker) const;  // there is no other worker

  DispatchOptions options_;
  Fence first_fence_;
  Fence next_fence_;
  bool leasing_ = true;

  // Time in which the master was listening: it advances by at most one heartbeat per event, so that a master
  // that was itself frozen or busy does not take its workers for silent.
  Duration listening_{};
  TimePoint last_now_{};
  bool started_ = false;
  Duration next_check_{};
  double predicted_seconds_ = -1.0;  // of a run; negative: none has ended yet

  std::unordered_map<RunId, Run> runs_;
  std::set<Place> queue_;
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

}  // namespace gauntlet::master
