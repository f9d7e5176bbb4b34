// How many runs a worker is given, in which order, and copies of runs that take long.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <map>
#include <set>

#include "tests/master/dispatch/scheduler_fixture.h"

namespace gauntlet {
namespace {

using std::chrono::milliseconds;
using testing::ElementsAre;
using testing::IsEmpty;
using testing::SizeIs;
using testing::UnorderedElementsAre;

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

TEST_F(SchedulerTest, ShortRunsAreLeasedAheadUntilEnoughWorkWaits) {
  SubmitRuns(1, 2000);
  Join(10, 2);
  std::vector<LeaseOrder> leases = Decide().leases;
  EXPECT_THAT(leases, SizeIs(2)) << "nothing is known of their length";
  const auto complete_all = [&](double took) {
    for (const LeaseOrder& order : leases) {
      scheduler_.RunTook(took);
      EXPECT_EQ(scheduler_.Completed(10, order.lease.fence, order.lease.run_id, 111), Answer::kAccepted);
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
  BringAResult(10);
  EXPECT_THAT(Decide().leases, SizeIs(4096)) << "not 64 * 256";
}

TEST_F(SchedulerTest, WorkerWithManyShortRunsIsGivenMoreWhenHalfOfThemAreDone) {
  SubmitRuns(1, 2000);
  for (int i = 0; i < 200; ++i) scheduler_.RunTook(0.0005);
  Join(10);
  BringAResult(10);
  const std::vector<LeaseOrder> leases = Decide().leases;
  ASSERT_THAT(leases, SizeIs(20)) << "10 ms of work";
  for (int i = 0; i < 9; ++i) {
    scheduler_.Completed(10, leases[i].lease.fence, leases[i].lease.run_id, 111);
    EXPECT_THAT(Decide().leases, IsEmpty());
  }
  scheduler_.Completed(10, leases[9].lease.fence, leases[9].lease.run_id, 111);
  EXPECT_THAT(Decide().leases, SizeIs(10));
}

// Runs of 50 ms; 20 are a second of work.
class BatchedSchedulerTest : public SchedulerTest {
 protected:
  BatchedSchedulerTest() {
    DispatchOptions options = LeaseOptions();
    options.many_waiting = DispatchOptions().many_waiting;
    scheduler_ = Scheduler(options, kFirstFence);
    for (int i = 0; i < 200; ++i) scheduler_.RunTook(0.05);
  }
  // Worker 10, which has shown that it can work, and what it gets of so many runs.
  std::vector<LeaseOrder> LeasesOf(RunId runs) {
    Join(10);
    BringAResult(10);
    SubmitRuns(1, runs);
    return Decide().leases;
  }
};

TEST_F(BatchedSchedulerTest, WhileManyRunsWaitASecondOfThemIsLeasedAndTheirResultsMayComeTogether) {
  const std::vector<LeaseOrder> leases = LeasesOf(100);
  ASSERT_THAT(leases, SizeIs(20));
  for (const LeaseOrder& order : leases) EXPECT_EQ(order.lease.result_wait, DispatchOptions().result_wait);
}

TEST_F(BatchedSchedulerTest, NeverMoreIsLeasedThanWaitsAndTheLastResultsComeAtOnce) {
  std::size_t waiting = 60;
  std::size_t at_once = 0;
  for (std::vector<LeaseOrder> leases = LeasesOf(60); !leases.empty(); leases = Decide().leases) {
    EXPECT_LE(leases.size(), std::max<std::size_t>(1, waiting / 2 + 1));
    for (const LeaseOrder& order : leases) {
      --waiting;
      EXPECT_EQ(order.lease.result_wait.count() == 0, waiting < DispatchOptions().many_waiting) << waiting;
      if (order.lease.result_wait.count() == 0) ++at_once;
      scheduler_.Completed(10, order.lease.fence, order.lease.run_id, 111);
    }
  }
  EXPECT_EQ(waiting, 0U);
  EXPECT_EQ(at_once, DispatchOptions().many_waiting);
}

TEST_F(BatchedSchedulerTest, AnIdleWorkerTakesOverNothingWhoseResultMayBeHeldBack) {
  ASSERT_THAT(LeasesOf(20), SizeIs(10)) << "as many wait";
  Join(11, 10);
  const std::vector<LeaseOrder> others = Decide().leases;
  ASSERT_THAT(others, SizeIs(10));
  scheduler_.Completed(11, others[0].lease.fence, others[0].lease.run_id, 111);
  EXPECT_THAT(RunsOf(Decide()), ElementsAre(6))
      << "1 runs; at most 4 of 9 others have ended and are kept back";
}

TEST_F(SchedulerTest, HowLongARunTakesIsCountedFromWhenItsTurnCame) {
  scheduler_ = Scheduler(LeaseOptions(2), kFirstFence);
  scheduler_.RunTook(1.0);
  Join(1);
  SubmitRuns(1, 2);
  const std::vector<LeaseOrder> leases = Decide().leases;
  ASSERT_THAT(leases, SizeIs(2));
  PassTime(milliseconds(2000), {1});
  scheduler_.Completed(1, leases[0].lease.fence, leases[0].lease.run_id, 111);
  Join(2);
  EXPECT_THAT(PassTime(milliseconds(2000), {1, 2}).leases, IsEmpty()) << "run 2 has run for two seconds";
  EXPECT_THAT(RunsOf(PassTime(milliseconds(500), {1, 2})), ElementsAre(2));
}

// Two runs at worker 10 and two at worker 11, which then finishes both.
TEST_F(SchedulerTest, AnIdleWorkerTakesOverWhatWaitsBehindAnothersRun) {
  for (const double run_seconds : {0.0015, 0.02}) {
    SCOPED_TRACE(run_seconds);
    scheduler_ = Scheduler(LeaseOptions(2), kFirstFence);
    for (int i = 0; i < 200; ++i) scheduler_.RunTook(run_seconds);
    SubmitRuns(1, 4);
    Join(10);
    Join(11);
    std::map<RunId, LeaseOrder> given;
    for (const LeaseOrder& order : Decide().leases) given[order.lease.run_id] = order;
    ASSERT_THAT(given, SizeIs(4));
    const InstanceId busy = given[1].worker;
    const InstanceId idle = given[2].worker;
    ASSERT_EQ(given[3].worker, busy);
    ASSERT_EQ(given[4].worker, idle);
    scheduler_.Completed(idle, given[2].lease.fence, 2, 111);
    EXPECT_THAT(Decide().leases, IsEmpty()) << "it has another run";
    scheduler_.Completed(idle, given[4].lease.fence, 4, 111);
    const SchedulerOrders orders = Decide();
    if (run_seconds < 0.002) {
      EXPECT_THAT(orders.leases, IsEmpty()) << "not worth a message";
      continue;
    }
    ASSERT_THAT(RunsOf(orders), ElementsAre(3));
    EXPECT_EQ(orders.leases[0].worker, idle);
    EXPECT_THAT(FencesOf(orders.cancels), ElementsAre(given[3].lease.fence));
    EXPECT_THAT(Decide().leases, IsEmpty()) << "run 1 has begun and stays";
    // The one who had it was faster than the message: its answer counts, and the other's is a duplicate.
    EXPECT_EQ(scheduler_.Completed(busy, given[3].lease.fence, 3, 111), Answer::kAccepted);
    EXPECT_EQ(scheduler_.Completed(idle, orders.leases[0].lease.fence, 3, 111), Answer::kDuplicate);
    EXPECT_EQ(scheduler_.Statistics().nondeterministic, 0U);
  }
}

TEST_F(SchedulerTest, TheLongestRunsOfABatchGoFirstButNoBatchOvertakesAnother) {
  Join(1, 8);
  scheduler_.BeginBatch();
  scheduler_.Submit({1, "spec", 10.0});
  scheduler_.Submit({2, "spec", 30.0});
  scheduler_.Submit({3, "spec", 10.0});
  scheduler_.BeginBatch();
  scheduler_.Submit({4, "spec", 90.0});
  scheduler_.Submit({5, "spec"});
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
  EXPECT_EQ(copied.leases[0].lease.run_id, 1U);
  EXPECT_NE(copied.leases[0].worker, first.leases[0].worker);
  EXPECT_TRUE(PassTime(milliseconds(5000), {1, 2}).leases.empty()) << "one copy is enough";
  EXPECT_EQ(scheduler_.Statistics().copies, 1U);

  EXPECT_EQ(scheduler_.Completed(copied.leases[0].worker, copied.leases[0].lease.fence, 1, 77),
            Answer::kAccepted);
  const SchedulerOrders after = Decide();
  ASSERT_EQ(after.cancels.size(), 1U) << "the first is told to stop";
  EXPECT_EQ(after.cancels[0].fence, first.leases[0].lease.fence);
}

// Both who have it may keep it for nothing.
TEST_F(SchedulerTest, AThirdWorkerGetsARunThatTakesLongOnTwo) {
  for (const InstanceId worker : {1, 2, 3}) Join(worker);
  SubmitRuns(1, 1);
  std::set<InstanceId> asked{Decide().leases.at(0).worker};
  scheduler_.RunTook(1.0);
  for (int copy = 0; copy < 2; ++copy) {
    const SchedulerOrders copied = PassTime(milliseconds(2500), {1, 2, 3});
    ASSERT_THAT(copied.leases, SizeIs(1));
    asked.insert(copied.leases[0].worker);
  }
  EXPECT_THAT(asked, SizeIs(3));
}

TEST_F(SchedulerTest, WhoKeepsRunsUntilOthersHaveFinishedThemIsQuarantined) {
  Join(1);
  SubmitRuns(1, 1);
  Decide();
  scheduler_.RunTook(1.0);
  Join(2);
  std::vector<WorkerQuarantined> quarantined;
  for (RunId run = 1; run <= 3; ++run) {
    EXPECT_THAT(quarantined, IsEmpty());
    const SchedulerOrders copied = PassTime(milliseconds(2500), {1, 2});
    ASSERT_THAT(copied.leases, SizeIs(1)) << run;
    EXPECT_EQ(copied.leases[0].worker, 2U);
    EXPECT_EQ(scheduler_.Completed(2, copied.leases[0].lease.fence, run, 77), Answer::kAccepted);
    scheduler_.WorkerDraining(2);
    scheduler_.Submit({run + 1, "spec"});
    quarantined = Decide().quarantined;
    Join(2);
  }
  ASSERT_THAT(quarantined, SizeIs(1));
  EXPECT_EQ(quarantined[0].worker, 1U);
  EXPECT_EQ(InWords(quarantined[0].record),
            "it kept 3 runs unusually long, until other workers had finished them; it finished nothing");
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
}  // namespace gauntlet
