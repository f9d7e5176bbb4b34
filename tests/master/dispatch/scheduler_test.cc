#include "master/dispatch/scheduler.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

#include <algorithm>
#include <cmath>

#include "tests/master/dispatch/scheduler_fixture.h"

namespace gauntlet::master {
namespace {

using std::chrono::milliseconds;
using std::chrono::minutes;
using std::chrono::seconds;
using testing::ElementsAre;
using testing::IsEmpty;
using testing::SizeIs;
using testing::UnorderedElementsAre;

TEST_F(SchedulerTest, LeasesRunsInLogicalOrderWithGrowingFences) {
  scheduler_.Submit(3);
  scheduler_.Submit(1);
  scheduler_.Submit(2);
  Join(10, 2);
  const SchedulerOrders orders = Decide();
  EXPECT_THAT(RunsOf(orders), ElementsAre(1, 2));
  EXPECT_EQ(orders.leases[0].fence, kFirstFence);
  EXPECT_EQ(orders.leases[1].fence, kFirstFence + 1);
  EXPECT_EQ(orders.leases[0].worker, 10U);
  EXPECT_EQ(orders.leases[0].attempt, 1U);
  EXPECT_EQ(scheduler_.queued(), 1U);
}

TEST_F(SchedulerTest, FillsEverySlotBeforeItPrefetches) {
  scheduler_ = Scheduler(LeaseOptions(2), kFirstFence);
  SubmitRuns(1, 10);
  Join(10, 2);
  Join(11, 1);
  const SchedulerOrders orders = Decide();
  ASSERT_THAT(orders.leases, SizeIs(6));
  std::vector<InstanceId> first;
  for (std::size_t i = 0; i < 3; ++i) first.push_back(orders.leases[i].worker);
  EXPECT_THAT(first, UnorderedElementsAre(10, 10, 11));
}

TEST_F(SchedulerTest, AResultMakesRoomForTheNextRun) {
  SubmitRuns(1, 2);
  Join(10);
  const SchedulerOrders orders = Decide();
  EXPECT_EQ(scheduler_.Completed(10, orders.leases[0].fence, 1, 111), Answer::kAccepted);
  EXPECT_THAT(RunsOf(Decide()), ElementsAre(2));
}

TEST_F(SchedulerTest, AcknowledgesAResultWhenItIsStoredAndForgetsTheRun) {
  SubmitRuns(1, 1);
  Join(10);
  const Fence fence = Decide().leases[0].fence;
  EXPECT_EQ(scheduler_.Completed(10, fence, 1, 111), Answer::kAccepted);
  EXPECT_EQ(scheduler_.Completed(10, fence, 1, 111), Answer::kRepeated);
  EXPECT_THAT(Decide().acknowledgements, IsEmpty());
  scheduler_.Acknowledge(1);
  const SchedulerOrders orders = Decide();
  EXPECT_THAT(FencesOf(orders.acknowledgements), ElementsAre(fence));
  EXPECT_EQ(scheduler_.remembered_runs(), 0U);
  EXPECT_EQ(scheduler_.Statistics().duplicates, 0U);
}

TEST_F(SchedulerTest, AcknowledgesAgainWhatAWorkerStillHolds) {
  SubmitRuns(1, 1);
  Join(10);
  const Fence fence = Decide().leases[0].fence;
  scheduler_.Completed(10, fence, 1, 111);
  scheduler_.WorkerHeartbeat(10, {fence}, clock_.Now());
  EXPECT_THAT(Decide().acknowledgements, IsEmpty()) << "not stored yet";
  scheduler_.Acknowledge(1);
  Decide();
  scheduler_.WorkerHeartbeat(10, {fence}, clock_.Now());
  EXPECT_THAT(FencesOf(Decide().acknowledgements), ElementsAre(fence));
}

TEST_F(SchedulerTest, LosesAWorkerWithinThreeSilentHeartbeatsAndLeasesItsRunsElsewhere) {
  SubmitRuns(1, 1);
  Join(10);
  const Fence first = Decide().leases[0].fence;
  Join(11);
  EXPECT_THAT(PassTime(milliseconds(2750), {11}).lost, IsEmpty());
  const SchedulerOrders orders = PassTime(milliseconds(250), {11});
  ASSERT_THAT(orders.lost, SizeIs(1));
  EXPECT_EQ(orders.lost[0].worker, 10U);
  EXPECT_THAT(orders.lost[0].released, ElementsAre(1));
  ASSERT_THAT(orders.leases, SizeIs(1));
  EXPECT_EQ(orders.leases[0].worker, 11U);
  EXPECT_EQ(orders.leases[0].attempt, 2U);
  EXPECT_GT(orders.leases[0].fence, first);
  const WorkerStatistics statistics = scheduler_.Statistics();
  EXPECT_EQ(statistics.lost, 1);
  EXPECT_EQ(statistics.releases, 1U);
  EXPECT_EQ(statistics.connected, 1);
}

// A starving worker of this machine is excused again and again, but not for ever.
TEST_F(SchedulerTest, AnExcusedWorkerMayBeSilentTenTimesAsLong) {
  SubmitRuns(1, 1);
  Join(10);
  Decide();
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
  SubmitRuns(1, 1);
  Join(10);
  Decide();
  clock_.Advance(minutes(10));
  EXPECT_THAT(Decide().lost, IsEmpty());
  scheduler_.WorkerHeard(10, clock_.Now());
  EXPECT_THAT(PassTime(seconds(2), {}).lost, IsEmpty());
}

TEST_F(SchedulerTest, ADeadProcessIsLostAtOnce) {
  SubmitRuns(1, 1);
  Join(10);
  Decide();
  Join(11);
  EXPECT_TRUE(scheduler_.WorkerDied(10));
  const SchedulerOrders orders = Decide();
  EXPECT_THAT(orders.lost, SizeIs(1));
  EXPECT_EQ(orders.leases.at(0).worker, 11U);
}

TEST_F(SchedulerTest, ALateResultIsTakenAndTheOtherWorkerIsToldToStop) {
  SubmitRuns(1, 1);
  Join(10);
  const Fence late = Decide().leases[0].fence;
  Join(11);
  scheduler_.WorkerDied(10);
  const Fence second = Decide().leases.at(0).fence;
  EXPECT_EQ(scheduler_.Completed(10, late, 1, 111), Answer::kAccepted);
  SchedulerOrders orders = Decide();
  ASSERT_THAT(FencesOf(orders.cancels), ElementsAre(second));
  EXPECT_EQ(orders.cancels[0].worker, 11U);
  EXPECT_EQ(scheduler_.unfinished(), 0U);
  scheduler_.Submit(2);
  EXPECT_EQ(Decide().leases.at(0).worker, 11U) << "the cancelled lease no longer fills its slot";
}

TEST_F(SchedulerTest, ALateResultOfAQueuedRunTakesItOutOfTheQueue) {
  SubmitRuns(1, 1);
  Join(10);
  const Fence late = Decide().leases[0].fence;
  scheduler_.WorkerDied(10);
  Decide();
  EXPECT_EQ(scheduler_.queued(), 1U);
  EXPECT_EQ(scheduler_.Completed(10, late, 1, 111), Answer::kAccepted);
  EXPECT_EQ(scheduler_.queued(), 0U);
  Join(11);
  EXPECT_THAT(Decide().leases, IsEmpty());
}

TEST_F(SchedulerTest, EqualDuplicatesAreCounted) {
  SubmitRuns(1, 1);
  Join(10);
  const Fence first = Decide().leases[0].fence;
  Join(11);
  scheduler_.WorkerDied(10);
  const Fence second = Decide().leases[0].fence;
  scheduler_.Completed(11, second, 1, 111);
  scheduler_.Acknowledge(1);
  Decide();
  EXPECT_EQ(scheduler_.Completed(10, first, 1, 111), Answer::kDuplicate);
  const SchedulerOrders orders = Decide();
  EXPECT_THAT(orders.mismatches, IsEmpty());
  EXPECT_THAT(FencesOf(orders.acknowledgements), ElementsAre(first));
  EXPECT_EQ(scheduler_.Statistics().duplicates, 1U);
  EXPECT_EQ(scheduler_.remembered_runs(), 0U);
}

TEST_F(SchedulerTest, DifferentDuplicatesNameBothWorkers) {
  SubmitRuns(1, 1);
  Join(10);
  const Fence first = Decide().leases[0].fence;
  Join(11);
  scheduler_.WorkerDied(10);
  const Fence second = Decide().leases[0].fence;
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

TEST_F(SchedulerTest, ThreeOwnFailuresGiveUpTheRun) {
  SubmitRuns(1, 1);
  Join(10);
  const proto::RunnerFailure crash{proto::FailureKind::kCrashed, 11, 0};
  for (int attempt = 1; attempt <= 2; ++attempt) {
    const SchedulerOrders orders = Decide();
    ASSERT_THAT(orders.leases, SizeIs(1));
    EXPECT_THAT(orders.given_up, IsEmpty());
    EXPECT_EQ(scheduler_.Failed(10, orders.leases[0].fence, 1, crash), Answer::kAccepted);
  }
  const Fence last = Decide().leases.at(0).fence;
  scheduler_.Failed(10, last, 1, {proto::FailureKind::kHung, 0, 0});
  const SchedulerOrders orders = Decide();
  ASSERT_THAT(orders.given_up, SizeIs(1));
  EXPECT_EQ(orders.given_up[0].last.kind, proto::FailureKind::kHung);
  EXPECT_EQ(orders.given_up[0].of_last_kind, 1U);
  EXPECT_EQ(orders.given_up[0].attempts, 3U);
  EXPECT_EQ(orders.given_up[0].leases, 3U);
  EXPECT_THAT(FencesOf(orders.acknowledgements), ElementsAre(last));
  EXPECT_THAT(orders.leases, IsEmpty());
  scheduler_.Acknowledge(1);
  EXPECT_EQ(scheduler_.remembered_runs(), 0U);
}

TEST_F(SchedulerTest, ExternalFailuresAndLostWorkersAreNoAttempts) {
  SubmitRuns(1, 1);
  for (InstanceId worker = 10; worker < 20; ++worker) {
    Join(worker);
    const Fence fence = Decide().leases.at(0).fence;
    EXPECT_EQ(scheduler_.Failed(worker, fence, 1, {proto::FailureKind::kExternal, 15, 0}), Answer::kAccepted);
    EXPECT_THAT(Decide().leases, SizeIs(1));
    scheduler_.WorkerDied(worker);
  }
  Join(20);
  const SchedulerOrders orders = Decide();
  EXPECT_THAT(orders.given_up, IsEmpty());
  EXPECT_EQ(orders.leases.at(0).attempt, 21U);
  EXPECT_EQ(scheduler_.Completed(20, orders.leases[0].fence, 1, 111), Answer::kAccepted);
}

TEST_F(SchedulerTest, AnotherWorkersLeaseOrAnotherRunIsRejected) {
  SubmitRuns(1, 2);
  Join(10);
  const Fence fence = Decide().leases[0].fence;
  Join(11);
  Decide();
  EXPECT_EQ(scheduler_.Completed(11, fence, 1, 111), Answer::kRejected);
  EXPECT_EQ(scheduler_.Completed(10, fence, 2, 111), Answer::kRejected);
  EXPECT_EQ(scheduler_.Failed(11, fence, 1, {proto::FailureKind::kCrashed, 11, 0}), Answer::kRejected);
  EXPECT_EQ(scheduler_.unfinished(), 2U);
}

TEST_F(SchedulerTest, AFenceThatWasNeverGivenIsUnwanted) {
  SubmitRuns(1, 1);
  Join(10);
  Decide();
  EXPECT_EQ(scheduler_.Completed(10, kFirstFence + 99, 1, 111), Answer::kUnwanted);
  EXPECT_EQ(scheduler_.unfinished(), 1U);
}

TEST_F(SchedulerTest, AResultLeasedByAnEarlierMasterIsTaken) {
  SubmitRuns(1, 1);
  const Fence old = (3ULL << 32) + 5;
  Join(10, 1, {old});
  const SchedulerOrders orders = Decide();
  EXPECT_THAT(orders.acknowledgements, IsEmpty()) << "it may bring a result";
  EXPECT_EQ(scheduler_.Completed(10, old, 1, 111), Answer::kAccepted);
  EXPECT_THAT(FencesOf(Decide().cancels), ElementsAre(orders.leases.at(0).fence));
  scheduler_.Acknowledge(1);
  EXPECT_THAT(FencesOf(Decide().acknowledgements), ElementsAre(old));
}

TEST_F(SchedulerTest, AReturningWorkerKeepsTheRunThatNobodyElseHas) {
  SubmitRuns(1, 1);
  Join(10);
  const Fence fence = Decide().leases[0].fence;
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
    SubmitRuns(1, 1);
    Join(10);
    const Fence old_fence = Decide().leases[0].fence;
    Join(11);
    scheduler_.WorkerDied(10);
    const Fence new_fence = Decide().leases.at(0).fence;
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
  SubmitRuns(1, 1);
  Join(10);
  const Fence fence = Decide().leases[0].fence;
  Join(11);
  scheduler_.WorkerDied(10);
  const Fence new_fence = Decide().leases.at(0).fence;
  EXPECT_EQ(scheduler_.Completed(11, new_fence, 1, 111), Answer::kAccepted);
  scheduler_.WorkerHeartbeat(10, {fence}, clock_.Now());
  const SchedulerOrders orders = Decide();
  ASSERT_THAT(FencesOf(orders.cancels), ElementsAre(fence));
  EXPECT_EQ(orders.cancels[0].worker, 10U);
}

TEST_F(SchedulerTest, ALeaseThatAReconnectedWorkerDoesNotHoldIsGivenAgain) {
  SubmitRuns(1, 1);
  Join(10);
  const Fence fence = Decide().leases[0].fence;
  Join(10, 1, {});
  const SchedulerOrders orders = Decide();
  EXPECT_THAT(RunsOf(orders), ElementsAre(1));
  EXPECT_GT(orders.leases[0].fence, fence);
}

TEST_F(SchedulerTest, ALeaseThatCrossedAHeartbeatIsNotTakenBackButALostOneIs) {
  SubmitRuns(1, 1);
  Join(10);
  Decide();
  scheduler_.WorkerHeartbeat(10, {}, clock_.Now());
  EXPECT_THAT(Decide().leases, IsEmpty());
  PassTime(seconds(8), {10});
  scheduler_.WorkerHeartbeat(10, {}, clock_.Now());
  EXPECT_THAT(Decide().leases, IsEmpty());
  PassTime(seconds(2), {10});
  scheduler_.WorkerHeartbeat(10, {}, clock_.Now());
  EXPECT_THAT(RunsOf(Decide()), ElementsAre(1));
}

TEST_F(SchedulerTest, ADrainingWorkerGetsNothingNewAndMayFinish) {
  SubmitRuns(1, 2);
  Join(10);
  const Fence fence = Decide().leases[0].fence;
  scheduler_.WorkerDraining(10);
  EXPECT_EQ(scheduler_.Completed(10, fence, 1, 111), Answer::kAccepted);
  EXPECT_THAT(Decide().leases, IsEmpty());
  EXPECT_EQ(scheduler_.queued(), 1U);
}

TEST_F(SchedulerTest, AGoodbyeReleasesItsRunsWithoutCountingALoss) {
  SubmitRuns(1, 1);
  Join(10);
  Decide();
  EXPECT_TRUE(scheduler_.WorkerLeft(10));
  EXPECT_FALSE(scheduler_.WorkerHeard(10, clock_.Now()));
  Join(11);
  EXPECT_THAT(RunsOf(Decide()), ElementsAre(1));
  EXPECT_EQ(scheduler_.Statistics().lost, 0);
}

TEST_F(SchedulerTest, AnUndeliveredLeaseGoesElsewhereAndIsNoAttempt) {
  SubmitRuns(1, 1);
  Join(10);
  scheduler_.Undelivered(Decide().leases[0].fence);
  EXPECT_THAT(Decide().leases, IsEmpty()) << "the worker is not tried again before it is heard of";
  Join(11);
  const SchedulerOrders orders = Decide();
  EXPECT_EQ(orders.leases.at(0).worker, 11U);
  EXPECT_EQ(orders.leases[0].attempt, 1U);
}

TEST_F(SchedulerTest, VanishedWorkersAndUnansweredLeasesAreForgottenInTime) {
  SubmitRuns(1, 1);
  Join(10);
  Decide();
  Join(11);
  scheduler_.WorkerDied(10);
  scheduler_.Completed(11, Decide().leases.at(0).fence, 1, 111);
  scheduler_.Acknowledge(1);
  EXPECT_THAT(PassTime(minutes(14), {11}).forgotten, IsEmpty());
  EXPECT_EQ(scheduler_.remembered_runs(), 1U) << "a late result would be compared";
  EXPECT_THAT(PassTime(minutes(2), {11}).forgotten, ElementsAre(10));
  EXPECT_EQ(scheduler_.remembered_runs(), 0U);
  EXPECT_FALSE(scheduler_.Known(10));
}

TEST_F(SchedulerTest, StopLeasingLeavesRunsInTheQueue) {
  SubmitRuns(1, 1);
  scheduler_.StopLeasing();
  Join(10);
  EXPECT_THAT(Decide().leases, IsEmpty());
  EXPECT_EQ(scheduler_.queued(), 1U);
}

TEST_F(SchedulerTest, ShortRunsAreLeasedAheadUntilEnoughWorkWaits) {
  SubmitRuns(1, 2000);
  Join(10, 2);
  std::vector<LeaseOrder> leases = Decide().leases;
  EXPECT_THAT(leases, SizeIs(2)) << "nothing is known of their length";
  const auto complete_all = [&](double took) {
    for (const LeaseOrder& lease : leases) {
      scheduler_.RunTook(took);
      EXPECT_EQ(scheduler_.Completed(10, lease.fence, lease.run, 111), Answer::kAccepted);
    }
    leases = Decide().leases;
  };
  complete_all(0.001);
  EXPECT_THAT(leases, SizeIs(20)) << "10 ms of work at each of two slots";
  complete_all(0.001);
  EXPECT_THAT(leases, SizeIs(20));
  scheduler_.RunTook(std::nan(""));
  scheduler_.RunTook(std::numeric_limits<double>::infinity());
  for (int i = 0; i < 200; ++i) scheduler_.RunTook(60.0);
  complete_all(60.0);
  EXPECT_THAT(leases, SizeIs(2)) << "one at a time again";
  for (int i = 0; i < 2000; ++i) scheduler_.RunTook(0.0);
  complete_all(0.0);
  EXPECT_THAT(leases, SizeIs(512)) << "most_credit for each slot";
}

TEST_F(SchedulerTest, NoWorkerIsGivenMoreShortRunsThanItKeeps) {
  SubmitRuns(1, 9000);
  for (int i = 0; i < 200; ++i) scheduler_.RunTook(0.0);
  Join(10, 64);
  EXPECT_THAT(Decide().leases, SizeIs(4096)) << "not 64 * 256";
}

TEST_F(SchedulerTest, WorkerWithManyShortRunsIsGivenMoreWhenHalfOfThemAreDone) {
  SubmitRuns(1, 2000);
  for (int i = 0; i < 200; ++i) scheduler_.RunTook(0.0005);
  Join(10);
  const std::vector<LeaseOrder> leases = Decide().leases;
  ASSERT_THAT(leases, SizeIs(20)) << "10 ms of work";
  for (int i = 0; i < 9; ++i) {
    scheduler_.Completed(10, leases[i].fence, leases[i].run, 111);
    EXPECT_THAT(Decide().leases, IsEmpty());
  }
  scheduler_.Completed(10, leases[9].fence, leases[9].run, 111);
  EXPECT_THAT(Decide().leases, SizeIs(10));
}

TEST_F(SchedulerTest, TheLongestRunsOfABatchGoFirstButNoBatchOvertakesAnother) {
  Join(1, 8);
  scheduler_.BeginBatch();
  scheduler_.Submit(1, 10.0);
  scheduler_.Submit(2, 30.0);
  scheduler_.Submit(3, 10.0);
  scheduler_.BeginBatch();
  scheduler_.Submit(4, 90.0);
  scheduler_.Submit(5);
  EXPECT_THAT(RunsOf(Decide()), ElementsAre(2, 1, 3, 4, 5));
}

TEST_F(SchedulerTest, AnIdleWorkerGetsACopyOfARunThatTakesLong) {
  Join(1);
  Join(2);
  SubmitRuns(1, 1);
  const SchedulerOrders first = Decide();
  ASSERT_EQ(first.leases.size(), 1U);
  scheduler_.RunTook(1.0);
  EXPECT_TRUE(PassTime(milliseconds(2000), {1, 2}).leases.empty()) << "twice the usual time is not unusual";
  const SchedulerOrders copied = PassTime(milliseconds(500), {1, 2});
  ASSERT_EQ(copied.leases.size(), 1U);
  EXPECT_EQ(copied.leases[0].run, 1U);
  EXPECT_NE(copied.leases[0].worker, first.leases[0].worker);
  EXPECT_TRUE(PassTime(milliseconds(5000), {1, 2}).leases.empty()) << "one copy is enough";
  EXPECT_EQ(scheduler_.Statistics().copies, 1U);

  EXPECT_EQ(scheduler_.Completed(copied.leases[0].worker, copied.leases[0].fence, 1, 77), Answer::kAccepted);
  const SchedulerOrders after = Decide();
  ASSERT_EQ(after.cancels.size(), 1U) << "the first is told to stop";
  EXPECT_EQ(after.cancels[0].fence, first.leases[0].fence);
}

TEST_F(SchedulerTest, NobodyGetsACopyWhileRunsWait) {
  Join(1);
  SubmitRuns(1, 2);
  Decide();
  scheduler_.RunTook(0.1);
  EXPECT_TRUE(PassTime(milliseconds(3000), {1}).leases.empty());
  Join(2);
  EXPECT_THAT(RunsOf(Decide()), ElementsAre(2));
  EXPECT_EQ(scheduler_.Statistics().copies, 0U);
}

TEST_F(SchedulerTest, CountsHowLongWorkersWereIdleAndWhy) {
  Join(1);
  Join(2);
  SubmitRuns(1, 1);
  ASSERT_EQ(Decide().leases.size(), 1U);
  PassTime(milliseconds(4000), {1, 2});
  const WorkerStatistics statistics = scheduler_.Statistics();
  EXPECT_NEAR(statistics.slot_seconds, 8.0, 1e-6);
  EXPECT_NEAR(statistics.idle_seconds, 4.0, 1e-6);
  EXPECT_NEAR(statistics.barrier_seconds, 4.0, 1e-6) << "no run waited";

  scheduler_.WorkerDied(2);
  scheduler_.WorkerDraining(1);
  PassTime(milliseconds(4000), {1});
  EXPECT_NEAR(scheduler_.Statistics().slot_seconds, 8.0, 1e-6) << "they do not count any more";
  EXPECT_NEAR(scheduler_.Statistics().idle_seconds, 4.0, 1e-6);
}

TEST_F(SchedulerTest, FiveHundredWorkersAreAllLeasedAtOnce) {
  SubmitRuns(1, 2000);
  for (InstanceId worker = 1; worker <= 512; ++worker) Join(worker);
  const SchedulerOrders orders = Decide();
  EXPECT_THAT(orders.leases, SizeIs(512));
  EXPECT_EQ(scheduler_.Statistics().busy, 512);
}

}  // namespace
}  // namespace gauntlet::master
