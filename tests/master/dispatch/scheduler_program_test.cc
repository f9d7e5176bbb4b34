// Runs that start a program of the user's, which nobody promises to be reproducible.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <map>
#include <optional>
#include <random>
#include <string>

#include "tests/master/dispatch/scheduler_fixture.h"

namespace gauntlet {
namespace {

using std::chrono::milliseconds;
using testing::ElementsAre;
using testing::IsEmpty;
using testing::SizeIs;

const proto::RunnerFailure kProgramCrash{proto::FailureKind::kCrashed, 11, 0};
const proto::RunnerFailure kProgramKilled{proto::FailureKind::kExternal, 9, 0};

class SchedulerProgramTest : public SchedulerTest {
 protected:
  SchedulerProgramTest() { Begin(Reproducible::kUnknown); }

  void Begin(Reproducible known, std::uint32_t credit = 1, int most_per_host = 0, int cores_per_run = 1) {
    DispatchOptions options = LeaseOptions(credit);
    options.reproducible = known;
    options.most_per_host = most_per_host;
    options.cores_per_run = cores_per_run;
    scheduler_ = Scheduler(options, kFirstFence);
  }
  void JoinAt(InstanceId worker, const std::string& host, std::uint32_t slots = 1) {
    scheduler_.WorkerJoined(worker, slots, {}, clock_.Now(), host);
  }
  // Runs 1 to 3 are completed by worker 1 on host a; the run's number is its hash.
  void FinishThree() {
    JoinAt(1, "a");
    SubmitRuns(1, 3);
    for (RunId run = 1; run <= 3; ++run) Complete(OnlyLease(Decide()), run);
  }
  static LeaseOrder OnlyLease(const SchedulerOrders& orders) {
    EXPECT_THAT(orders.leases, SizeIs(1));
    return orders.leases.at(0);
  }
  Answer Complete(const LeaseOrder& order, std::uint64_t hash) {
    return scheduler_.Completed(order.worker, order.lease.fence, order.lease.run_id, hash);
  }
  Answer Fail(const LeaseOrder& order, const proto::RunnerFailure& failure) {
    return scheduler_.Failed(order.worker, order.lease.fence, order.lease.run_id, failure);
  }
};

TEST_F(SchedulerProgramTest, TheFirstThreeRunsAreSimulatedOnceMoreButNotBeforeTwoSecondsAreOver) {
  FinishThree();
  EXPECT_EQ(scheduler_.Statistics().audits_open, 3U);
  EXPECT_THAT(PassTime(milliseconds(1750), {1}).leases, IsEmpty());
  SchedulerOrders orders = PassTime(milliseconds(250), {1});
  for (RunId run = 1; run <= 3; ++run) {
    const LeaseOrder again = OnlyLease(orders);
    EXPECT_EQ(again.lease.run_id, run);
    EXPECT_EQ(Complete(again, run), Answer::kDuplicate);
    orders = Decide();
  }
  ASSERT_TRUE(orders.reproducibility);
  EXPECT_EQ(orders.reproducibility->state, Reproducible::kYes);
  EXPECT_EQ(orders.reproducibility->text, "host a");
  EXPECT_EQ(scheduler_.Statistics().audits_open, 0U);
  EXPECT_EQ(scheduler_.Statistics().audits_alone, 3U);
}

TEST_F(SchedulerProgramTest, AnotherHostIsAskedAndWaitedForIfThereIsOne) {
  FinishThree();
  JoinAt(2, "a");
  JoinAt(3, "b");
  SubmitRuns(4, 4);
  scheduler_.WorkerDraining(1);
  scheduler_.WorkerDraining(2);
  const LeaseOrder busy = OnlyLease(Decide());
  ASSERT_EQ(busy.worker, 3U);
  JoinAt(1, "a");
  JoinAt(2, "a");
  EXPECT_THAT(PassTime(milliseconds(3000), {1, 2, 3}).leases, IsEmpty());
  Complete(busy, 4);
  SubmitRuns(5, 5);
  std::map<RunId, InstanceId> given;
  for (const LeaseOrder& order : Decide().leases) given[order.lease.run_id] = order.worker;
  EXPECT_EQ(given.at(1), 3U) << "before the run that waits";
  EXPECT_EQ(given.at(5), 1U);
  scheduler_.WorkerDied(3);
  EXPECT_EQ(OnlyLease(Decide()).worker, 2U) << "another worker, where there is no other host";
}

TEST_F(SchedulerProgramTest, ARunThatWasRefusedIsNoneOfTheThree) {
  JoinAt(1, "a");
  SubmitRuns(1, 1);
  const LeaseOrder order = OnlyLease(Decide());
  EXPECT_EQ(scheduler_.Completed(1, order.lease.fence, 1, 55, /*to_its_end=*/false), Answer::kAccepted);
  EXPECT_EQ(scheduler_.Statistics().audits_open, 0U);
}

TEST_F(SchedulerProgramTest, ADifferenceSpeaksAgainstNobodyAndIsNoError) {
  FinishThree();
  JoinAt(2, "b");
  PassTime(milliseconds(1750), {1, 2});
  const LeaseOrder again = OnlyLease(PassTime(milliseconds(250), {1, 2}));
  Complete(again, 99);
  SchedulerOrders orders = Decide();
  ASSERT_TRUE(orders.reproducibility);
  EXPECT_EQ(orders.reproducibility->state, Reproducible::kNo);
  EXPECT_EQ(orders.reproducibility->text, "run 1 ended differently when it was simulated again on b");
  EXPECT_THAT(orders.mismatches, IsEmpty());
  EXPECT_EQ(scheduler_.Statistics().nondeterministic, 0U);
  EXPECT_EQ(scheduler_.Statistics().differences, 1U);
}

TEST_F(SchedulerProgramTest, ASecondSimulationThatCrashesOnceIsADifference) {
  FinishThree();
  PassTime(milliseconds(1750), {1});
  Fail(OnlyLease(PassTime(milliseconds(250), {1})), kProgramKilled);
  SchedulerOrders orders = Decide();
  EXPECT_FALSE(orders.reproducibility) << "that was the machine";
  Fail(OnlyLease(orders), kProgramCrash);
  orders = Decide();
  ASSERT_TRUE(orders.reproducibility);
  EXPECT_EQ(orders.reproducibility->state, Reproducible::kNo);
  EXPECT_EQ(scheduler_.Statistics().audits_open, 2U);
}

TEST_F(SchedulerProgramTest, WhenItIsKnownWhatWasAskedForIsAuditedAndADifferenceTurnsYesToNo) {
  DispatchOptions options = LeaseOptions();
  options.reproducible = Reproducible::kYes;
  options.audit_share = 1.0;
  scheduler_ = Scheduler(options, kFirstFence);
  JoinAt(1, "a");
  SubmitRuns(1, 1);
  Complete(OnlyLease(Decide()), 1);
  PassTime(milliseconds(1750), {1});
  Complete(OnlyLease(PassTime(milliseconds(250), {1})), 2);
  const SchedulerOrders orders = Decide();
  ASSERT_TRUE(orders.reproducibility);
  EXPECT_EQ(orders.reproducibility->state, Reproducible::kNo);
  EXPECT_THAT(orders.mismatches, IsEmpty());
}

TEST_F(SchedulerProgramTest, OneCrashIsTheVerdict) {
  JoinAt(1, "a");
  JoinAt(2, "b");
  SubmitRuns(1, 1);
  Fail(OnlyLease(Decide()), kProgramCrash);
  const SchedulerOrders orders = Decide();
  ASSERT_THAT(orders.given_up, SizeIs(1));
  EXPECT_EQ(orders.given_up[0].attempts, 1U);
  EXPECT_FALSE(orders.given_up[0].alone());
  EXPECT_EQ(scheduler_.Statistics().lone_verdicts, 0U);
}

TEST_F(SchedulerProgramTest, WhenItIsReproducibleACrashTakesThreeAttempts) {
  Begin(Reproducible::kYes);
  JoinAt(1, "a");
  BringAResult(1);
  SubmitRuns(1, 1);
  for (int attempt = 0; attempt < 3; ++attempt) {
    const SchedulerOrders orders = Decide();
    EXPECT_THAT(orders.given_up, IsEmpty());
    Fail(OnlyLease(orders), kProgramCrash);
  }
  EXPECT_THAT(Decide().given_up, SizeIs(1));
}

TEST_F(SchedulerProgramTest, WhatTheMachineDidIsTriedAgain) {
  JoinAt(1, "a");
  JoinAt(2, "b");
  SubmitRuns(1, 1);
  const LeaseOrder first = OnlyLease(Decide());
  Fail(first, kProgramKilled);
  const LeaseOrder second = OnlyLease(PassTime(milliseconds(1250), {1, 2}));
  EXPECT_NE(second.worker, first.worker);
  Fail(second, {proto::FailureKind::kExternal, 0, 88});
  const LeaseOrder third = OnlyLease(Decide());
  Fail(third, kProgramCrash);
  EXPECT_THAT(Decide().given_up, SizeIs(1));
}

TEST_F(SchedulerProgramTest, TheFirstEndingCountsWhoeverBringsIt) {
  for (const bool late_first : {true, false}) {
    Begin(Reproducible::kUnknown);
    const TwoLeases leases = LeaseRun1To10AndThenTo11();
    const auto complete = [&](bool late) {
      return scheduler_.Completed(late ? 10 : 11, late ? leases.first : leases.second, 1, late ? 5 : 6);
    };
    EXPECT_EQ(complete(late_first), Answer::kAccepted);
    EXPECT_EQ(complete(!late_first), Answer::kDuplicate);
    const SchedulerOrders orders = Decide();
    ASSERT_TRUE(orders.reproducibility) << "they were different";
    EXPECT_EQ(orders.reproducibility->state, Reproducible::kNo);
    EXPECT_THAT(orders.mismatches, IsEmpty());
  }
}

TEST_F(SchedulerProgramTest, AnEqualLateAnswerIsNotTheSecondSimulation) {
  const TwoLeases leases = LeaseRun1To10AndThenTo11();
  scheduler_.Completed(11, leases.second, 1, 5);
  scheduler_.Completed(10, leases.first, 1, 5);
  EXPECT_EQ(scheduler_.Statistics().audits_open, 1U) << "both may have begun in the same second";
}

TEST_F(SchedulerProgramTest, NothingIsLeasedASecondTimeForSpeed) {
  Begin(Reproducible::kUnknown, /*credit=*/2);
  for (int i = 0; i < 200; ++i) scheduler_.RunTook(1.0);
  JoinAt(1, "a");
  SubmitRuns(1, 2);
  EXPECT_THAT(RunsOf(Decide()), ElementsAre(1)) << "nothing waits at a worker";
  JoinAt(2, "b");
  EXPECT_THAT(RunsOf(Decide()), ElementsAre(2));
  JoinAt(3, "c");
  EXPECT_THAT(PassTime(milliseconds(10000), {1, 2, 3}).leases, IsEmpty());

  Begin(Reproducible::kYes, /*credit=*/2);
  scheduler_.RunTook(1.0);
  JoinAt(1, "a");
  SubmitRuns(1, 2);
  EXPECT_THAT(RunsOf(Decide()), ElementsAre(1, 2));
  JoinAt(3, "c");
  EXPECT_THAT(RunsOf(PassTime(milliseconds(5000), {1, 3})), ElementsAre(2)) << "moved";
  JoinAt(4, "d");
  EXPECT_THAT(RunsOf(PassTime(milliseconds(500), {1, 3, 4})), ElementsAre(1)) << "copied";
}

TEST_F(SchedulerProgramTest, OnlyWhoseRunsFailWhileOthersFinishThemIsQuarantined) {
  for (const bool others_crash : {true, false}) {
    Begin(Reproducible::kNo);
    JoinAt(1, "a");
    JoinAt(2, "b");
    SubmitRuns(1, 200);
    std::vector<InstanceId> quarantined;
    int finished = 0;
    for (int round = 0; round < 60; ++round) {
      clock_.Advance(milliseconds(1000));
      for (const InstanceId worker : {1, 2}) scheduler_.WorkerHeard(worker, clock_.Now());
      const SchedulerOrders orders = Decide();
      for (const WorkerQuarantined& order : orders.quarantined) quarantined.push_back(order.worker);
      for (const LeaseOrder& order : orders.leases) {
        const bool crashes = order.worker == 1 || (others_crash && finished++ % 3 == 0);
        crashes ? Fail(order, kProgramCrash) : Complete(order, order.lease.run_id);
      }
    }
    if (others_crash) {
      EXPECT_THAT(quarantined, IsEmpty());
      continue;
    }
    EXPECT_THAT(quarantined, ElementsAre(1));
  }
}

TEST_F(SchedulerProgramTest, AHostHasNoMoreLeasesThanItMay) {
  Begin(Reproducible::kYes, /*credit=*/1, /*most_per_host=*/3);
  JoinAt(1, "a", 2);
  JoinAt(2, "a", 2);
  JoinAt(3, "b", 2);
  SubmitRuns(1, 10);
  std::map<InstanceId, std::vector<LeaseOrder>> given;
  for (const LeaseOrder& order : Decide().leases) given[order.worker].push_back(order);
  EXPECT_EQ(given[1].size() + given[2].size(), 3U);
  EXPECT_THAT(given[3], SizeIs(2));
  EXPECT_THAT(PassTime(milliseconds(1000), {1, 2, 3}).leases, IsEmpty());
  Complete(given[1].front(), 1);
  EXPECT_THAT(Decide().leases, SizeIs(1));
  scheduler_.WorkerLeft(given[2].size() > 1 ? 1 : 2);
  EXPECT_LE(Decide().leases.size(), 1U) << "two slots are left on the host";
}

TEST_F(SchedulerProgramTest, ARunOfSeveralCoresTakesSoManySlotsOfItsHost) {
  Begin(Reproducible::kYes, /*credit=*/1, /*most_per_host=*/0, /*cores_per_run=*/2);
  JoinAt(1, "a", 4);
  JoinAt(2, "b", 1);
  JoinAt(3, "b", 1);
  JoinAt(4, "c", 1);
  SubmitRuns(1, 10);
  std::map<InstanceId, std::size_t> given;
  for (const LeaseOrder& order : Decide().leases) ++given[order.worker];
  EXPECT_EQ(given[1], 2U);
  EXPECT_EQ(given[2] + given[3], 1U);
  EXPECT_EQ(given[4], 1U) << "a host of one core runs one at a time all the same";
}

// A program that crashes by chance, and takes longer then. Some workers die, some are silent for a while and
// come back with what they have.
class RandomProgram {
 public:
  RandomProgram(Reproducible known, InstanceId workers) {
    DispatchOptions options = LeaseOptions();
    options.reproducible = known;
    scheduler_ = Scheduler(options, kFirstFence);
    for (InstanceId id = 1; id <= workers; ++id) Join(next_worker_++, {});
  }
  // The share of runs whose verdict is that they crashed.
  double ShareOfCrashes(RunId runs) {
    for (RunId run = 1; run <= runs; ++run) scheduler_.Submit({run, "spec"});
    for (int tick = 0; tick < 200'000 && ended_ < runs; ++tick) {
      clock_.Advance(milliseconds(100));
      for (const auto& [id, worker] : std::map(workers_)) Turn(id);
      Act();
    }
    EXPECT_EQ(ended_, runs);
    return static_cast<double>(crashed_) / static_cast<double>(runs);
  }
  std::uint64_t lost() const { return scheduler_.Statistics().lost; }
  std::size_t quarantined = 0;

 private:
  struct Work {
    LeaseOrder order;
    bool crashes = false;
    TimePoint until;
  };
  struct Worker {
    std::optional<Work> work = {};
    TimePoint silent_until{};
  };
  bool Happens(unsigned per_thousand) { return random_() % 1000 < per_thousand; }

  void Join(InstanceId id, const std::vector<Fence>& held) {
    workers_.try_emplace(id);
    scheduler_.WorkerJoined(id, 1, held, clock_.Now(), "host " + std::to_string(id % 3));
  }
  void Turn(InstanceId id) {
    Worker& worker = workers_.at(id);
    if (Happens(1)) {
      workers_.erase(id);
      scheduler_.WorkerDied(id);
      return Join(next_worker_++, {});
    }
    if (Happens(1)) worker.silent_until = clock_.Now() + milliseconds(6000);
    if (clock_.Now() < worker.silent_until) return;
    std::vector<Fence> held;
    if (worker.work) held = {worker.work->order.lease.fence};
    if (!scheduler_.WorkerHeartbeat(id, held, clock_.Now())) Join(id, held);
    if (!worker.work || clock_.Now() < worker.work->until) return;
    const Work done = *std::exchange(worker.work, std::nullopt);
    const proto::Lease& lease = done.order.lease;
    if (done.crashes) {
      scheduler_.Failed(id, lease.fence, lease.run_id, kProgramCrash);
    } else if (scheduler_.Completed(id, lease.fence, lease.run_id, random_()) == Answer::kAccepted) {
      End(lease.run_id);
    }
  }
  void Act() {
    const SchedulerOrders orders = scheduler_.Decide(clock_.Now());
    quarantined += orders.quarantined.size();
    for (const RunGivenUp& run : orders.given_up) {
      ++crashed_;
      End(run.run);
    }
    for (const FenceOrder& cancel : orders.cancels) {
      const auto worker = workers_.find(cancel.worker);
      if (worker != workers_.end() && worker->second.work &&
          worker->second.work->order.lease.fence == cancel.fence)
        worker->second.work.reset();
    }
    for (const LeaseOrder& order : orders.leases) {
      const bool crashes = Happens(300);
      const auto time = milliseconds(crashes ? 1500 : 500);
      workers_.at(order.worker).work = Work{order, crashes, clock_.Now() + time};
    }
  }
  void End(RunId run) {
    ++ended_;
    scheduler_.Acknowledge(run);
  }

  testing_support::FakeClock clock_;
  Scheduler scheduler_{LeaseOptions(), kFirstFence};
  std::map<InstanceId, Worker> workers_;
  InstanceId next_worker_ = 1;
  std::mt19937_64 random_{20261126};
  RunId ended_ = 0;
  RunId crashed_ = 0;
};

TEST(RandomProgramTest, TheShareOfCrashesIsThatOfTheProgramForAnyNumberOfWorkers) {
  constexpr double kShare = 0.3;
  constexpr RunId kRuns = 1000;
  const double standard_error = std::sqrt(kShare * (1.0 - kShare) / static_cast<double>(kRuns));
  for (const InstanceId workers : {1U, 2U, 8U}) {
    SCOPED_TRACE(workers);
    RandomProgram program(Reproducible::kUnknown, workers);
    EXPECT_NEAR(program.ShareOfCrashes(kRuns), kShare, 3.0 * standard_error);
    EXPECT_GE(program.lost(), 10U);
    EXPECT_EQ(program.quarantined, 0U);
  }
}

TEST(RandomProgramTest, IfRunsWereTakenForPureFunctionsTheShareWouldBeWrong) {
  EXPECT_LT(RandomProgram(Reproducible::kPromised, 8).ShareOfCrashes(1000), 0.15);
}

}  // namespace
}  // namespace gauntlet
