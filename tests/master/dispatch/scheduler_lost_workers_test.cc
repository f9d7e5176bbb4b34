// Workers that vanish, come back, and answer late.
// Covers: master/dispatch/leases/lease_expiry.cc
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/master/dispatch/scheduler_fixture.h"

namespace gauntlet {
namespace {

using std::chrono::milliseconds;
using std::chrono::minutes;
using std::chrono::seconds;
using testing::ElementsAre;
using testing::IsEmpty;
using testing::SizeIs;

TEST_F(SchedulerTest, LosesAWorkerWithinThreeSilentHeartbeatsAndLeasesItsRunsElsewhere) {
  const Fence first = LeaseRun1To(10);
  Join(11);
  EXPECT_THAT(PassTime(milliseconds(2750), {11}).lost, IsEmpty());
  const SchedulerOrders orders = PassTime(milliseconds(250), {11});
  ASSERT_THAT(orders.lost, SizeIs(1));
  EXPECT_EQ(orders.lost[0].worker, 10U);
  EXPECT_THAT(orders.lost[0].released, ElementsAre(1));
  ASSERT_THAT(orders.leases, SizeIs(1));
  EXPECT_EQ(orders.leases[0].worker, 11U);
  EXPECT_EQ(orders.leases[0].lease.attempt, 2U);
  EXPECT_GT(orders.leases[0].lease.fence, first);
  const WorkerStatistics statistics = scheduler_.Statistics();
  EXPECT_EQ(statistics.lost, 1);
  EXPECT_EQ(statistics.releases, 1U);
  EXPECT_EQ(statistics.connected, 1);
}

// It was told to be heard seldom.
TEST_F(SchedulerTest, SilenceIsJudgedByThePaceThatAWorkerWasTold) {
  LeaseRun1To(10);
  scheduler_.WorkerPaced(10, seconds(4));
  EXPECT_THAT(PassTime(milliseconds(11750), {}).lost, IsEmpty());
  EXPECT_THAT(PassTime(milliseconds(250), {}).lost, SizeIs(1));
}

// A starving worker of this machine is excused again and again, but not for ever.
TEST_F(SchedulerTest, AnExcusedWorkerMayBeSilentTenTimesAsLong) {
  LeaseRun1To(10);
  milliseconds silent(0);
  while (silent < minutes(2)) {
    clock_.Advance(milliseconds(250));
    silent += milliseconds(250);
    for (const InstanceId id : scheduler_.Silent(clock_.Now())) scheduler_.Excuse(id);
    if (!Decide().lost.empty()) break;
  }
  EXPECT_GE(silent, seconds(30));
  EXPECT_LE(silent, seconds(34));
}

TEST_F(SchedulerTest, AMasterThatWasFrozenTakesNobodyForLost) {
  LeaseRun1To(10);
  clock_.Advance(minutes(10));
  EXPECT_THAT(Decide().lost, IsEmpty());
  scheduler_.WorkerHeard(10, clock_.Now());
  EXPECT_THAT(PassTime(seconds(2), {}).lost, IsEmpty());
}

TEST_F(SchedulerTest, ADeadProcessIsLostAtOnce) {
  LeaseRun1To(10);
  Join(11);
  EXPECT_TRUE(scheduler_.WorkerDied(10));
  const SchedulerOrders orders = Decide();
  EXPECT_THAT(orders.lost, SizeIs(1));
  EXPECT_EQ(orders.leases.at(0).worker, 11U);
}

TEST_F(SchedulerTest, ALateResultIsTakenAndTheOtherWorkerIsToldToStop) {
  const auto [late, second] = LeaseRun1To10AndThenTo11();
  EXPECT_EQ(scheduler_.Completed(10, late, 1, 111), Answer::kAccepted);
  SchedulerOrders orders = Decide();
  ASSERT_THAT(FencesOf(orders.cancels), ElementsAre(second));
  EXPECT_EQ(orders.cancels[0].worker, 11U);
  EXPECT_EQ(scheduler_.unfinished(), 0U);
  scheduler_.Submit({2, "spec"});
  EXPECT_EQ(Decide().leases.at(0).worker, 11U) << "the cancelled lease no longer fills its slot";
}

TEST_F(SchedulerTest, ALateResultOfAQueuedRunTakesItOutOfTheQueue) {
  const Fence late = LeaseRun1To(10);
  scheduler_.WorkerDied(10);
  Decide();
  EXPECT_EQ(scheduler_.queued(), 1U);
  EXPECT_EQ(scheduler_.Completed(10, late, 1, 111), Answer::kAccepted);
  EXPECT_EQ(scheduler_.queued(), 0U);
  Join(11);
  EXPECT_THAT(Decide().leases, IsEmpty());
}

TEST_F(SchedulerTest, EqualDuplicatesAreCounted) {
  const auto [first, second] = LeaseRun1To10AndThenTo11();
  scheduler_.Completed(11, second, 1, 111);
  scheduler_.Acknowledge(1);
  Decide();
  EXPECT_EQ(scheduler_.Completed(10, first, 1, 111), Answer::kDuplicate);
  const SchedulerOrders orders = Decide();
  EXPECT_THAT(orders.mismatches, IsEmpty());
  EXPECT_THAT(FencesOf(orders.acknowledgements), ElementsAre(first));
  EXPECT_EQ(scheduler_.Statistics().duplicates, 1U);
  EXPECT_EQ(scheduler_.LeasesOf(1), 0U);
}

TEST_F(SchedulerTest, DifferentDuplicatesNameBothWorkers) {
  const auto [first, second] = LeaseRun1To10AndThenTo11();
  scheduler_.Completed(11, second, 1, 111);
  EXPECT_EQ(scheduler_.Completed(10, first, 1, 222), Answer::kDuplicate);
  const SchedulerOrders orders = Decide();
  ASSERT_THAT(orders.mismatches, SizeIs(1));
  EXPECT_EQ(orders.mismatches[0].run, 1U);
  EXPECT_EQ(orders.mismatches[0].first_worker, 11U);
  EXPECT_EQ(orders.mismatches[0].second_worker, 10U);
  EXPECT_EQ(orders.mismatches[0].first_hash, 111U);
  EXPECT_EQ(orders.mismatches[0].second_hash, 222U);
  EXPECT_EQ(scheduler_.Statistics().nondeterministic, 1U);
}

TEST_F(SchedulerTest, AResultLeasedByAnEarlierMasterIsTaken) {
  SubmitRuns(1, 1);
  const Fence old = (3ULL << 32) + 5;
  Join(10, 1, {old});
  const SchedulerOrders orders = Decide();
  EXPECT_THAT(orders.acknowledgements, IsEmpty()) << "it may bring a result";
  EXPECT_EQ(scheduler_.Completed(10, old, 1, 111), Answer::kAccepted);
  EXPECT_THAT(FencesOf(Decide().cancels), ElementsAre(orders.leases.at(0).lease.fence));
  scheduler_.Acknowledge(1);
  EXPECT_THAT(FencesOf(Decide().acknowledgements), ElementsAre(old));
}

TEST_F(SchedulerTest, AReturningWorkerKeepsTheRunThatNobodyElseHas) {
  const Fence fence = LeaseRun1To(10);
  scheduler_.WorkerDied(10);
  EXPECT_THAT(Decide().lost, SizeIs(1));
  scheduler_.WorkerHeartbeat(10, {fence}, clock_.Now());
  Join(11);
  SchedulerOrders orders = Decide();
  EXPECT_THAT(orders.leases, IsEmpty());
  EXPECT_THAT(orders.cancels, IsEmpty());
  EXPECT_EQ(scheduler_.Completed(10, fence, 1, 111), Answer::kAccepted);
}

TEST_F(SchedulerTest, OfAReturningWorkerAndTheOneThatGotItsRunTheFirstToAnswerCounts) {
  for (const InstanceId first : {10, 11}) {
    SCOPED_TRACE(first);
    scheduler_ = Scheduler(LeaseOptions(), kFirstFence);
    const auto [old_fence, new_fence] = LeaseRun1To10AndThenTo11();
    scheduler_.WorkerHeartbeat(10, {old_fence}, clock_.Now());
    EXPECT_THAT(Decide().cancels, IsEmpty()) << "both go on";
    EXPECT_EQ(scheduler_.Completed(first, first == 10 ? old_fence : new_fence, 1, 111), Answer::kAccepted);
    const SchedulerOrders orders = Decide();
    ASSERT_THAT(FencesOf(orders.cancels), ElementsAre(first == 10 ? new_fence : old_fence));
    EXPECT_EQ(orders.cancels[0].worker, first == 10 ? 11U : 10U);
    EXPECT_EQ(scheduler_.unfinished(), 0U);
  }
}

TEST_F(SchedulerTest, AReturningWorkerIsToldToDropARunThatHasFinishedElsewhere) {
  const auto [fence, new_fence] = LeaseRun1To10AndThenTo11();
  EXPECT_EQ(scheduler_.Completed(11, new_fence, 1, 111), Answer::kAccepted);
  scheduler_.WorkerHeartbeat(10, {fence}, clock_.Now());
  const SchedulerOrders orders = Decide();
  ASSERT_THAT(FencesOf(orders.cancels), ElementsAre(fence));
  EXPECT_EQ(orders.cancels[0].worker, 10U);
}

TEST_F(SchedulerTest, ALeaseThatAReconnectedWorkerDoesNotHoldIsGivenAgain) {
  const Fence fence = LeaseRun1To(10);
  Join(10, 1, {});
  const SchedulerOrders orders = Decide();
  EXPECT_THAT(RunsOf(orders), ElementsAre(1));
  EXPECT_GT(orders.leases[0].lease.fence, fence);
}

TEST_F(SchedulerTest, ALeaseThatCrossedAHeartbeatIsNotTakenBackButALostOneIs) {
  LeaseRun1To(10);
  scheduler_.WorkerHeartbeat(10, {}, clock_.Now());
  EXPECT_THAT(Decide().leases, IsEmpty());
  PassTime(seconds(8), {10});
  scheduler_.WorkerHeartbeat(10, {}, clock_.Now());
  EXPECT_THAT(Decide().leases, IsEmpty());
  PassTime(seconds(2), {10});
  scheduler_.WorkerHeartbeat(10, {}, clock_.Now());
  EXPECT_THAT(RunsOf(Decide()), ElementsAre(1));
}

TEST_F(SchedulerTest, AGoodbyeReleasesItsRunsWithoutCountingALoss) {
  LeaseRun1To(10);
  EXPECT_TRUE(scheduler_.WorkerLeft(10));
  EXPECT_FALSE(scheduler_.WorkerHeard(10, clock_.Now()));
  Join(11);
  EXPECT_THAT(RunsOf(Decide()), ElementsAre(1));
  EXPECT_EQ(scheduler_.Statistics().lost, 0);
}

TEST_F(SchedulerTest, VanishedWorkersAndUnansweredLeasesAreForgottenInTime) {
  LeaseRun1To(10);
  Join(11);
  scheduler_.WorkerDied(10);
  scheduler_.Completed(11, Decide().leases.at(0).lease.fence, 1, 111);
  scheduler_.Acknowledge(1);
  EXPECT_THAT(PassTime(minutes(14), {11}).forgotten, IsEmpty());
  EXPECT_GT(scheduler_.LeasesOf(1), 0U) << "a late result would be compared";
  EXPECT_THAT(PassTime(minutes(2), {11}).forgotten, ElementsAre(10));
  EXPECT_EQ(scheduler_.LeasesOf(1), 0U);
  EXPECT_FALSE(scheduler_.Known(10));
}

}  // namespace
}  // namespace gauntlet
