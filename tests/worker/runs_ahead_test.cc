// Very short runs, which a runner gets some of ahead.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/worker/worker_state_fixture.h"

namespace gauntlet::worker {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

// One slot, its runs take 0.1 ms, and the leases 2 to `last` were given to its runner at once.
Worker WorkerWithShortRuns(Fence last) {
  Worker worker = WelcomedWorker();
  for (Fence fence = 1; fence <= last; ++fence) worker.Lease(fence);
  worker.Finish(0, "result", 1e-4);
  return worker;
}

std::vector<std::string> Specs(const std::vector<WorkerAction>& actions) {
  std::vector<std::string> specs;
  for (const StartRun& start : Only<StartRun>(actions)) specs.push_back(start.job.spec);
  return specs;
}

TEST(RunsAheadTest, ShortRunsGoToTheRunnerAMillisecondAheadAndAgainWhenHalfAreDone) {
  Worker worker = WorkerWithShortRuns(30);
  EXPECT_EQ(Only<StartRun>(worker.last()).size(), 10u) << "of 0.1 ms each";
  for (int i = 0; i < 4; ++i) EXPECT_THAT(Specs(worker.Finish(0, "result", 1e-4)), IsEmpty());
  EXPECT_THAT(Specs(worker.Finish(0, "result", 1e-4)),
              ElementsAre("spec12", "spec13", "spec14", "spec15", "spec16"));
  EXPECT_EQ(worker.state().HeldLeases().size(), 30u) << "none is acknowledged";
}

TEST(RunsAheadTest, OneLongRunEndsTheRunningAhead) {
  Worker worker = WorkerWithShortRuns(12);
  for (int i = 0; i < 9; ++i) worker.Finish(0, "result", i == 3 ? 0.02 : 1e-4);
  EXPECT_THAT(Specs(worker.last()), IsEmpty()) << "one run is still there";
  EXPECT_THAT(Specs(worker.Finish(0, "result", 1e-4)), ElementsAre("spec12"));
  EXPECT_THAT(Specs(worker.Lease(13)), IsEmpty());
}

TEST(RunsAheadTest, DeadRunnerIsHeldAgainstItsFirstRunAloneAndTheOthersBeginAgainInOrder) {
  Worker worker = WorkerWithShortRuns(5);
  const auto results = Sent<LeaseResult>(worker.Do(RunnerDied{0, {FailureKind::kCrashed, 6, 0, ""}, 0.1}));
  ASSERT_EQ(results.size(), 1u);
  EXPECT_EQ(results[0].fence, 2u);
  EXPECT_THAT(worker.state().HeldLeases(), ElementsAre(1, 2, 3, 4, 5));
  EXPECT_THAT(Specs(worker.Do(SlotBecameReady{0})), ElementsAre("spec3", "spec4", "spec5"));
}

TEST(RunsAheadTest, CancelledRunAheadCostsNoRunnerAndIsNotReported) {
  Worker worker = WorkerWithShortRuns(4);
  EXPECT_THAT(Only<KillRunner>(worker.Hear(Cancel{3})), IsEmpty());
  EXPECT_THAT(worker.state().HeldLeases(), ElementsAre(1, 2, 4));
  EXPECT_EQ(Sent<LeaseResult>(worker.Finish(0)).size(), 1u);
  EXPECT_THAT(Sent<LeaseResult>(worker.Finish(0)), IsEmpty());
  const auto last = Sent<LeaseResult>(worker.Finish(0));
  ASSERT_EQ(last.size(), 1u);
  EXPECT_EQ(last[0].fence, 4u);
}

TEST(RunsAheadTest, CancelOfTheRunningOneLetsThoseBehindItBeginAgain) {
  Worker worker = WorkerWithShortRuns(4);
  EXPECT_EQ(Only<KillRunner>(worker.Hear(Cancel{2})).size(), 1u);
  EXPECT_THAT(Sent<LeaseResult>(worker.Finish(0)), IsEmpty()) << "crossed the cancel";
  worker.Do(RunnerDied{0, {FailureKind::kExternal, 9, 0, ""}, 0.0});
  EXPECT_THAT(Specs(worker.Do(SlotBecameReady{0})), ElementsAre("spec3", "spec4"));
}

TEST(RunsAheadTest, RunThatWasLeasedBeforeGoesAlone) {
  Worker worker = WelcomedWorker();
  worker.Lease(1);
  worker.Lease(2);
  worker.Lease(3, 2);
  worker.Lease(4);
  EXPECT_THAT(Specs(worker.Finish(0, "result", 1e-4)), ElementsAre("spec2"));
  EXPECT_THAT(Specs(worker.Finish(0, "result", 1e-4)), IsEmpty()) << "its runner is renewed first";
  worker.Do(RunnerDied{0, {FailureKind::kExternal, 9, 0, ""}, 0.0});
  EXPECT_THAT(Specs(worker.Do(SlotBecameReady{0})), ElementsAre("spec3"));
  EXPECT_THAT(Specs(worker.Finish(0, "result", 1e-4)), ElementsAre("spec4"));
}

TEST(RunsAheadTest, DrainWithoutFinishingGivesBackWhatARunnerHadAhead) {
  Worker worker = WorkerWithShortRuns(4);
  const auto results = Sent<LeaseResult>(worker.Hear(Drain{"bye", false}));
  ASSERT_EQ(results.size(), 3u);
  for (const LeaseResult& result : results) {
    ASSERT_TRUE(result.failure.has_value());
    EXPECT_EQ(result.failure->kind, FailureKind::kExternal);
  }
}

TEST(RunsAheadTest, WhileARunnerHasMoreThanHalfOfThemNobodyNeedsTheSupervisor) {
  Worker worker = WelcomedWorker();
  EXPECT_EQ(worker.state().Nap(), Duration::zero()) << "idle";
  worker.Lease(1);
  EXPECT_EQ(worker.state().Nap(), Duration::zero()) << "nothing is known of its runs";
  worker = WorkerWithShortRuns(20);
  EXPECT_EQ(worker.state().Nap(), std::chrono::microseconds(500));
  for (int i = 0; i < 9; ++i) worker.Finish(0, "result", 1e-4);
  EXPECT_GT(worker.state().Nap(), Duration::zero()) << "refilled";
  for (int i = 0; i < 6; ++i) worker.Finish(0, "result", 1e-4);
  EXPECT_EQ(worker.state().Nap(), Duration::zero()) << "four are left";
}

TEST(RunsAheadTest, ADrainingSupervisorAndOneWithAnIdleRunnerAreAlwaysAwake) {
  Worker draining = WorkerWithShortRuns(20);
  draining.Hear(Drain{"bye", true});
  EXPECT_EQ(draining.state().Nap(), Duration::zero());
  Worker two = WelcomedWorker(2);
  two.Lease(1);
  two.Finish(0, "result", 1e-4);
  for (Fence fence = 2; fence <= 12; ++fence) two.Lease(fence);
  two.Do(RunnerDied{1, {FailureKind::kCrashed, 6, 0, ""}, 0.1});
  EXPECT_EQ(two.state().Nap(), Duration::zero());
}

}  // namespace
}  // namespace gauntlet::worker
