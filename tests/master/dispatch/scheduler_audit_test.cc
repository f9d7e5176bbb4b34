// Runs that a second worker simulates too.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/master/dispatch/scheduler_fixture.h"

namespace gauntlet {
namespace {

using testing::UnorderedElementsAre;

class SchedulerAuditTest : public SchedulerTest {
 protected:
  SchedulerAuditTest() {
    DispatchOptions options = LeaseOptions();
    options.audit_share = 1.0;
    scheduler_ = Scheduler(options, kFirstFence);
  }
  // Run 1 is answered by `worker` and stored.
  void FinishRun1(InstanceId worker) {
    SubmitRuns(1, 1);
    const SchedulerOrders orders = Decide();
    ASSERT_EQ(orders.leases.size(), 1U);
    ASSERT_EQ(orders.leases[0].worker, worker);
    ASSERT_EQ(scheduler_.Completed(worker, orders.leases[0].lease.fence, 1, 55), Answer::kAccepted);
    scheduler_.Acknowledge(1);
  }
};

TEST_F(SchedulerAuditTest, AnotherWorkerSimulatesTheRunOnceMore) {
  Join(1);
  FinishRun1(1);
  Join(2);
  const SchedulerOrders audit = Decide();
  ASSERT_EQ(audit.leases.size(), 1U);
  EXPECT_EQ(audit.leases[0].worker, 2U);
  EXPECT_EQ(scheduler_.Statistics().audits_open, 1U);
  EXPECT_EQ(audit.leases[0].lease.spec, "spec") << "it is kept as long";
  EXPECT_EQ(scheduler_.Completed(2, audit.leases[0].lease.fence, 1, 55), Answer::kDuplicate);
  EXPECT_TRUE(Decide().mismatches.empty());
  EXPECT_EQ(scheduler_.Statistics().audits, 1U);
  EXPECT_EQ(scheduler_.Statistics().audits_open, 0U);
  EXPECT_EQ(scheduler_.LeasesOf(1), 0U);
}

TEST_F(SchedulerAuditTest, ADifferenceNamesBothWorkers) {
  Join(1);
  FinishRun1(1);
  Join(2);
  const SchedulerOrders audit = Decide();
  ASSERT_EQ(audit.leases.size(), 1U);
  scheduler_.Completed(2, audit.leases[0].lease.fence, 1, 56);
  const SchedulerOrders orders = Decide();
  ASSERT_EQ(orders.mismatches.size(), 1U);
  EXPECT_EQ(orders.mismatches[0].first_worker, 1U);
  EXPECT_EQ(orders.mismatches[0].second_worker, 2U);
  EXPECT_EQ(orders.mismatches[0].first_hash, 55U);
  EXPECT_EQ(orders.mismatches[0].second_hash, 56U);
}

TEST_F(SchedulerAuditTest, AnOnlyWorkerAuditsItself) {
  Join(1);
  FinishRun1(1);
  const SchedulerOrders audit = Decide();
  ASSERT_EQ(audit.leases.size(), 1U);
  EXPECT_EQ(scheduler_.Completed(1, audit.leases[0].lease.fence, 1, 55), Answer::kDuplicate);
  EXPECT_EQ(scheduler_.Statistics().audits, 1U);
  EXPECT_EQ(scheduler_.Statistics().audits_alone, 1U);
}

TEST_F(SchedulerAuditTest, GoesToAnotherWorkerThatJoinsWhileTheOnlyOneAuditsItself) {
  Join(1);
  FinishRun1(1);
  const SchedulerOrders own = Decide();
  ASSERT_EQ(own.leases.size(), 1U);
  Join(2);
  EXPECT_EQ(scheduler_.Completed(1, own.leases[0].lease.fence, 1, 55), Answer::kDuplicate);
  EXPECT_EQ(scheduler_.Statistics().audits_open, 1U);
  const SchedulerOrders audit = Decide();
  ASSERT_EQ(audit.leases.size(), 1U);
  EXPECT_EQ(audit.leases[0].worker, 2U);
  scheduler_.Completed(2, audit.leases[0].lease.fence, 1, 55);
  EXPECT_EQ(scheduler_.Statistics().audits_open, 0U);
  EXPECT_EQ(scheduler_.Statistics().audits_alone, 0U);
}

TEST_F(SchedulerAuditTest, OutlivesTheWorkerThatDoesIt) {
  Join(1);
  FinishRun1(1);
  Join(2);
  ASSERT_EQ(Decide().leases.size(), 1U);
  scheduler_.WorkerDied(2);
  Join(3);
  const SchedulerOrders again = Decide();
  ASSERT_EQ(again.leases.size(), 1U);
  EXPECT_EQ(again.leases[0].worker, 3U);
}

TEST_F(SchedulerAuditTest, RunsThatWaitGoFirst) {
  Join(1);
  FinishRun1(1);
  Join(2);
  SubmitRuns(2, 3);
  EXPECT_THAT(RunsOf(Decide()), UnorderedElementsAre(2, 3));
}

TEST_F(SchedulerAuditTest, CountsAsADifferenceWhenItFailsAsOftenAsAVerdictTakes) {
  Join(1);
  FinishRun1(1);
  Join(2);
  for (int attempt = 1; attempt <= 3; ++attempt) {
    const SchedulerOrders audit = Decide();
    ASSERT_EQ(audit.leases.size(), 1U) << attempt;
    EXPECT_TRUE(audit.mismatches.empty());
    scheduler_.Failed(2, audit.leases[0].lease.fence, 1, {proto::FailureKind::kCrashed, 11, 0});
  }
  const SchedulerOrders orders = Decide();
  ASSERT_EQ(orders.mismatches.size(), 1U);
  EXPECT_EQ(orders.mismatches[0].second_hash, 0U);
  EXPECT_EQ(scheduler_.Statistics().audits_open, 0U);
}

TEST_F(SchedulerTest, AuditsTheShareThatWasAskedFor) {
  DispatchOptions options = LeaseOptions();
  options.audit_share = 0.1;
  scheduler_ = Scheduler(options, kFirstFence);
  Join(1);
  for (RunId run = 1; run <= 1000; ++run) {
    SubmitRuns(run, run);
    // The run, then perhaps its audit.
    for (int round = 0; round < 2; ++round) {
      for (const LeaseOrder& order : Decide().leases)
        scheduler_.Completed(1, order.lease.fence, order.lease.run_id, run);
    }
  }
  EXPECT_NEAR(static_cast<double>(scheduler_.Statistics().audits), 100.0, 30.0);
}

}  // namespace
}  // namespace gauntlet
