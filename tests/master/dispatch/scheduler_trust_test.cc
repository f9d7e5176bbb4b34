// Failures of one worker, and what others make of the same runs.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <functional>
#include <map>
#include <set>

#include "tests/master/dispatch/scheduler_fixture.h"

namespace gauntlet {
namespace {

using std::chrono::milliseconds;
using testing::ElementsAre;
using testing::IsEmpty;
using testing::SizeIs;

const proto::RunnerFailure kCrash{proto::FailureKind::kCrashed, 11, 0};
const proto::RunnerFailure kHang{proto::FailureKind::kHung, 0, 0};

class SchedulerTrustTest : public SchedulerTest {
 protected:
  void JoinAt(InstanceId worker, const std::string& host) {
    scheduler_.WorkerJoined(worker, 1, {}, clock_.Now(), host);
  }
  // Everybody has finished a run and can be believed.
  void JoinTrusted(const std::vector<InstanceId>& workers, const std::string& host = "") {
    for (const InstanceId worker : workers) {
      JoinAt(worker, host);
      BringAResult(worker);
    }
    Decide();
  }
  // Answers what is leased, run by run as `answer` says, until nothing is leased any more or `rounds` are
  // over.
  void Work(const std::function<void(const LeaseOrder&)>& answer, int rounds = 1000) {
    for (int round = 0; round < rounds; ++round) {
      const SchedulerOrders orders = Decide();
      Note(orders);
      if (orders.leases.empty()) return;
      for (const LeaseOrder& order : orders.leases) answer(order);
    }
  }
  void Note(const SchedulerOrders& orders) {
    for (const RunGivenUp& order : orders.given_up) given_up_.push_back(order);
    for (const WorkerQuarantined& order : orders.quarantined) quarantined_.push_back(order.worker);
    for (const LeaseOrder& order : orders.leases) ++leases_[order.worker];
  }
  void Fail(const LeaseOrder& order, const proto::RunnerFailure& failure = kCrash) {
    scheduler_.Failed(order.worker, order.lease.fence, order.lease.run_id, failure);
    failed_on_[order.lease.run_id].push_back(order.worker);
  }
  void Finish(const LeaseOrder& order) {
    scheduler_.Completed(order.worker, order.lease.fence, order.lease.run_id, 1);
  }

  std::vector<RunGivenUp> given_up_;
  std::vector<InstanceId> quarantined_;
  std::map<InstanceId, int> leases_;
  std::map<RunId, std::vector<InstanceId>> failed_on_;
};

TEST_F(SchedulerTrustTest, AVerdictComesFromDifferentWorkers) {
  JoinTrusted({10, 11, 12, 13});
  SubmitRuns(1, 1);
  Work([&](const LeaseOrder& order) { Fail(order); });
  ASSERT_THAT(given_up_, SizeIs(1));
  EXPECT_EQ(given_up_[0].workers, 3U);
  EXPECT_EQ(given_up_[0].attempts, 3U);
  EXPECT_EQ((std::set<InstanceId>(failed_on_[1].begin(), failed_on_[1].end()).size()), 3U);
}

TEST_F(SchedulerTrustTest, AFailedRunWaitsForAnotherWorkerAlthoughThatOneIsBusy) {
  JoinTrusted({10, 11});
  SubmitRuns(1, 2);
  const SchedulerOrders orders = Decide();
  ASSERT_THAT(orders.leases, SizeIs(2));
  Fail(orders.leases[0]);
  EXPECT_THAT(Decide().leases, IsEmpty()) << "the other has a run";
  EXPECT_EQ(scheduler_.queued(), 1U);
  Finish(orders.leases[1]);
  const SchedulerOrders then = Decide();
  ASSERT_THAT(then.leases, SizeIs(1));
  EXPECT_EQ(then.leases[0].worker, orders.leases[1].worker);
}

TEST_F(SchedulerTrustTest, TheSecondAttemptIsOnAnotherHost) {
  JoinTrusted({10, 11, 12}, "bad");
  JoinTrusted({20}, "good");
  SubmitRuns(1, 1);
  Work([&](const LeaseOrder& order) { Fail(order); });
  ASSERT_THAT(given_up_, SizeIs(1));
  ASSERT_THAT(failed_on_[1], SizeIs(3));
  EXPECT_THAT((std::vector{failed_on_[1][0], failed_on_[1][1]}), testing::Contains(20U));
}

TEST_F(SchedulerTrustTest, AllWorkersOfOneHostCondemnNothingWhileAnotherHostHasOne) {
  JoinTrusted({10, 11, 12}, "bad");
  JoinTrusted({20}, "good");
  SubmitRuns(1, 4);
  Work([&](const LeaseOrder& order) { order.worker == 20 ? Finish(order) : Fail(order); });
  EXPECT_THAT(given_up_, IsEmpty());
  EXPECT_EQ(scheduler_.unfinished(), 0U);
}

TEST_F(SchedulerTrustTest, TwoWorkersTakeAsManyAttemptsAsOne) {
  JoinTrusted({10, 11});
  SubmitRuns(1, 1);
  Work([&](const LeaseOrder& order) { Fail(order); });
  ASSERT_THAT(given_up_, SizeIs(1));
  EXPECT_EQ(given_up_[0].attempts, 3U);
  EXPECT_EQ(given_up_[0].workers, 2U);
  EXPECT_EQ(scheduler_.Statistics().lone_verdicts, 0U);
}

TEST_F(SchedulerTrustTest, AnOnlyWorkersVerdictIsCounted) {
  JoinTrusted({10});
  SubmitRuns(1, 1);
  Work([&](const LeaseOrder& order) { Fail(order); });
  ASSERT_THAT(given_up_, SizeIs(1));
  EXPECT_EQ(given_up_[0].workers, 1U);
  EXPECT_EQ(scheduler_.Statistics().lone_verdicts, 1U);
}

TEST_F(SchedulerTrustTest, ALiarIsQuarantinedAndCondemnsNothing) {
  Join(10);
  Join(11);
  SubmitRuns(1, 50);
  Work([&](const LeaseOrder& order) { order.worker == 10 ? Fail(order) : Finish(order); });
  EXPECT_THAT(given_up_, IsEmpty());
  EXPECT_EQ(scheduler_.unfinished(), 0U);
  EXPECT_THAT(quarantined_, ElementsAre(10U));
  EXPECT_LT(leases_[10], 8);
  EXPECT_TRUE(scheduler_.DescribeWorkers()[0].second.record.quarantined);
  EXPECT_FALSE(scheduler_.AllQuarantined());
}

TEST_F(SchedulerTrustTest, AsManyLiarsAsHonestWorkersCondemnNothing) {
  for (InstanceId worker = 1; worker <= 8; ++worker) Join(worker);
  SubmitRuns(1, 200);
  Work([&](const LeaseOrder& order) { order.worker <= 4 ? Fail(order) : Finish(order); });
  EXPECT_THAT(given_up_, IsEmpty());
  EXPECT_EQ(scheduler_.unfinished(), 0U);
  EXPECT_THAT(quarantined_, testing::UnorderedElementsAre(1U, 2U, 3U, 4U));
}

// Who says hello first has some seconds in which it can condemn nothing, and does not get all the work.
TEST_F(SchedulerTrustTest, ALiarThatJoinsFirstCondemnsNothingBeforeTheOthersCame) {
  Join(10);
  SubmitRuns(1, 50);
  const auto liar = [&](const LeaseOrder& order) { order.worker == 10 ? Fail(order) : Finish(order); };
  for (int i = 0; i < 11; ++i) {
    Work(liar);
    clock_.Advance(milliseconds(250));
    scheduler_.WorkerHeard(10, clock_.Now());
  }
  EXPECT_THAT(given_up_, IsEmpty());
  EXPECT_LT(leases_[10], 15);
  Join(11);
  Work(liar);
  EXPECT_THAT(given_up_, IsEmpty());
  EXPECT_EQ(scheduler_.unfinished(), 0U);
  EXPECT_THAT(quarantined_, ElementsAre(10U));
}

TEST_F(SchedulerTrustTest, WithoutAnyFinishedRunTheFirstVerdictAloneWaits) {
  Join(10);
  SubmitRuns(1, 20);
  const auto crash = [&](const LeaseOrder& order) { Fail(order); };
  Work(crash);
  EXPECT_THAT(given_up_, IsEmpty());
  for (int i = 0; i < 13; ++i) {
    clock_.Advance(milliseconds(250));
    scheduler_.WorkerHeard(10, clock_.Now());
    Work(crash);
  }
  EXPECT_THAT(given_up_, SizeIs(20));
  for (const RunGivenUp& order : given_up_) EXPECT_LE(order.attempts, 3U);
}

// Honest workers on which every run truly crashes.
TEST_F(SchedulerTrustTest, AllRunsCrashingOnManyWorkersTakeThreeAttemptsEach) {
  for (InstanceId worker = 1; worker <= 8; ++worker) Join(worker);
  SubmitRuns(1, 100);
  int leases = 0;
  for (int i = 0; i < 40; ++i) {
    Work([&](const LeaseOrder& order) {
      ++leases;
      Fail(order);
    });
    clock_.Advance(milliseconds(250));
    for (InstanceId worker = 1; worker <= 8; ++worker) scheduler_.WorkerHeard(worker, clock_.Now());
  }
  EXPECT_THAT(given_up_, SizeIs(100));
  EXPECT_LE(leases, 330);
  EXPECT_THAT(quarantined_, IsEmpty());
}

TEST_F(SchedulerTrustTest, RunsThatTrulyCrashCostNoMoreAttemptsThanBefore) {
  for (InstanceId worker = 1; worker <= 6; ++worker) Join(worker);
  SubmitRuns(1, 300);
  std::map<RunId, int> attempts;
  Work([&](const LeaseOrder& order) {
    if (order.lease.run_id % 2 == 0) return Finish(order);
    ++attempts[order.lease.run_id];
    Fail(order);
  });
  EXPECT_THAT(given_up_, SizeIs(150));
  for (const auto& [run, times] : attempts) EXPECT_LE(times, run < 20 ? 4 : 3) << run;
  EXPECT_THAT(quarantined_, IsEmpty());
}

TEST_F(SchedulerTrustTest, AnUnreadableAnswerIsAStrikeAndNeverAVerdict) {
  Join(10);
  Join(11);
  SubmitRuns(1, 30);
  Work([&](const LeaseOrder& order) {
    if (order.worker == 11) return Finish(order);
    EXPECT_EQ(scheduler_.Unreadable(10, order.lease.fence, order.lease.run_id), Answer::kAccepted);
  });
  EXPECT_THAT(given_up_, IsEmpty());
  EXPECT_EQ(scheduler_.unfinished(), 0U);
  EXPECT_THAT(quarantined_, ElementsAre(10U));
  EXPECT_EQ(leases_[10], 3);
}

TEST_F(SchedulerTrustTest, WithAllWorkersQuarantinedRunsWaitForOthers) {
  Join(10);
  SubmitRuns(1, 3);
  Work([&](const LeaseOrder& order) { scheduler_.Unreadable(10, order.lease.fence, order.lease.run_id); });
  EXPECT_TRUE(scheduler_.AllQuarantined());
  EXPECT_EQ(scheduler_.queued(), 3U);
  Join(11);
  EXPECT_FALSE(scheduler_.AllQuarantined());
  Work([&](const LeaseOrder& order) { Finish(order); });
  EXPECT_EQ(scheduler_.unfinished(), 0U);
}

TEST_F(SchedulerTrustTest, AnswersToForeignLeasesAreStrikes) {
  Join(10);
  Join(11);
  SubmitRuns(1, 2);
  const SchedulerOrders orders = Decide();
  const Fence foreign = orders.leases[1].lease.fence;
  for (int i = 0; i < 3; ++i) EXPECT_EQ(scheduler_.Failed(10, foreign, 2, kCrash), Answer::kRejected);
  Note(Decide());
  EXPECT_THAT(quarantined_, ElementsAre(10U));
  Finish(orders.leases[1]);
  const SchedulerOrders then = Decide();
  ASSERT_THAT(then.leases, SizeIs(1)) << "what it had is given to the other";
  EXPECT_EQ(then.leases[0].worker, 11U);
}

// Of what is stored nothing depends on a liar: not even how the run is said to have failed.
TEST_F(SchedulerTrustTest, TheVerdictIsWhatTrustedWorkersSay) {
  JoinTrusted({11});
  Join(10);
  SubmitRuns(1, 1);
  Work([&](const LeaseOrder& order) { Fail(order, order.worker == 10 ? kHang : kCrash); });
  ASSERT_THAT(given_up_, SizeIs(1));
  EXPECT_EQ(given_up_[0].failure, kCrash);
}

// It holds a run for ever, and so cannot keep the others from ending it.
TEST_F(SchedulerTrustTest, AWorkerThatNeverAnswersDoesNotKeepAVerdictFromComing) {
  JoinTrusted({10});
  scheduler_.RunTook(0.1);
  Join(11);
  SubmitRuns(1, 1);
  std::vector<Fence> kept;
  std::vector<LeaseOrder> mine;
  for (int i = 0; i < 400 && given_up_.empty(); ++i) {
    const SchedulerOrders orders = Decide();
    Note(orders);
    for (const LeaseOrder& order : orders.leases) {
      if (order.worker == 10) {
        Fail(order);
      } else {
        kept.push_back(order.lease.fence);
      }
    }
    clock_.Advance(milliseconds(250));
    scheduler_.WorkerHeartbeat(10, {}, clock_.Now());
    scheduler_.WorkerHeartbeat(11, kept, clock_.Now());
  }
  ASSERT_THAT(given_up_, SizeIs(1));
  EXPECT_LE(failed_on_[1].size(), 3U);
}

TEST_F(SchedulerTrustTest, ManyShortRunsAreLeasedAheadOnlyToWhoHasFinishedSome) {
  scheduler_ = Scheduler(LeaseOptions(2), kFirstFence);
  scheduler_.RunTook(1e-6);
  SubmitRuns(1, 100);
  Join(10);
  const SchedulerOrders first = Decide();
  EXPECT_THAT(first.leases, SizeIs(2));
  Finish(first.leases[0]);
  EXPECT_THAT(Decide().leases, SizeIs(testing::Gt(90U)));
}

}  // namespace
}  // namespace gauntlet
