// A scheduler with a clock set by hand, and what tests do with it.
#pragma once

#include <gtest/gtest.h>

#include <vector>

#include "master/dispatch/leases/scheduler.h"
#include "tests/support/fake_clock.h"

namespace gauntlet {

inline constexpr Fence kFirstFence = 7ULL << 32;

inline DispatchOptions LeaseOptions(std::uint32_t credit = 1) {
  DispatchOptions options;
  options.credit = credit;
  options.many_waiting = 1'000'000;  // never so many: nothing is batched
  return options;
}

class SchedulerTest : public testing::Test {
 protected:
  SchedulerOrders Decide() { return scheduler_.Decide(clock_.Now()); }
  void Join(InstanceId worker, std::uint32_t slots = 1, const std::vector<Fence>& held = {}) {
    scheduler_.WorkerJoined(worker, slots, held, clock_.Now());
  }
  void SubmitRuns(RunId first, RunId last) {
    for (RunId run = first; run <= last; ++run) scheduler_.Submit({run, "spec"});
  }
  // It brings the result of a run that an earlier master had leased to it: from now on it has shown that it
  // can work.
  void BringAResult(InstanceId worker) {
    const RunId run = next_proof_++;
    scheduler_.Submit({run, "spec"});
    EXPECT_EQ(scheduler_.Completed(worker, run, run, 1), Answer::kAccepted);
    scheduler_.Acknowledge(run);
  }
  // Run 1 is submitted, and leased to this worker.
  Fence LeaseRun1To(InstanceId worker) {
    SubmitRuns(1, 1);
    Join(worker);
    return Decide().leases.at(0).lease.fence;
  }
  // The same; worker 10 dies, and worker 11 gets the run.
  struct TwoLeases {
    Fence first;
    Fence second;
  };
  TwoLeases LeaseRun1To10AndThenTo11() {
    const Fence first = LeaseRun1To(10);
    Join(11);
    scheduler_.WorkerDied(10);
    return {first, Decide().leases.at(0).lease.fence};
  }
  // Lets time pass while these workers, holding nothing in particular, send heartbeats.
  SchedulerOrders PassTime(std::chrono::milliseconds time, const std::vector<InstanceId>& alive) {
    SchedulerOrders all;
    for (std::chrono::milliseconds passed{0}; passed < time; passed += std::chrono::milliseconds(250)) {
      clock_.Advance(std::chrono::milliseconds(250));
      for (const InstanceId worker : alive) scheduler_.WorkerHeard(worker, clock_.Now());
      SchedulerOrders orders = Decide();
      for (auto& lost : orders.lost) all.lost.push_back(lost);
      for (auto& lease : orders.leases) all.leases.push_back(lease);
      for (auto& run : orders.given_up) all.given_up.push_back(run);
      for (auto& forgotten : orders.forgotten) all.forgotten.push_back(forgotten);
    }
    return all;
  }
  static std::vector<RunId> RunsOf(const SchedulerOrders& orders) {
    std::vector<RunId> runs;
    for (const LeaseOrder& order : orders.leases) runs.push_back(order.lease.run_id);
    return runs;
  }
  static std::vector<Fence> FencesOf(const std::vector<FenceOrder>& orders) {
    std::vector<Fence> fences;
    for (const FenceOrder& order : orders) fences.push_back(order.fence);
    return fences;
  }

  testing_support::FakeClock clock_;
  Scheduler scheduler_{LeaseOptions(), kFirstFence};
  RunId next_proof_ = 1'000'000;
};

}  // namespace gauntlet
