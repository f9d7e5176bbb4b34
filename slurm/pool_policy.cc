#include "slurm/pool_policy.h"

#include <algorithm>
#include <utility>

namespace gauntlet::slurm {
namespace {

using std::chrono::duration_cast;
using std::chrono::seconds;

// A job that the queue has not shown this often in a row is gone: once may be a hiccup of a controller that
// has just been restarted.
constexpr int kMissingBeforeEnd = 2;

// What to look at when a job ends before its worker has spoken.
constexpr const char* kWhereToLook =
    ": its log is log/worker-JOB.log in the campaign's directory; when there is none, the node does not see "
    "that directory, which must be on a file system shared with the compute nodes (--dir)";

// Ends that are the job's or the node's fault, unlike a drain, a preemption or the time limit.
bool IsFailure(std::string_view state) {
  return state == "FAILED" || state == "NODE_FAIL" || state == "OUT_OF_MEMORY" || state == "BOOT_FAIL";
}

// Takes over what Slurm says of the job.
void Show(const JobStatus& job, Allocation& allocation, TimePoint now) {
  allocation.missing = 0;
  allocation.phase = job.phase;
  allocation.state = job.state;
  allocation.reason = job.reason;
  if (!job.nodes.empty()) allocation.nodes = job.nodes;
  if (job.phase == JobPhase::kRunning && !allocation.running_since)
    allocation.running_since = allocation.silent_since = now;
}

std::string JobName(const Allocation& allocation) {
  std::string name = "job " + allocation.job;
  if (!allocation.nodes.empty()) name += " on " + allocation.nodes;
  return name;
}

}  // namespace

void PoolPolicy::Submitted(const std::string& job, TimePoint now) {
  const auto [entry, added] = allocations_.try_emplace(job);
  if (added) {
    entry->second.job = job;
    entry->second.state = "PENDING";
  }
  query_error_.clear();
  full_.clear();
  hopeless_.clear();
  // Not seen by a query that was under way.
  last_query_ = now;
}

void PoolPolicy::SubmissionFailed(const std::string& message, TimePoint now, ErrorKind kind) {
  if (kind == ErrorKind::kInUse) {
    full_ = message;
    not_before_ = now + limits_.query_interval;
    return;
  }
  NoteHopeless(message, kind);
  Allocation none;
  none.job = "(none)";
  StartFailed(none, message, now);
}

void PoolPolicy::NoteHopeless(const std::string& message, ErrorKind kind) {
  if (kind == ErrorKind::kNotFound && cluster_.give_up_after > 0) hopeless_ = message;
}

std::string PoolPolicy::GivenUp() const {
  const bool lives =
      std::ranges::any_of(allocations_, [](const auto& entry) { return !entry.second.cancelled; });
  if (!hopeless_.empty() && !lives) return hopeless_;
  if (heard_any_ || cluster_.give_up_after == 0 || failures_in_a_row_ < cluster_.give_up_after) return "";
  return "gave up after " + std::to_string(failures_in_a_row_) +
         (failures_in_a_row_ == 1 ? " failed start" : " failed starts in a row") +
         ", without a word from any worker; the last: " + last_failure_;
}

void PoolPolicy::Adopt(const JobStatus& job, TimePoint now) {
  Submitted(job.id, now);
  Show(job, allocations_.at(job.id), now);
}

void PoolPolicy::Observed(const std::vector<JobStatus>& jobs, TimePoint now) {
  query_running_ = false;
  query_error_.clear();
  hopeless_.clear();
  last_query_ = now;
  for (auto& [id, allocation] : allocations_) ++allocation.missing;
  for (const JobStatus& job : jobs) {
    const auto found = allocations_.find(job.id);
    if (found != allocations_.end()) Show(job, found->second, now);
  }
  for (auto next = allocations_.begin(); next != allocations_.end();) {
    const auto one = next++;
    if (one->second.phase == JobPhase::kEnded || one->second.missing >= kMissingBeforeEnd) End(one, now);
  }
}

void PoolPolicy::QueryFailed(const std::string& message, TimePoint now, ErrorKind kind) {
  NoteHopeless(message, kind);
  query_running_ = false;
  query_error_ = message;
  last_query_ = now;
}

void PoolPolicy::Workers(const std::string& job, int connected, int busy, TimePoint now) {
  const auto found = allocations_.find(job);
  if (found == allocations_.end()) return;
  Allocation& allocation = found->second;
  allocation.workers = connected;
  if (connected > 0) {
    heard_any_ = true;
    // A hello is faster than a look at the queue.
    if (!allocation.running_since) allocation.running_since = now;
    if (allocation.phase == JobPhase::kQueued) {
      allocation.phase = JobPhase::kRunning;
      allocation.state = "RUNNING";
      allocation.reason.clear();
    }
    allocation.silent_since.reset();
    if (!allocation.first_hello) {
      allocation.first_hello = now;
      failures_in_a_row_ = 0;
      not_before_.reset();
      failures_of_node_.erase(allocation.nodes);
      banned_.erase(allocation.nodes);
    }
  } else if (allocation.running_since && !allocation.silent_since) {
    allocation.silent_since = now;
  }
  if (busy > 0) {
    allocation.idle_since.reset();
  } else if (!allocation.idle_since && connected > 0) {
    allocation.idle_since = now;
  }
}

void PoolPolicy::End(Allocations::iterator ended, TimePoint now) {
  Allocation& allocation = ended->second;
  std::string how = allocation.state;
  if (!allocation.reason.empty()) how += ", " + allocation.reason;
  if (!allocation.cancelled && !allocation.first_hello) {
    StartFailed(allocation,
                JobName(allocation) + " ended (" + how + ") before its worker said hello" + kWhereToLook,
                now);
  } else if (!allocation.cancelled && IsFailure(allocation.state) &&
             now - *allocation.first_hello < limits_.early_loss) {
    StartFailed(allocation, JobName(allocation) + " ended (" + how + ") soon after its start", now);
  }
  allocations_.erase(ended);
}

void PoolPolicy::StartFailed(Allocation& allocation, const std::string& what, TimePoint now) {
  last_failure_ = what;
  if (std::exchange(allocation.judged, true)) return;
  ++failures_in_a_row_;
  constexpr int kMostDoublings = 20;
  const auto back_off = limits_.first_back_off * (1 << std::min(failures_in_a_row_ - 1, kMostDoublings));
  not_before_ = now + std::min<seconds>(back_off, limits_.longest_back_off);
  const std::string& node = allocation.nodes;
  if (!node.empty() && ++failures_of_node_[node] >= limits_.failures_before_ban) banned_.insert(node);
}

void PoolPolicy::CancelLost(TimePoint now, Decisions& decisions) {
  for (auto& [job, allocation] : allocations_) {
    if (allocation.cancelled) continue;
    if (!stopping_) {
      const bool never = NeverStarts(allocation.reason, cluster_) || NeverStarts(allocation.state, cluster_);
      if (allocation.phase == JobPhase::kQueued && never) {
        const std::string& why = allocation.reason.empty() ? allocation.state : allocation.reason;
        StartFailed(allocation, "job " + job + " would never start: " + why, now);
      } else if (allocation.silent_since && now - *allocation.silent_since >= limits_.start_timeout) {
        const auto silent = duration_cast<seconds>(now - *allocation.silent_since);
        StartFailed(allocation,
                    JobName(allocation) + " has run for " + std::to_string(silent.count()) +
                        " s without a word from its worker",
                    now);
      } else {
        continue;
      }
    }
    allocation.cancelled = true;
    decisions.cancel.push_back(job);
  }
}

void PoolPolicy::CancelIdle(const Demand& demand, TimePoint now, Decisions& decisions) {
  // Between two generations there is no demand for a moment.
  if (demand.unfinished_runs > 0) unwanted_since_.reset();
  if (demand.unfinished_runs == 0 && !unwanted_since_) unwanted_since_ = now;
  const bool unwanted = unwanted_since_ && now - *unwanted_since_ >= limits_.idle_timeout;
  for (auto& [job, allocation] : allocations_) {
    if (allocation.cancelled) continue;
    const bool idle_too_long = allocation.idle_since && now - *allocation.idle_since >= limits_.idle_timeout;
    const bool not_wanted = allocation.phase == JobPhase::kQueued && unwanted;
    if (!idle_too_long && !not_wanted) continue;
    allocation.cancelled = true;
    decisions.cancel.push_back(job);
  }
}

Decisions PoolPolicy::Decide(const Demand& demand, TimePoint now) {
  Decisions decisions;
  CancelLost(now, decisions);
  CancelIdle(demand, now, decisions);

  if (!allocations_.empty() && !query_running_ &&
      (!last_query_ || now - *last_query_ >= limits_.query_interval)) {
    decisions.query = true;
    query_running_ = true;
    last_query_ = now;
  }
  if (stopping_ || (not_before_ && now < *not_before_)) return decisions;

  int living = 0;
  int queued = 0;
  int unproven = 0;
  for (const auto& [job, allocation] : allocations_) {
    if (allocation.cancelled || allocation.phase == JobPhase::kEnding) continue;
    ++living;
    if (allocation.phase == JobPhase::kQueued) ++queued;
    if (!allocation.first_hello) ++unproven;
  }
  const int per_allocation = std::max(1, limits_.workers_per_allocation);
  const int useful = (demand.unfinished_runs + per_allocation - 1) / per_allocation;
  const int wanted = std::min(useful, limits_.max_allocations) - living;
  decisions.submit = std::clamp(wanted, 0, std::max(0, limits_.max_queued - queued));
  // After a failed start one allocation at a time shows whether the cause is gone.
  if (failures_in_a_row_ > 0) decisions.submit = unproven == 0 ? std::min(decisions.submit, 1) : 0;
  if (decisions.submit > 0) decisions.exclude_nodes.assign(banned_.begin(), banned_.end());
  return decisions;
}

std::vector<Allocation> PoolPolicy::allocations() const {
  std::vector<Allocation> result;
  for (const auto& [job, allocation] : allocations_) result.push_back(allocation);
  return result;
}

std::string PoolPolicy::Trouble(TimePoint now) const {
  if (!query_error_.empty()) return cluster_.name + " does not answer: " + query_error_;
  if (failures_in_a_row_ > 0) {
    std::string text = std::to_string(failures_in_a_row_) +
                       (failures_in_a_row_ == 1 ? " start has failed: " : " starts in a row have failed: ") +
                       last_failure_;
    if (not_before_ && now < *not_before_) {
      text += "; the next try is in " +
              std::to_string(duration_cast<seconds>(*not_before_ - now).count() + 1) + " s";
    }
    return text;
  }
  if (!full_.empty()) return full_;
  int connected = 0;
  std::string waiting;
  for (const auto& [job, allocation] : allocations_) {
    connected += allocation.workers;
    if (allocation.phase == JobPhase::kQueued && !allocation.cancelled && waiting.empty()) {
      waiting = "job " + job + " waits in the queue";
      if (!allocation.reason.empty()) waiting += " (" + allocation.reason + ")";
    }
  }
  return connected == 0 ? waiting : "";
}

}  // namespace gauntlet::slurm
