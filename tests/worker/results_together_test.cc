// Results that may wait at the worker for others (Lease::result_wait).
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/worker/worker_state_fixture.h"

namespace gauntlet::worker {
namespace {

using std::chrono::milliseconds;
using testing::ElementsAre;
using testing::IsEmpty;

constexpr milliseconds kWait{500};

// One slot, at run 1; the results of runs 1 to `last` may wait.
Worker WorkerWithPatientLeases(Fence last) {
  Worker worker = WelcomedWorker();
  for (Fence fence = 1; fence <= last; ++fence) worker.Lease(fence, 1, kWait);
  return worker;
}

std::vector<Fence> Answered(const std::vector<WorkerAction>& actions) {
  std::vector<Fence> fences;
  for (const LeaseResult& result : Sent<LeaseResult>(actions)) fences.push_back(result.fence);
  return fences;
}

TEST(ResultsTogetherTest, TheyAreSentWhenAsManyWaitAsLeasesDo) {
  Worker worker = WorkerWithPatientLeases(7);
  EXPECT_THAT(Answered(worker.Finish(0)), IsEmpty()) << "1 result, 5 leases";
  EXPECT_THAT(Answered(worker.Finish(0)), IsEmpty()) << "2 results, 4 leases";
  EXPECT_THAT(worker.state().HeldLeases(), ElementsAre(1, 2, 3, 4, 5, 6, 7)) << "all are still its own";
  EXPECT_THAT(Answered(worker.Finish(0)), ElementsAre(1, 2, 3)) << "3 results, 3 leases";
  EXPECT_THAT(Answered(worker.Finish(0)), IsEmpty()) << "1 result, 2 leases";
  EXPECT_THAT(Answered(worker.Finish(0)), ElementsAre(4, 5));
  EXPECT_THAT(Answered(worker.Finish(0)), ElementsAre(6));
  EXPECT_THAT(Answered(worker.Finish(0)), ElementsAre(7));
}

TEST(ResultsTogetherTest, NoneWaitsLongerThanItsLeaseSays) {
  Worker worker = WorkerWithPatientLeases(20);
  worker.Finish(0);
  EXPECT_THAT(Answered(worker.Pass(milliseconds(300))), IsEmpty());
  worker.Finish(0);
  EXPECT_THAT(Answered(worker.Pass(milliseconds(199))), IsEmpty());
  EXPECT_THAT(Answered(worker.Pass(milliseconds(1))), ElementsAre(1, 2)) << "the second goes along";
  EXPECT_THAT(Answered(worker.Pass(milliseconds(800))), IsEmpty()) << "each is sent once";
}

TEST(ResultsTogetherTest, WhatMayNotWaitAndFailuresGoAtOnce) {
  Worker worker = WorkerWithPatientLeases(1);
  worker.Lease(2);
  for (Fence fence = 3; fence <= 9; ++fence) worker.Lease(fence, 1, kWait);
  EXPECT_THAT(Answered(worker.Finish(0)), IsEmpty());
  EXPECT_THAT(Answered(worker.Finish(0)), ElementsAre(2));
  EXPECT_THAT(Answered(worker.Do(RunnerDied{0, {FailureKind::kCrashed, 6, 0, ""}, 0.1})), ElementsAre(3));
}

TEST(ResultsTogetherTest, TheyAreSentBeforeTheWorkerLeaves) {
  Worker stopped = WorkerWithPatientLeases(9);
  stopped.Finish(0);
  EXPECT_THAT(Answered(stopped.Do(StopRequested{"SIGTERM"})), testing::Contains(1));
  Worker drained = WorkerWithPatientLeases(9);
  drained.Finish(0);
  EXPECT_THAT(Answered(drained.Hear(Drain{"bye", false})), testing::Contains(1));
  Worker helpless = WorkerWithPatientLeases(9);
  helpless.Finish(0);
  EXPECT_THAT(Answered(helpless.Do(AllRunnersLost{})), testing::Contains(1));
}

TEST(ResultsTogetherTest, TheyAreSentOnceOnANewConnection) {
  Worker worker = WorkerWithPatientLeases(9);
  worker.Finish(0);
  worker.Do(ConnectionRestored{});
  EXPECT_THAT(Answered(worker.Finish(0)), IsEmpty());
  EXPECT_THAT(Answered(worker.Pass(milliseconds(900))), IsEmpty()) << "nobody listens";
  worker.Welcome();
  EXPECT_THAT(Answered(worker.last()), ElementsAre(1, 2));
  EXPECT_THAT(Answered(worker.Pass(milliseconds(900))), IsEmpty());
}

TEST(ResultsTogetherTest, WhatIsCancelledMeanwhileIsNotSent) {
  Worker worker = WorkerWithPatientLeases(9);
  worker.Finish(0);
  worker.Finish(0);
  EXPECT_THAT(Answered(worker.Hear(Cancel{1})), IsEmpty());
  EXPECT_THAT(Answered(worker.Pass(kWait)), ElementsAre(2));
}

}  // namespace
}  // namespace gauntlet::worker
