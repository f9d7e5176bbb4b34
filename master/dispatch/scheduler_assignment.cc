// Which worker gets which lease.
#include <algorithm>

#include "master/dispatch/scheduler.h"

namespace gauntlet::master {

void Scheduler::Grant(InstanceId worker_id, RunId id) {
  Worker& worker = workers_.at(worker_id);
  Run& run = runs_.at(id);
  const Fence fence = next_fence_++;
  leases_.emplace(fence, Lease{id, worker_id, LeaseState::kLive, listening_});
  run.fences.push_back(fence);
  ++run.live;
  ++run.leases;
  worker.live.push_back(fence);
  List(worker_id, worker);
  orders_.leases.push_back({worker_id, {fence, id, run.spec, run.leases}});
}

void Scheduler::Assign() {
  if (!leasing_) return;
  while (!queue_.empty() && !available_.empty()) {
    const RunId id = queue_.begin()->run;
    queue_.erase(queue_.begin());
    Grant(available_.begin()->second, id);
  }
}

bool Scheduler::Alone(InstanceId worker) const {
  return std::none_of(workers_.begin(), workers_.end(), [worker](const auto& other) {
    return other.first != worker && !other.second.lost && !other.second.draining;
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
    Duration granted;
    RunId run;
    InstanceId owner;
  };
  std::vector<Slow> slow;
  for (const auto& [id, worker] : workers_) {
    for (const Fence fence : worker.live) {
      const Lease& lease = leases_.at(fence);
      const Run& run = runs_.at(lease.run);
      const double seconds = std::chrono::duration<double>(listening_ - lease.granted).count();
      if (!run.finished && run.live == 1 && seconds > late) slow.push_back({lease.granted, lease.run, id});
    }
  }
  // What has taken longest gets help first.
  std::sort(slow.begin(), slow.end(), [](const Slow& a, const Slow& b) {
    return a.granted != b.granted ? a.granted < b.granted : a.run < b.run;
  });
  for (const Slow& one : slow) {
    const auto idle = std::find_if(available_.begin(), available_.end(), [&](const auto& place) {
      const Worker& worker = workers_.at(place.second);
      return place.second != one.owner && worker.live.size() < worker.slots;
    });
    if (idle == available_.end()) return;
    ++statistics_.copies;
    Grant(idle->second, one.run);
  }
}

}  // namespace gauntlet::master
