#include "master/dispatch/leases/scheduler.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "base/check.h"

namespace gauntlet {
namespace {

constexpr double kPredictionGain = 0.05;  // weight of the newest run in the predicted length

}  // namespace

Scheduler::Scheduler(const DispatchOptions& options, Fence first_fence)
    : options_(options),
      first_fence_(first_fence),
      next_fence_(first_fence),
      trust_({options.attempts, options.lost_after * options.heartbeat, options.audit_share,
              options.reproducible}) {
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

void Scheduler::ForgetIfDone(RunId id) {
  const auto found = runs_.find(id);
  if (found == runs_.end()) return;
  const Run& run = found->second;
  if (run.acknowledged && run.fences.empty() && !run.audit) runs_.erase(found);
}

SchedulerOrders Scheduler::Decide(TimePoint now) {
  Advance(now);
  AssignChecks();
  if (listening_ >= next_check_) {
    next_check_ = listening_ + Duration(options_.heartbeat) / kChecksPerHeartbeat;
    for (auto& [id, worker] : workers_) {
      if (IsSilent(worker)) Lose(id, worker);
      if (trust_.RecordOf(id).black_hole()) List(id, worker);
    }
    Purge();
    for (const Place& place : std::set<Place>(failing_)) Judge(place.run);
    Assign();
    AssignCopies();
  }
  for (const RunId run : trust_.TakeUnjudged()) Judge(run);
  Assign();
  MoveWaiting();
  AssignAudits();
  orders_.reproducibility = trust_.reproducibility().TakeNews();
  return std::exchange(orders_, {});
}

bool Scheduler::Works(InstanceId worker) const {
  const auto found = workers_.find(worker);
  return found != workers_.end() && !found->second.live.empty();
}

bool Scheduler::Connected(InstanceId worker) const {
  const auto found = workers_.find(worker);
  return found != workers_.end() && !found->second.lost;
}

std::uint32_t Scheduler::LeasesOf(RunId run) const {
  const auto found = runs_.find(run);
  return found == runs_.end() ? 0 : found->second.leases;
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
    statistics.slots += static_cast<int>(worker.slots);
    if (!worker.live.empty()) ++statistics.busy;
    if (trust_.RecordOf(id).quarantined) ++statistics.quarantined;
  }
  return statistics;
}

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
    view.record = trust_.RecordOf(id);
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

bool Scheduler::AllQuarantined() const {
  const auto connected = [](const auto& worker) { return !worker.second.lost && !worker.second.draining; };
  return std::ranges::any_of(workers_, connected) && std::ranges::all_of(workers_, [&](const auto& worker) {
           return !connected(worker) || trust_.RecordOf(worker.first).quarantined;
         });
}

}  // namespace gauntlet
