// What people are told of the scheduler.
#include <algorithm>

#include "master/dispatch/leases/scheduler.h"

namespace gauntlet {

std::vector<std::pair<InstanceId, WorkerView>> Scheduler::DescribeWorkers() const {
  const auto seconds_since = [this](Duration then) {
    return std::chrono::duration<double>(listening_ - then).count();
  };
  std::vector<std::pair<InstanceId, WorkerView>> views;
  for (const auto& [id, worker] : workers_) {
    WorkerView view;
    view.slots = worker.slots;
    view.lost = worker.lost;
    view.leaving = worker.draining;
    view.record = worker.record;
    view.silent_seconds = seconds_since(worker.heard);
    std::vector<Fence> fences = worker.live;
    std::sort(fences.begin(), fences.end());
    for (const Fence fence : fences) {
      const Lease& lease = leases_.at(fence);
      view.leases.push_back({lease.run, fence, runs_.at(lease.run).leases, seconds_since(lease.granted),
                             view.leases.size() >= view.slots});
    }
    views.emplace_back(id, std::move(view));
  }
  std::sort(views.begin(), views.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
  return views;
}

bool Scheduler::Connected(InstanceId worker) const {
  const auto found = workers_.find(worker);
  return found != workers_.end() && !found->second.lost;
}

std::size_t Scheduler::queued() const {
  const auto waits = [this](const Place& place) { return runs_.at(place.run).live == 0; };
  return queue_.size() + static_cast<std::size_t>(std::ranges::count_if(failing_, waits));
}

WorkerStatistics Scheduler::Statistics() const {
  WorkerStatistics statistics = statistics_;
  for (const auto& [id, worker] : workers_) {
    if (worker.lost) continue;
    ++statistics.connected;
    if (!worker.live.empty()) ++statistics.busy;
    if (worker.record.quarantined) ++statistics.quarantined;
  }
  return statistics;
}

}  // namespace gauntlet
