// How many worker allocations a campaign should have in a cluster, and which of them should go: decisions
// only.
#pragma once

#include <chrono>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "base/system/clock.h"
#include "master/dispatch/pool/worker_pool.h"
#include "slurm/job_status.h"

namespace gauntlet::slurm {

struct PoolLimits {
  int max_allocations = 8;                  // waiting and running together
  int max_queued = 2;                       // waiting in the queue at one time (the backlog)
  int workers_per_allocation = 1;           // runs simulated at the same time in one allocation
  std::chrono::seconds idle_timeout{300};   // without a run to do, an allocation is given back after this
  std::chrono::seconds start_timeout{120};  // a job may run so long without a connected worker
  std::chrono::seconds early_loss{60};  // a job that failed sooner than this after a hello failed to start
  std::chrono::seconds query_interval{10};  // at most one squeue in this time
  std::chrono::seconds first_back_off{15};  // after a failed start; doubled with each further one in a row
  std::chrono::seconds longest_back_off{900};
  int failures_before_ban = 2;  // of starts on one node, after which the node is left out
};

// What the search could use.
struct Demand {
  int unfinished_runs = 0;  // asked for and not finished, leased or not
};

struct Decisions {
  int submit = 0;                          // allocations to ask for
  std::vector<std::string> cancel;         // job ids
  std::vector<std::string> exclude_nodes;  // of what is submitted now
  bool query = false;                      // look
};

// One allocation as the pool sees it; it was `cancelled` by us.
struct Allocation : AllocationView {
  JobPhase phase = JobPhase::kQueued;
  std::optional<TimePoint> running_since;  // first seen running
  std::optional<TimePoint> first_hello;    // of its first worker
  std::optional<TimePoint> silent_since;   // it runs, and none of its workers has been connected since
  std::optional<TimePoint> idle_since;     // none of its workers has had a run since
  int missing = 0;                         // queries in a row that did not show it
  bool judged = false;                     // whether its start has failed
};

// Fed with events and a clock, asked for decisions; pure, so that years of a cluster's moods run in a test in
// milliseconds. An allocation counts as coming capacity until its worker connects, it ends or its start times
// out. A start has failed when the job ended, or ran for `start_timeout`, without a worker's hello, or when
// it failed (FAILED, NODE_FAIL, OUT_OF_MEMORY, BOOT_FAIL) within `early_loss` of it; failures in a
// row delay the next submission, and a node with several is left out until a worker has said hello from it.
// Drained, preempted and timed out jobs are replaced at once. Thread-safety: one thread.
class PoolPolicy {
 public:
  explicit PoolPolicy(const PoolLimits& limits, Cluster cluster = SlurmCluster())
      : limits_(limits), cluster_(std::move(cluster)) {}

  void Submitted(const std::string& job, TimePoint now);
  // The cluster refused, or did not answer. kInUse: there was no room, which is no failure. kNotFound:
  // nothing can be submitted any more, until something is.
  void SubmissionFailed(const std::string& message, TimePoint now, ErrorKind kind = ErrorKind::kIo);
  // A job of an earlier master that is still there.
  void Adopt(const JobStatus& job, TimePoint now);
  // All jobs of this pool that the cluster knows. One that is missing twice in a row has ended.
  void Observed(const std::vector<JobStatus>& jobs, TimePoint now);
  // The cluster did not answer: what was known stands.
  void QueryFailed(const std::string& message, TimePoint now, ErrorKind kind = ErrorKind::kIo);
  // How many workers of the allocation are connected, and how many of them have a run.
  void Workers(const std::string& job, int connected, int busy, TimePoint now);
  // From now on nothing is submitted, and everything is cancelled.
  void Stop() { stopping_ = true; }

  Decisions Decide(const Demand& demand, TimePoint now);

  std::vector<Allocation> allocations() const;
  // Why the master should end, for nothing that it asks for ever starts; "" when it should not.
  std::string GivenUp() const;
  // Why there are fewer workers than could be used, in a sentence with the cluster's own words; "" when all
  // is well.
  std::string Trouble(TimePoint now) const;

 private:
  using Allocations = std::map<std::string, Allocation>;  // by job id

  void NoteHopeless(const std::string& message, ErrorKind kind);
  void End(Allocations::iterator ended, TimePoint now);
  void StartFailed(Allocation& allocation, const std::string& what, TimePoint now);
  void CancelLost(TimePoint now, Decisions& decisions);
  void CancelIdle(const Demand& demand, TimePoint now, Decisions& decisions);

  PoolLimits limits_;
  Cluster cluster_;
  Allocations allocations_;
  std::map<std::string, int> failures_of_node_;
  std::set<std::string> banned_;
  int failures_in_a_row_ = 0;
  std::string last_failure_;
  std::string query_error_;
  std::string full_;
  std::string hopeless_;
  bool heard_any_ = false;               // a worker, ever
  std::optional<TimePoint> not_before_;  // back-off
  std::optional<TimePoint> last_query_;
  std::optional<TimePoint> unwanted_since_;  // no run has been unfinished since
  bool query_running_ = false;
  bool stopping_ = false;
};

}  // namespace gauntlet::slurm
