// What people are told of the scheduler.
#include <algorithm>

#include "master/dispatch/scheduler.h"

namespace gauntlet::master {

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

WorkerStatistics Scheduler::Statistics() const {
  WorkerStatistics statistics = statistics_;
  for (const auto& [id, worker] : workers_) {
    if (worker.lost) continue;
    ++statistics.connected;
    if (!worker.live.empty()) ++statistics.busy;
  }
  return statistics;
}

}  // namespace gauntlet::master
