// How a worker leaves: drained by its master, or by a signal.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/worker/worker_state_fixture.h"

namespace gauntlet::worker {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;
using testing::IsEmpty;

TEST(WorkerLeavingTest, DrainFinishesWhatRunsGivesBackWhatWaitsAndLeavesWhenAcknowledged) {
  Worker worker = WelcomedWorker();
  worker.Lease(5);
  worker.Lease(6);
  const auto given_back = Sent<LeaseResult>(worker.Hear(Drain{"enough", true}));
  ASSERT_EQ(given_back.size(), 1u);
  EXPECT_EQ(given_back[0].fence, 6u);
  EXPECT_EQ(given_back[0].failure->kind, FailureKind::kExternal);
  EXPECT_THAT(Only<Exit>(worker.Hear(Acknowledge{{6}})), IsEmpty());

  EXPECT_EQ(Sent<LeaseResult>(worker.Finish(0)).size(), 1u);
  EXPECT_THAT(Only<Exit>(worker.last()), IsEmpty());
  const auto leaving = worker.Hear(Acknowledge{{5}});
  ASSERT_EQ(Sent<Goodbye>(leaving).size(), 1u);
  EXPECT_EQ(Sent<Goodbye>(leaving)[0].reason, "enough");
  ASSERT_EQ(Only<Exit>(leaving).size(), 1u);
  EXPECT_EQ(Only<Exit>(leaving)[0].code, kExitDone);
}

TEST(WorkerLeavingTest, DrainWithoutFinishingDropsWhatRuns) {
  Worker worker = WelcomedWorker();
  worker.Lease(5);
  const auto actions = worker.Hear(Drain{"now", false});
  EXPECT_EQ(Only<KillRunner>(actions).size(), 1u);
  ASSERT_EQ(Sent<LeaseResult>(actions).size(), 1u);
  EXPECT_EQ(Sent<LeaseResult>(actions)[0].failure->kind, FailureKind::kExternal);
  EXPECT_EQ(Only<Exit>(worker.Hear(Acknowledge{{5}})).size(), 1u);
}

TEST(WorkerLeavingTest, DrainingWorkerTakesNoLease) {
  Worker worker = WelcomedWorker();
  worker.Lease(5);
  worker.Hear(Drain{"enough", true});
  const auto actions = worker.Lease(7);
  EXPECT_THAT(Only<StartRun>(actions), IsEmpty());
  ASSERT_EQ(Sent<LeaseResult>(actions).size(), 1u);
  EXPECT_EQ(Sent<LeaseResult>(actions)[0].fence, 7u);
}

TEST(WorkerLeavingTest, DrainLeavesAtItsDeadlineWhenNobodyAcknowledges) {
  Worker worker = WelcomedWorker();
  worker.Lease(5);
  worker.Finish(0);
  worker.Hear(Drain{"enough", true});
  EXPECT_THAT(Only<Exit>(worker.Pass(milliseconds(4900))), IsEmpty());
  const auto actions = worker.Pass(milliseconds(200));
  EXPECT_EQ(Sent<Goodbye>(actions).size(), 1u);
  EXPECT_EQ(Only<Exit>(actions).size(), 1u);
}

TEST(WorkerLeavingTest, IdleWorkerLeavesAtTheFirstSignal) {
  Worker worker = WelcomedWorker();
  const auto actions = worker.Do(StopRequested{"SIGTERM"});
  EXPECT_EQ(Sent<Goodbye>(actions).size(), 1u);
  ASSERT_EQ(Only<Exit>(actions).size(), 1u);
  EXPECT_EQ(Only<Exit>(actions)[0].code, kExitDone);
}

TEST(WorkerLeavingTest, WorkerWithoutAMasterAndWithoutResultsLeavesSilentlyAtASignal) {
  Worker worker;
  const auto actions = worker.Do(StopRequested{"SIGINT"});
  EXPECT_THAT(Sent<Goodbye>(actions), IsEmpty());
  EXPECT_EQ(Only<Exit>(actions).size(), 1u);
}

TEST(WorkerLeavingTest, SignalTellsTheMasterFinishesTheRunAndLeaves) {
  Worker worker = WelcomedWorker();
  worker.Lease(5);
  const auto told = Sent<Drain>(worker.Do(StopRequested{"SIGTERM"}));
  ASSERT_EQ(told.size(), 1u);
  EXPECT_EQ(told[0].reason, "SIGTERM");
  worker.Finish(0);
  EXPECT_EQ(Only<Exit>(worker.Hear(Acknowledge{{5}})).size(), 1u);
}

TEST(WorkerLeavingTest, SecondSignalDropsTheRun) {
  Worker worker = WelcomedWorker();
  worker.Lease(5);
  worker.Do(StopRequested{"SIGINT"});
  EXPECT_THAT(Only<KillRunner>(worker.last()), IsEmpty());
  EXPECT_EQ(Only<KillRunner>(worker.Do(StopRequested{"SIGINT"})).size(), 1u);
}

TEST(WorkerLeavingTest, SignalledWorkerIsGoneBeforeThirtySecondsWhateverRuns) {
  Worker worker = WelcomedWorker();
  worker.Lease(5);
  worker.Do(StopRequested{"SIGTERM"});
  EXPECT_THAT(Only<KillRunner>(worker.Pass(milliseconds(19'900))), IsEmpty());
  const auto dropped = worker.Pass(milliseconds(200));
  EXPECT_EQ(Only<KillRunner>(dropped).size(), 1u);
  EXPECT_EQ(Only<Exit>(worker.Pass(milliseconds(5'000))).size(), 1u);
}

}  // namespace
}  // namespace gauntlet::worker
