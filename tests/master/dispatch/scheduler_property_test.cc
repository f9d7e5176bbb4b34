// The scheduler against a model of a bad world: workers appear, die, freeze, wake up, lose messages, answer
// late, twice and out of order, silent ones are excused, and time jumps.
#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <map>
#include <optional>
#include <set>
#include <vector>

#include "master/dispatch/leases/scheduler.h"
#include "tests/support/fake_clock.h"

namespace gauntlet {
namespace {

using std::chrono::milliseconds;

std::uint64_t HashOfRun(RunId run) {
  return run * 0x9e3779b97f4a7c15ULL + 1;
}

// What a worker process knows.
struct ModelWorker {
  bool alive = true;
  bool frozen = false;
  bool draining = false;
  std::map<Fence, RunId> leases;   // works on
  std::map<Fence, RunId> results;  // finished, not acknowledged
};

class World {
 public:
  World(std::uint32_t credit, double audit_share, Reproducible known)
      : known_(known),
        audits_(audit_share > 0.0),
        scheduler_(Options(credit, audit_share, known), 1ULL << 32) {}

  static DispatchOptions Options(std::uint32_t credit, double audit_share, Reproducible known) {
    DispatchOptions options;
    options.reproducible = known;
    options.credit = credit;
    options.audit_share = audit_share;
    return options;
  }

  void Submit() {
    if (*rc::gen::arbitrary<bool>()) scheduler_.BeginBatch();
    scheduler_.Submit({++last_run_, "spec", static_cast<double>(*rc::gen::inRange(0, 3))});
    expected_.insert(last_run_);
  }

  void Appear() {
    const InstanceId id = next_worker_++;
    workers_[id];
    scheduler_.WorkerJoined(id, *rc::gen::inRange<std::uint32_t>(1, 4), {}, clock_.Now());
  }

  void Die(bool noticed) {
    if (auto* worker = Pick([](const ModelWorker& w) { return w.alive; })) {
      worker->second.alive = false;
      if (noticed) scheduler_.WorkerDied(worker->first);
    }
  }

  void Freeze() {
    if (auto* worker = Pick([](const ModelWorker& w) { return w.alive && !w.frozen; })) {
      worker->second.frozen = true;
    }
  }

  void Wake() {
    if (auto* worker = Pick([](const ModelWorker& w) { return w.alive && w.frozen; })) {
      worker->second.frozen = false;
      // The long-forgotten say hello again, as after a reconnect.
      if (!scheduler_.Known(worker->first) || *rc::gen::arbitrary<bool>()) Hello(*worker);
    }
  }

  void Leave() {
    if (auto* worker = Pick(Runs)) {
      worker->second.alive = false;
      scheduler_.WorkerLeft(worker->first);
    }
  }

  void Drain() {
    if (auto* worker = Pick(Runs)) {
      worker->second.draining = true;
      scheduler_.WorkerDraining(worker->first);
    }
  }

  // Some lease of some worker ends with a result, which is sent.
  void Answer() {
    auto* worker = Pick([](const ModelWorker& w) { return Runs(w) && !w.leases.empty(); });
    if (worker == nullptr) return;
    const auto [fence, run] = Take(worker->second.leases);
    worker->second.results.emplace(fence, run);
    if (*rc::gen::arbitrary<bool>()) SendResult(worker->first, fence, run);  // or it is lost on the way
  }

  // Any held result is sent (again).
  void Resend() {
    auto* worker = Pick([](const ModelWorker& w) { return Runs(w) && !w.results.empty(); });
    if (worker == nullptr) return;
    const auto result = AnyOf(worker->second.results);
    SendResult(worker->first, result.first, result.second);
  }

  void Fail(proto::FailureKind kind) {
    auto* worker = Pick([](const ModelWorker& w) { return Runs(w) && !w.leases.empty(); });
    if (worker == nullptr) return;
    const auto [fence, run] = Take(worker->second.leases);
    ++failures_[run];  // at most: an end from outside speaks against the run only if its worker stays
    scheduler_.Failed(worker->first, fence, run, {kind, 11, 0});
  }

  // The worker has lost track of a lease (it never arrived).
  void LoseLease() {
    auto* worker = Pick([](const ModelWorker& w) { return Runs(w) && !w.leases.empty(); });
    if (worker != nullptr) Take(worker->second.leases);
  }

  void Forge() {
    auto* worker = Pick(Runs);
    if (worker == nullptr || last_run_ == 0) return;
    const Fence fence = (1ULL << 32) + *rc::gen::inRange<Fence>(0, 50);
    const RunId run = *rc::gen::inRange<RunId>(1, last_run_ + 1);
    if (worker->second.leases.contains(fence) || worker->second.results.contains(fence)) return;
    const auto before = scheduler_.unfinished();
    if (ever_leased_[fence].first == worker->first && ever_leased_[fence].second == run) return;
    const auto answer = scheduler_.Completed(worker->first, fence, run, HashOfRun(run));
    RC_ASSERT(answer != Answer::kAccepted);
    RC_ASSERT(scheduler_.unfinished() == before);
  }

  void Pass(milliseconds time) {
    clock_.Advance(time);
    Beat();
    Act();
  }

  void AcknowledgeSome() {
    std::vector<RunId> finished(unstored_.begin(), unstored_.end());
    for (const RunId run : finished) {
      if (!*rc::gen::arbitrary<bool>()) continue;
      unstored_.erase(run);
      scheduler_.Acknowledge(run);
    }
  }

  // Heartbeats of all that can send them.
  void Beat() {
    for (auto& [id, worker] : workers_) {
      if (!Runs(worker)) continue;
      if (!scheduler_.WorkerHeartbeat(id, HeldBy(worker), clock_.Now())) {
        scheduler_.WorkerJoined(id, 1, HeldBy(worker), clock_.Now());
      }
    }
  }

  void Act() {
    // Some of the silent are excused, dead ones among them.
    std::set<InstanceId> condemned;
    for (const InstanceId worker : scheduler_.Silent(clock_.Now())) {
      if (*rc::gen::arbitrary<bool>()) {
        scheduler_.Excuse(worker);
      } else {
        condemned.insert(worker);
      }
    }
    const SchedulerOrders orders = scheduler_.Decide(clock_.Now());
    for (const WorkerLost& lost : orders.lost) condemned.erase(lost.worker);
    RC_ASSERT(condemned.empty());
    std::set<InstanceId> blocked;
    for (const LeaseOrder& order : orders.leases) {
      RC_ASSERT(order.lease.fence > last_fence_);
      last_fence_ = order.lease.fence;
      RC_ASSERT(expected_.contains(order.lease.run_id));
      RC_ASSERT(!finished_.contains(order.lease.run_id) || audits_ || known_ == Reproducible::kUnknown);
      ever_leased_[order.lease.fence] = {order.worker, order.lease.run_id};
      ModelWorker& worker = workers_.at(order.worker);
      if (!worker.alive && *rc::gen::arbitrary<bool>()) {
        scheduler_.Undelivered(order.lease.fence);
      } else if (!healing_ && *rc::gen::inRange(0, 20) == 0) {
        // Lost on the way; the worker's heartbeats will tell.
      } else {
        worker.leases.emplace(order.lease.fence, order.lease.run_id);
      }
    }
    for (const FenceOrder& order : orders.acknowledgements) {
      const auto worker = workers_.find(order.worker);
      if (worker == workers_.end()) continue;
      worker->second.results.erase(order.fence);
    }
    for (const FenceOrder& order : orders.cancels) {
      const auto worker = workers_.find(order.worker);
      if (worker != workers_.end() && Runs(worker->second)) worker->second.leases.erase(order.fence);
    }
    for (const RunGivenUp& run : orders.given_up) {
      RC_ASSERT(failures_[run.run] >= (known_ == Reproducible::kPromised ? 3 : 1));
      End(run.run);
      given_up_.insert(run.run);
    }
    // Only a run that failed of itself may end in two ways.
    for (const ResultMismatch& mismatch : orders.mismatches) {
      RC_ASSERT(known_ == Reproducible::kPromised);
      RC_ASSERT(given_up_.contains(mismatch.run) ||
                (mismatch.second_hash == 0 && failures_[mismatch.run] >= 3));
    }
  }

  bool AllDone() const {
    return finished_.size() == expected_.size() && scheduler_.Statistics().audits_open == 0;
  }

  // From now on nothing bad happens, and one worker is healthy: everything must end.
  void Heal() {
    healing_ = true;
    for (auto& [id, worker] : workers_) worker.frozen = worker.draining = false;
    Appear();
    const InstanceId healthy = next_worker_ - 1;
    for (int round = 0; round < 5000 && !AllDone(); ++round) {
      clock_.Advance(milliseconds(200));
      Beat();
      Act();
      ModelWorker& worker = workers_.at(healthy);
      while (!worker.leases.empty()) {
        const auto [fence, run] = Take(worker.leases);
        worker.results.emplace(fence, run);
        SendResult(healthy, fence, run);
      }
      // The others keep what they have for ever, as busy workers with endless runs would, or die.
      if (round % 10 == 0) Die(true);
      if (!workers_.at(healthy).alive) {
        workers_.at(healthy).alive = true;
        scheduler_.WorkerHeartbeat(healthy, HeldBy(worker), clock_.Now());
      }
    }
    RC_ASSERT(finished_ == expected_);
    RC_ASSERT(scheduler_.Statistics().audits_open == 0U);
    for (const RunId run : unstored_) scheduler_.Acknowledge(run);
    RC_ASSERT(scheduler_.unfinished() == 0U);
    RC_ASSERT(scheduler_.queued() == 0U);
    // Nothing is remembered for ever.
    for (int i = 0; i < 2000; ++i) {
      clock_.Advance(milliseconds(1000));
      scheduler_.Decide(clock_.Now());
    }
    for (const RunId run : expected_) RC_ASSERT(scheduler_.LeasesOf(run) == 0U);
  }

 private:
  static bool Runs(const ModelWorker& worker) { return worker.alive && !worker.frozen; }

  template <typename Condition>
  std::pair<const InstanceId, ModelWorker>* Pick(const Condition& condition) {
    std::vector<std::pair<const InstanceId, ModelWorker>*> candidates;
    for (auto& entry : workers_) {
      if (condition(entry.second)) candidates.push_back(&entry);
    }
    if (candidates.empty()) return nullptr;
    return candidates[*rc::gen::inRange<std::size_t>(0, candidates.size())];
  }

  static std::pair<Fence, RunId> AnyOf(const std::map<Fence, RunId>& leases) {
    return *std::next(leases.begin(), *rc::gen::inRange<std::ptrdiff_t>(0, std::ssize(leases)));
  }
  std::pair<Fence, RunId> Take(std::map<Fence, RunId>& leases) const {
    std::pair<Fence, RunId> lease = *leases.begin();
    if (!healing_) lease = AnyOf(leases);
    leases.erase(lease.first);
    return lease;
  }

  static std::vector<Fence> HeldBy(const ModelWorker& worker) {
    std::vector<Fence> held;
    for (const auto& [fence, run] : worker.leases) held.push_back(fence);
    for (const auto& [fence, run] : worker.results) held.push_back(fence);
    return held;
  }

  void Hello(std::pair<const InstanceId, ModelWorker>& worker) {
    scheduler_.WorkerJoined(worker.first, 1, HeldBy(worker.second), clock_.Now());
  }

  void SendResult(InstanceId worker, Fence fence, RunId run) {
    if (scheduler_.Completed(worker, fence, run, HashOfRun(run)) == Answer::kAccepted) End(run);
    scheduler_.RunTook(0.3);
  }

  void End(RunId run) {
    RC_ASSERT(expected_.contains(run));
    RC_ASSERT(finished_.insert(run).second);  // none ends twice
    unstored_.insert(run);
  }

  Reproducible known_;
  bool audits_;
  testing_support::FakeClock clock_;
  Scheduler scheduler_;
  std::map<InstanceId, ModelWorker> workers_;
  InstanceId next_worker_ = 1;
  RunId last_run_ = 0;
  Fence last_fence_ = 0;
  bool healing_ = false;
  std::set<RunId> expected_;
  std::set<RunId> finished_;
  std::set<RunId> unstored_;
  std::set<RunId> given_up_;
  std::map<RunId, int> failures_;
  std::map<Fence, std::pair<InstanceId, RunId>> ever_leased_;
};

RC_GTEST_PROP(SchedulerProperty, NoRunIsLostNoneEndsTwiceAndAllEnd, ()) {
  const auto credit = *rc::gen::inRange<std::uint32_t>(1, 4);
  const auto audit_share = *rc::gen::element(0.0, 0.0, 0.5, 1.0);
  World world(credit, audit_share,
              *rc::gen::element(Reproducible::kPromised, Reproducible::kPromised, Reproducible::kUnknown,
                                Reproducible::kYes, Reproducible::kNo));
  const int steps = *rc::gen::inRange(1, 300);
  for (int step = 0; step < steps; ++step) {
    const int what = *rc::gen::inRange(0, 40);
    if (what < 8)
      world.Submit();
    else if (what < 10)
      world.Appear();
    else if (what < 11)
      world.Die(true);
    else if (what < 12)
      world.Die(false);
    else if (what < 13)
      world.Freeze();
    else if (what < 14)
      world.Wake();
    else if (what < 15)
      world.Leave();
    else if (what < 16)
      world.Drain();
    else if (what < 24)
      world.Answer();
    else if (what < 26)
      world.Resend();
    else if (what < 28)
      world.Fail(proto::FailureKind::kExternal);
    else if (what < 31)
      world.Fail(proto::FailureKind::kCrashed);
    else if (what < 32)
      world.LoseLease();
    else if (what < 33)
      world.Forge();
    else if (what < 35)
      world.AcknowledgeSome();
    else if (what < 39)
      world.Pass(milliseconds(*rc::gen::inRange(1, 1500)));
    else
      world.Pass(std::chrono::minutes(*rc::gen::inRange(1, 30)));
    if (*rc::gen::arbitrary<bool>()) world.Act();
  }
  world.Heal();
}

}  // namespace
}  // namespace gauntlet
