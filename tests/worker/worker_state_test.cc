// The supervisor's decisions, without sockets, processes or waiting.
#include "worker/worker_state.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/worker/worker_state_fixture.h"

namespace gauntlet::worker {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;
using testing::ElementsAre;
using testing::IsEmpty;

TEST(WorkerStateTest, SaysHelloAtOnceAndEverySecondUntilWelcomed) {
  Worker worker;
  ASSERT_EQ(Sent<Hello>(worker.last()).size(), 1u);
  EXPECT_EQ(Sent<Hello>(worker.last())[0].campaign_id, "c0ffee");
  EXPECT_THAT(Sent<Hello>(worker.Pass(milliseconds(900))), IsEmpty());
  EXPECT_EQ(Sent<Hello>(worker.Pass(milliseconds(4200))).size(), 5u);
  worker.Welcome();
  EXPECT_THAT(Sent<Hello>(worker.Pass(seconds(2))), IsEmpty());
}

TEST(WorkerStateTest, LooksAtAccessFileWithEveryRepeatedHelloAndReconnectsAfterTen) {
  Worker worker;
  const auto actions = worker.Pass(milliseconds(9500));
  EXPECT_EQ(Only<CheckAccess>(actions).size(), 9u);
  EXPECT_THAT(Only<Reconnect>(actions), IsEmpty());
  EXPECT_EQ(Only<Reconnect>(worker.Pass(seconds(1))).size(), 1u);
}

TEST(WorkerStateTest, RefusedWorkerExitsWithTheMastersReason) {
  Worker worker;
  worker.Hear(Refused{"golden hash 12 instead of 13"});
  const auto exits = Only<Exit>(worker.last());
  ASSERT_EQ(exits.size(), 1u);
  EXPECT_EQ(exits[0].code, kExitRefused);
  EXPECT_EQ(exits[0].reason, "golden hash 12 instead of 13");
}

TEST(WorkerStateTest, ExitsWhenNoMasterIsHeardForTheOrphanTimeout) {
  Worker worker(1, seconds(30));
  EXPECT_THAT(Only<Exit>(worker.Pass(seconds(29))), IsEmpty());
  const auto exits = Only<Exit>(worker.Pass(seconds(2)));
  ASSERT_EQ(exits.size(), 1u);
  EXPECT_EQ(exits[0].code, kExitOrphaned);
  EXPECT_THAT(worker.Pass(seconds(5)), IsEmpty());
}

TEST(WorkerStateTest, SaysThatNobodyAnswersAfterThreeSeconds) {
  Worker worker(1, seconds(50));
  EXPECT_THAT(Only<Note>(worker.Pass(milliseconds(2900))), IsEmpty());
  const auto notes = Only<Note>(worker.Pass(milliseconds(1200)));
  ASSERT_FALSE(notes.empty());
  EXPECT_EQ(notes[0].text,
            "no master answers: it has ended, cannot be reached from here, or does not know this worker's "
            "keys; trying for 50 s in all");
}

TEST(WorkerStateTest, OrphanTimeIsCountedFromTheMastersLastWord) {
  Worker worker(1, seconds(30));
  worker.Pass(seconds(25));
  worker.Welcome();
  EXPECT_THAT(Only<Exit>(worker.Pass(seconds(29))), IsEmpty());
  EXPECT_EQ(Only<Exit>(worker.Pass(seconds(3))).size(), 1u);
}

TEST(WorkerStateTest, StartsALeaseWithTheMastersLimits) {
  Worker worker = WelcomedWorker();
  const auto starts = Only<StartRun>(worker.Lease(5));
  ASSERT_EQ(starts.size(), 1u);
  EXPECT_EQ(starts[0].slot, 0);
  EXPECT_EQ(starts[0].job.spec, "spec5");
  EXPECT_EQ(starts[0].job.cpu_limit_seconds, 60.0);
  EXPECT_EQ(starts[0].job.memory_limit_bytes, 1u << 30);
  EXPECT_TRUE(starts[0].job.without_ways);
}

TEST(WorkerStateTest, ARunThatOnlyWaitsIsEndedAfterTwentyTimesItsCpuTime) {
  Worker worker = WelcomedWorker();
  worker.Lease(5);
  const auto pass = [&worker](int minutes) {
    std::vector<WorkerAction> all;
    for (int second = 0; second < 60 * minutes; ++second) {
      for (WorkerAction& action : worker.Pass(seconds(1))) all.push_back(std::move(action));
      worker.Hear(Heartbeat{});
    }
    return all;
  };
  EXPECT_THAT(Only<KillRunner>(pass(19)), IsEmpty()) << "60 s of CPU time may take long on a crowded machine";
  const auto actions = pass(2);
  EXPECT_EQ(Only<KillRunner>(actions).size(), 1u);
  const auto results = Sent<LeaseResult>(actions);
  ASSERT_GE(results.size(), 1u);
  ASSERT_TRUE(results[0].failure.has_value());
  EXPECT_EQ(results[0].failure->kind, FailureKind::kHung);
  EXPECT_EQ(results[0].failure->stderr_tail, "no end after 1200 s: it waits");
}

TEST(WorkerStateTest, AFrozenWorkerDoesNotHoldTheTimeAgainstItsRun) {
  Worker worker = WelcomedWorker();
  worker.Lease(5);
  EXPECT_THAT(Only<KillRunner>(worker.Jump(std::chrono::hours(2))), IsEmpty());
}

TEST(WorkerStateTest, AFrozenWorkerDoesNotHoldTheTimeAgainstItsMaster) {
  Worker worker = WelcomedWorker();
  worker.Lease(5);
  worker.Finish(0);
  EXPECT_EQ(Only<Reconnect>(worker.Jump(std::chrono::hours(2))).size(), 1u);
  EXPECT_THAT(Only<Exit>(worker.Pass(seconds(590))), IsEmpty());
  worker.Welcome();
  EXPECT_EQ(Sent<LeaseResult>(worker.last()).size(), 1u);
}

TEST(WorkerStateTest, ARepeatedRunGetsARunnerThatHasSimulatedNothing) {
  Worker worker = WelcomedWorker(2);
  worker.Lease(1);
  worker.Finish(0);
  const auto renewed = worker.Do(RunnerDied{1, {FailureKind::kExternal, 9, 0, ""}, 0.0});
  EXPECT_THAT(Only<StartRun>(renewed), IsEmpty());
  const auto kills = Only<KillRunner>(worker.Lease(2, /*attempt=*/2));
  ASSERT_EQ(kills.size(), 1u);
  EXPECT_EQ(kills[0].slot, 0) << "what run 1 left in it may be what fails run 2";
  EXPECT_THAT(Only<StartRun>(worker.last()), IsEmpty());
  EXPECT_THAT(Sent<LeaseResult>(worker.Do(RunnerDied{0, {FailureKind::kExternal, 9, 0, ""}, 0.0})),
              IsEmpty());
  const auto starts = Only<StartRun>(worker.Do(SlotBecameReady{0}));
  ASSERT_EQ(starts.size(), 1u);
  EXPECT_EQ(starts[0].job.spec, "spec2");
}

TEST(WorkerStateTest, LeaseWaitsUntilARunnerIsReady) {
  Worker worker;
  worker.Welcome();
  EXPECT_THAT(Only<StartRun>(worker.Lease(5)), IsEmpty());
  EXPECT_EQ(Only<StartRun>(worker.Do(SlotBecameReady{0})).size(), 1u);
}

TEST(WorkerStateTest, LeasesBeyondTheSlotsWaitInOrder) {
  Worker worker = WelcomedWorker(2);
  for (const Fence fence : {1, 2, 3, 4}) worker.Lease(fence);
  EXPECT_THAT(worker.state().HeldLeases(), ElementsAre(1, 2, 3, 4));
  const auto starts = Only<StartRun>(worker.Finish(1));
  ASSERT_EQ(starts.size(), 1u);
  EXPECT_EQ(starts[0].slot, 1);
  EXPECT_EQ(starts[0].job.spec, "spec3");
}

TEST(WorkerStateTest, LeaseThatComesTwiceRunsOnce) {
  Worker worker = WelcomedWorker(2);
  worker.Lease(1);
  EXPECT_THAT(Only<StartRun>(worker.Lease(1)), IsEmpty());
  worker.Finish(0);
  const auto repeated = worker.Lease(1);
  EXPECT_THAT(Only<StartRun>(repeated), IsEmpty());
  EXPECT_EQ(Sent<LeaseResult>(repeated).size(), 1u) << "the result is known: it is sent again";
}

TEST(WorkerStateTest, HeartbeatsComeInTheMastersRhythmAndNameWhatIsHeld) {
  Worker worker = WelcomedWorker();
  worker.Lease(5);
  worker.Lease(6);
  const auto beats = Sent<Heartbeat>(worker.Pass(milliseconds(3500)));
  ASSERT_EQ(beats.size(), 3u);
  EXPECT_THAT(beats[2].held_leases, ElementsAre(5, 6));
  EXPECT_EQ(beats[2].sequence, beats[1].sequence + 1);
}

TEST(WorkerStateTest, ResultIsHeldUntilAcknowledged) {
  Worker worker = WelcomedWorker();
  worker.Lease(5);
  const auto results = Sent<LeaseResult>(worker.Finish(0, "the result"));
  ASSERT_EQ(results.size(), 1u);
  EXPECT_EQ(results[0].fence, 5u);
  EXPECT_EQ(results[0].run_id, 1005u);
  EXPECT_EQ(results[0].result, "the result");
  EXPECT_FALSE(results[0].failure.has_value());
  EXPECT_THAT(worker.state().HeldLeases(), ElementsAre(5));
  worker.Hear(Acknowledge{{5}});
  EXPECT_THAT(worker.state().HeldLeases(), IsEmpty());
}

TEST(WorkerStateTest, UnacknowledgedResultIsSentAgainAfterTenHeartbeats) {
  Worker worker = WelcomedWorker();
  worker.Lease(5);
  worker.Finish(0);
  int results = 0;
  for (int i = 0; i < 12; ++i) {
    worker.Hear(Heartbeat{});
    results += static_cast<int>(Sent<LeaseResult>(worker.Pass(seconds(1))).size());
  }
  EXPECT_EQ(results, 1);
}

TEST(WorkerStateTest, RunnerFailureIsReportedAndTheSlotWaitsForANewRunner) {
  Worker worker = WelcomedWorker();
  worker.Lease(5);
  worker.Lease(6);
  const RunnerFailure crash{FailureKind::kCrashed, 11, 0, "boom"};
  const auto actions = worker.Do(RunnerDied{0, crash, 1.5});
  const auto results = Sent<LeaseResult>(actions);
  ASSERT_EQ(results.size(), 1u);
  EXPECT_EQ(results[0].failure, crash);
  EXPECT_EQ(results[0].cpu_seconds, 1.5);
  EXPECT_THAT(results[0].result, IsEmpty());
  EXPECT_THAT(Only<StartRun>(actions), IsEmpty());
  EXPECT_EQ(Only<StartRun>(worker.Do(SlotBecameReady{0})).size(), 1u);
}

TEST(WorkerStateTest, IdleRunnersDeathIsNobodysResult) {
  Worker worker = WelcomedWorker();
  EXPECT_THAT(worker.Do(RunnerDied{0, {}, 0.0}), IsEmpty());
  EXPECT_THAT(Only<StartRun>(worker.Lease(5)), IsEmpty());
  EXPECT_EQ(Only<StartRun>(worker.Do(SlotBecameReady{0})).size(), 1u);
}

TEST(WorkerStateTest, CancelKillsARunningRunAndReportsNothing) {
  Worker worker = WelcomedWorker();
  worker.Lease(5);
  const auto kills = Only<KillRunner>(worker.Hear(Cancel{5}));
  ASSERT_EQ(kills.size(), 1u);
  EXPECT_THAT(worker.state().HeldLeases(), IsEmpty());
  EXPECT_THAT(worker.Do(RunnerDied{0, {}, 0.0}), IsEmpty());
}

TEST(WorkerStateTest, ReportThatCrossesACancelIsDroppedAndTheDyingRunnerGetsNoJob) {
  Worker worker = WelcomedWorker();
  worker.Lease(5);
  worker.Hear(Cancel{5});
  EXPECT_THAT(worker.Finish(0), IsEmpty());
  EXPECT_THAT(Only<StartRun>(worker.Lease(6)), IsEmpty());
  worker.Do(RunnerDied{0, {}, 0.0});
  EXPECT_EQ(Only<StartRun>(worker.Do(SlotBecameReady{0})).size(), 1u);
}

TEST(WorkerStateTest, CancelDropsWhatWaitsAndWhatIsFinished) {
  Worker worker = WelcomedWorker();
  worker.Lease(5);
  worker.Lease(6);
  EXPECT_THAT(worker.Hear(Cancel{6}), IsEmpty());
  worker.Finish(0);
  EXPECT_THAT(worker.Hear(Cancel{5}), IsEmpty());
  EXPECT_THAT(worker.state().HeldLeases(), IsEmpty());
}

TEST(WorkerStateTest, AcknowledgedRunThatStillRunsIsNotWantedAnyMore) {
  Worker worker = WelcomedWorker();
  worker.Lease(5);
  EXPECT_EQ(Only<KillRunner>(worker.Hear(Acknowledge{{5}})).size(), 1u);
  EXPECT_THAT(worker.state().HeldLeases(), IsEmpty());
}

TEST(WorkerStateTest, SilenceOfThreeHeartbeatsMakesItLookAtTheAccessFile) {
  Worker worker = WelcomedWorker();
  EXPECT_THAT(Only<CheckAccess>(worker.Pass(milliseconds(2900))), IsEmpty());
  EXPECT_EQ(Only<CheckAccess>(worker.Pass(milliseconds(200))).size(), 1u);
}

TEST(WorkerStateTest, SilenceOfThreeHeartbeatsMakesItSayHelloOnceAndGoOnMeanwhile) {
  Worker worker = WelcomedWorker();
  worker.Lease(5);
  EXPECT_THAT(Sent<Hello>(worker.Pass(milliseconds(2900))), IsEmpty());
  const auto hellos = Sent<Hello>(worker.Pass(seconds(7)));
  ASSERT_EQ(hellos.size(), 1u) << "a frozen master finds one, not one for every second";
  EXPECT_THAT(hellos[0].held_leases, ElementsAre(5));
  EXPECT_TRUE(worker.state().welcomed());
  EXPECT_EQ(Sent<LeaseResult>(worker.Finish(0)).size(), 1u);
  // Another silence, another hello.
  worker.Welcome();
  EXPECT_EQ(Sent<Hello>(worker.Pass(seconds(4))).size(), 1u);
}

TEST(WorkerStateTest, RestoredConnectionMakesItSayHelloAtOnceAndSendAgainWhatMayBeLost) {
  Worker worker = WelcomedWorker();
  worker.Lease(5);
  worker.Finish(0);
  worker.Lease(6);
  const auto restored = worker.Do(ConnectionRestored{});
  EXPECT_THAT(Only<Reconnect>(restored), IsEmpty());
  EXPECT_THAT(Only<KillRunner>(restored), IsEmpty());
  const auto hellos = Sent<Hello>(restored);
  ASSERT_EQ(hellos.size(), 1u);
  EXPECT_THAT(hellos[0].held_leases, ElementsAre(5, 6));
  EXPECT_THAT(Sent<LeaseResult>(worker.Finish(0)), IsEmpty()) << "a stranger's result is not listened to";
  worker.Welcome();
  const auto results = Sent<LeaseResult>(worker.last());
  ASSERT_EQ(results.size(), 2u);
  EXPECT_EQ(results[0].fence, 5u);
  EXPECT_EQ(results[1].fence, 6u);
}

TEST(WorkerStateTest, SilenceOfTenHeartbeatsMakesItReconnectAndSayHelloWithWhatItHolds) {
  Worker worker = WelcomedWorker();
  worker.Lease(5);
  worker.Finish(0);
  worker.Lease(6);
  EXPECT_THAT(Only<Reconnect>(worker.Pass(milliseconds(9900))), IsEmpty());
  const auto actions = worker.Pass(milliseconds(200));
  EXPECT_EQ(Only<Reconnect>(actions).size(), 1u);
  const auto hellos = Sent<Hello>(actions);
  ASSERT_EQ(hellos.size(), 1u);
  EXPECT_THAT(hellos[0].held_leases, ElementsAre(5, 6));
}

TEST(WorkerStateTest, AMasterThatSpeaksIsNotSilent) {
  Worker worker = WelcomedWorker();
  for (int i = 0; i < 60; ++i) {
    worker.Hear(Heartbeat{});
    EXPECT_THAT(Only<Reconnect>(worker.Pass(seconds(1))), IsEmpty());
  }
}

TEST(WorkerStateTest, NewMasterGetsTheResultsAndTheRunGoesOn) {
  Worker worker = WelcomedWorker(2);
  worker.Lease(5);
  worker.Lease(6);
  worker.Finish(0);
  const auto moved = worker.Do(MasterMoved{});
  EXPECT_EQ(Only<Reconnect>(moved).size(), 1u);
  EXPECT_EQ(Sent<Hello>(moved).size(), 1u);
  EXPECT_THAT(Sent<LeaseResult>(worker.Finish(1)), IsEmpty()) << "nobody to send it to yet";
  worker.Welcome(2);
  const auto results = Sent<LeaseResult>(worker.last());
  ASSERT_EQ(results.size(), 2u);
  EXPECT_EQ(results[0].fence, 5u);
  EXPECT_EQ(results[1].fence, 6u);
}

TEST(WorkerStateTest, MasterOfAnOlderEpochIsNotListenedTo) {
  Worker worker;
  worker.Welcome(4);
  worker.Do(MasterMoved{});
  worker.Welcome(3);
  EXPECT_FALSE(worker.state().welcomed());
  EXPECT_EQ(Only<Note>(worker.last()).size(), 1u);
  worker.Welcome(5);
  EXPECT_TRUE(worker.state().welcomed());
}

TEST(WorkerStateTest, WithoutRunnersItGivesEverythingBackAndExitsWithAnError) {
  Worker worker = WelcomedWorker();
  worker.Lease(5);
  worker.Lease(6);
  const auto actions = worker.Do(AllRunnersLost{});
  EXPECT_EQ(Sent<LeaseResult>(actions).size(), 2u);
  const auto exits = Only<Exit>(worker.Hear(Acknowledge{{5, 6}}));
  ASSERT_EQ(exits.size(), 1u);
  EXPECT_EQ(exits[0].code, kExitInternal);
}

TEST(WorkerStateTest, WithoutARunnerForTenSecondsItGivesItsLeasesBackAndExitsWithTheReason) {
  Worker worker(2);
  worker.Welcome();
  worker.Lease(5);
  worker.Lease(6);
  const auto fail = [&worker](int seconds_of_it) {
    std::vector<WorkerAction> all;
    for (int second = 0; second < seconds_of_it; ++second) {
      for (WorkerAction& action : worker.Do(NoRunnerStarted{"no runner: because"}))
        all.push_back(std::move(action));
      worker.Hear(Heartbeat{});
      worker.Pass(seconds(1));
    }
    return all;
  };
  EXPECT_THAT(fail(10), IsEmpty());
  const auto actions = fail(1);
  const auto results = Sent<LeaseResult>(actions);
  ASSERT_EQ(results.size(), 2u);
  for (const LeaseResult& result : results) {
    EXPECT_EQ(result.failure->kind, FailureKind::kExternal);
    EXPECT_EQ(result.failure->stderr_tail, "no runner: because");
  }
  ASSERT_EQ(Sent<Drain>(actions).size(), 1u);
  EXPECT_FALSE(Sent<Drain>(actions)[0].finish_current);
  const auto exits = Only<Exit>(worker.Hear(Acknowledge{{5, 6}}));
  ASSERT_EQ(exits.size(), 1u);
  EXPECT_EQ(exits[0].code, kExitInternal);
  EXPECT_EQ(exits[0].reason, "no runner: because");
}

TEST(WorkerStateTest, OneRunnerIsEnoughToStay) {
  Worker worker(2);
  worker.Welcome();
  worker.Lease(5);
  for (int second = 0; second < 30; ++second) {
    worker.Do(NoRunnerStarted{"no runner: because"});
    worker.Hear(Heartbeat{});
    if (second == 8) worker.Do(SlotBecameReady{1});
    EXPECT_THAT(Only<Exit>(worker.Pass(seconds(1))), IsEmpty());
  }
  EXPECT_THAT(worker.state().HeldLeases(), ElementsAre(5));
}

TEST(WorkerStateTest, LongStopOfTheProcessGivesOneHeartbeatNotMany) {
  Worker worker = WelcomedWorker();
  worker.Hear(Heartbeat{});
  worker.Pass(milliseconds(1500));
  worker.Hear(Heartbeat{});  // arrives first after a stop: messages are read before the clock
  EXPECT_LE(Sent<Heartbeat>(worker.Pass(milliseconds(1000))).size(), 1u);
}

}  // namespace
}  // namespace gauntlet::worker
