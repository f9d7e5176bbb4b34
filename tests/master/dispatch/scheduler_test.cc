// Leases, answers, failures.
// Covers: master/dispatch/leases/lease_answers.cc, master/dispatch/leases/lease_assignment.cc
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <set>

#include "tests/master/dispatch/scheduler_fixture.h"

namespace gauntlet {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;
using testing::SizeIs;

const proto::RunnerFailure kKill{proto::FailureKind::kExternal, 9, 0};

TEST_F(SchedulerTest, LeasesRunsInLogicalOrderWithGrowingFences) {
  scheduler_.Submit({3, "spec"});
  scheduler_.Submit({1, "spec"});
  scheduler_.Submit({2, "spec"});
  Join(10, 2);
  const SchedulerOrders orders = Decide();
  EXPECT_THAT(RunsOf(orders), ElementsAre(1, 2));
  EXPECT_EQ(orders.leases[0].lease.fence, kFirstFence);
  EXPECT_EQ(orders.leases[1].lease.fence, kFirstFence + 1);
  EXPECT_EQ(orders.leases[0].worker, 10U);
  EXPECT_EQ(orders.leases[0].lease.attempt, 1U);
  EXPECT_EQ(scheduler_.queued(), 1U);
}

TEST_F(SchedulerTest, AResultMakesRoomForTheNextRun) {
  SubmitRuns(1, 2);
  Join(10);
  const SchedulerOrders orders = Decide();
  EXPECT_EQ(scheduler_.Completed(10, orders.leases[0].lease.fence, 1, 111), Answer::kAccepted);
  EXPECT_THAT(RunsOf(Decide()), ElementsAre(2));
}

TEST_F(SchedulerTest, AcknowledgesAResultWhenItIsStoredAndForgetsTheRun) {
  const Fence fence = LeaseRun1To(10);
  EXPECT_EQ(scheduler_.Completed(10, fence, 1, 111), Answer::kAccepted);
  EXPECT_EQ(scheduler_.Completed(10, fence, 1, 111), Answer::kRepeated);
  EXPECT_THAT(Decide().acknowledgements, IsEmpty());
  scheduler_.Acknowledge(1);
  const SchedulerOrders orders = Decide();
  EXPECT_THAT(FencesOf(orders.acknowledgements), ElementsAre(fence));
  EXPECT_EQ(scheduler_.LeasesOf(1), 0U);
  EXPECT_EQ(scheduler_.Statistics().duplicates, 0U);
}

TEST_F(SchedulerTest, AcknowledgesAgainWhatAWorkerStillHolds) {
  const Fence fence = LeaseRun1To(10);
  scheduler_.Completed(10, fence, 1, 111);
  scheduler_.WorkerHeartbeat(10, {fence}, clock_.Now());
  EXPECT_THAT(Decide().acknowledgements, IsEmpty()) << "not stored yet";
  scheduler_.Acknowledge(1);
  Decide();
  scheduler_.WorkerHeartbeat(10, {fence}, clock_.Now());
  EXPECT_THAT(FencesOf(Decide().acknowledgements), ElementsAre(fence));
}

// scheduler_trust_test.cc has more workers than one.
TEST_F(SchedulerTest, ThreeOwnFailuresGiveUpTheRun) {
  SubmitRuns(1, 2);
  Join(10);
  EXPECT_EQ(scheduler_.Completed(10, Decide().leases.at(0).lease.fence, 1, 111), Answer::kAccepted);
  scheduler_.Acknowledge(1);
  const proto::RunnerFailure crash{proto::FailureKind::kCrashed, 11, 0};
  for (int attempt = 1; attempt <= 2; ++attempt) {
    const SchedulerOrders orders = Decide();
    ASSERT_THAT(orders.leases, SizeIs(1));
    EXPECT_THAT(orders.given_up, IsEmpty());
    EXPECT_EQ(scheduler_.Failed(10, orders.leases[0].lease.fence, 2, crash), Answer::kAccepted);
  }
  const Fence last = Decide().leases.at(0).lease.fence;
  scheduler_.Failed(10, last, 2, {proto::FailureKind::kHung, 0, 0});
  const SchedulerOrders orders = Decide();
  ASSERT_THAT(orders.given_up, SizeIs(1));
  EXPECT_EQ(orders.given_up[0].failure, crash) << "it is told most often";
  EXPECT_EQ(orders.given_up[0].alike, 2U);
  EXPECT_EQ(orders.given_up[0].attempts, 3U);
  EXPECT_EQ(orders.given_up[0].leases, 3U);
  EXPECT_THAT(FencesOf(orders.acknowledgements), ElementsAre(last));
  EXPECT_THAT(orders.leases, IsEmpty());
  scheduler_.Acknowledge(2);
  EXPECT_EQ(scheduler_.LeasesOf(2), 0U);
}

TEST_F(SchedulerTest, WhatIsGivenBackAndLostWorkersAreNoAttempts) {
  SubmitRuns(1, 1);
  for (InstanceId worker = 10; worker < 20; ++worker) {
    Join(worker);
    const Fence fence = Decide().leases.at(0).lease.fence;
    EXPECT_EQ(scheduler_.Failed(worker, fence, 1, {proto::FailureKind::kExternal, 0, 0}), Answer::kAccepted);
    EXPECT_THAT(Decide().leases, SizeIs(1));
    scheduler_.WorkerDied(worker);
  }
  Join(20);
  const SchedulerOrders orders = Decide();
  EXPECT_THAT(orders.given_up, IsEmpty());
  EXPECT_EQ(orders.leases.at(0).lease.attempt, 21U);
  EXPECT_EQ(scheduler_.Completed(20, orders.leases[0].lease.fence, 1, 111), Answer::kAccepted);
}

// A batch system that ends a job kills its runs first and then the worker, or tells it to leave.
TEST_F(SchedulerTest, ARunThatWasKilledWithItsWorkerIsNoAttempt) {
  SubmitRuns(1, 1);
  for (InstanceId worker = 10; worker < 20; ++worker) {
    Join(worker);
    const Fence fence = Decide().leases.at(0).lease.fence;
    EXPECT_EQ(scheduler_.Failed(worker, fence, 1, kKill), Answer::kAccepted);
    EXPECT_THAT(Decide().leases, IsEmpty()) << "it waits a second";
    EXPECT_TRUE(worker % 2 == 0 ? scheduler_.WorkerDied(worker) : scheduler_.WorkerDraining(worker));
  }
  Join(20);
  const SchedulerOrders orders = Decide();
  EXPECT_THAT(orders.given_up, IsEmpty());
  EXPECT_THAT(orders.leases, SizeIs(1));
}

TEST_F(SchedulerTest, ARunThatIsAlwaysKilledWaitsLongerEachTimeAndEndsWithAVerdict) {
  SubmitRuns(1, 1);
  for (const InstanceId worker : {10U, 11U, 12U}) Join(worker);
  for (const InstanceId worker : {10U, 11U, 12U}) BringAResult(worker);
  SchedulerOrders orders = Decide();
  std::set<InstanceId> asked;
  for (const int wait : {1, 2, 4}) {
    ASSERT_THAT(orders.leases, SizeIs(1));
    asked.insert(orders.leases[0].worker);
    scheduler_.Failed(orders.leases[0].worker, orders.leases[0].lease.fence, 1, kKill);
    const auto early = PassTime(std::chrono::milliseconds(1000 * wait - 250), {10, 11, 12});
    EXPECT_THAT(early.leases, IsEmpty());
    EXPECT_THAT(early.given_up, IsEmpty());
    orders = PassTime(std::chrono::milliseconds(500), {10, 11, 12});
  }
  EXPECT_THAT(asked, SizeIs(3));
  ASSERT_THAT(orders.given_up, SizeIs(1));
  EXPECT_EQ(orders.given_up[0].failure, kKill);
  EXPECT_EQ(orders.given_up[0].workers, 3U);
}

TEST_F(SchedulerTest, AWorkerThatOnlyGivesBackIsSlowedAndQuarantined) {
  SubmitRuns(1, 1);
  Join(10);
  bool quarantined = false;
  int leases = 0;
  for (int i = 0; i < 5000 && !quarantined; ++i) {
    const SchedulerOrders orders = Decide();
    quarantined = !orders.quarantined.empty();
    for (const LeaseOrder& order : orders.leases) {
      ++leases;
      scheduler_.Failed(10, order.lease.fence, 1, {proto::FailureKind::kExternal, 0, 0});
    }
  }
  EXPECT_TRUE(quarantined);
  EXPECT_EQ(leases, 1024);
}

TEST_F(SchedulerTest, AnotherWorkersLeaseOrAnotherRunIsRejected) {
  SubmitRuns(1, 2);
  Join(10);
  const Fence fence = Decide().leases[0].lease.fence;
  Join(11);
  Decide();
  EXPECT_EQ(scheduler_.Completed(11, fence, 1, 111), Answer::kRejected);
  EXPECT_EQ(scheduler_.Failed(11, fence, 1, {proto::FailureKind::kCrashed, 11, 0}), Answer::kRejected);
  EXPECT_EQ(scheduler_.Completed(10, fence, 2, 111), Answer::kRejected) << "and its lease has ended";
  EXPECT_EQ(scheduler_.unfinished(), 2U);
}

TEST_F(SchedulerTest, AFenceThatWasNeverGivenIsUnwanted) {
  LeaseRun1To(10);
  EXPECT_EQ(scheduler_.Completed(10, kFirstFence + 99, 1, 111), Answer::kUnwanted);
  EXPECT_EQ(scheduler_.unfinished(), 1U);
}

TEST_F(SchedulerTest, ADrainingWorkerGetsNothingNewAndMayFinish) {
  SubmitRuns(1, 2);
  Join(10);
  const Fence fence = Decide().leases[0].lease.fence;
  scheduler_.WorkerDraining(10);
  EXPECT_EQ(scheduler_.Completed(10, fence, 1, 111), Answer::kAccepted);
  EXPECT_THAT(Decide().leases, IsEmpty());
  EXPECT_EQ(scheduler_.queued(), 1U);
}

TEST_F(SchedulerTest, AnUndeliveredLeaseGoesElsewhereAndIsNoAttempt) {
  SubmitRuns(1, 1);
  Join(10);
  scheduler_.Undelivered(Decide().leases[0].lease.fence);
  EXPECT_THAT(Decide().leases, IsEmpty()) << "the worker is not tried again before it is heard of";
  Join(11);
  const SchedulerOrders orders = Decide();
  EXPECT_EQ(orders.leases.at(0).worker, 11U);
  EXPECT_EQ(orders.leases[0].lease.attempt, 1U);
}

TEST_F(SchedulerTest, StopLeasingLeavesRunsInTheQueue) {
  SubmitRuns(1, 1);
  scheduler_.StopLeasing();
  Join(10);
  EXPECT_THAT(Decide().leases, IsEmpty());
  EXPECT_EQ(scheduler_.queued(), 1U);
}

}  // namespace
}  // namespace gauntlet
