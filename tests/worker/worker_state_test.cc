// The supervisor's decisions, without sockets, processes or waiting.
#include "worker/worker_state.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <deque>
#include <map>
#include <set>

namespace gauntlet::worker {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;
using testing::ElementsAre;
using testing::IsEmpty;

template <typename T>
std::vector<T> Only(const std::vector<WorkerAction>& actions) {
  std::vector<T> found;
  for (const WorkerAction& action : actions) {
    if (const auto* one = std::get_if<T>(&action)) found.push_back(*one);
  }
  return found;
}

template <typename Message>
std::vector<Message> Sent(const std::vector<WorkerAction>& actions) {
  std::vector<Message> found;
  for (const Send& send : Only<Send>(actions)) {
    if (const auto* message = std::get_if<Message>(&send.message)) found.push_back(*message);
  }
  return found;
}

// A state with a clock that is moved by hand.
class Worker {
 public:
  explicit Worker(std::uint32_t slots = 1, Duration orphan_timeout = seconds(600))
      : state_(Settings(slots, orphan_timeout), now_) {
    actions_ = state_.Start();
  }

  std::vector<WorkerAction> Do(WorkerEvent event) { return actions_ = state_.Handle(std::move(event), now_); }
  std::vector<WorkerAction> Hear(MasterMessage message) { return Do(WorkerEvent(std::move(message))); }
  // Time passes with a tick whenever the state wants one; all actions of that time.
  std::vector<WorkerAction> Pass(Duration time) {
    std::vector<WorkerAction> all;
    const TimePoint end = now_ + time;
    while (now_ < end) {
      now_ = std::min(end, std::max(state_.NextTick(), now_ + milliseconds(1)));
      for (WorkerAction& action : Do(ClockTick{})) all.push_back(std::move(action));
    }
    return all;
  }
  // Nothing is heard of time while it passes, as when the process is frozen.
  std::vector<WorkerAction> Jump(Duration time) {
    now_ += time;
    return Do(ClockTick{});
  }
  void Welcome(std::uint64_t epoch = 1) {
    Hear(worker::Welcome{.heartbeat = milliseconds(1000),
                         .epoch = epoch,
                         .cpu_limit_seconds = 60.0,
                         .memory_limit_bytes = 1 << 30});
  }
  void Ready() {
    for (int slot = 0; slot < static_cast<int>(slots_); ++slot) Do(SlotBecameReady{slot});
  }
  std::vector<WorkerAction> Lease(Fence fence, std::uint32_t attempt = 1) {
    return Hear(worker::Lease{
        .fence = fence, .run_id = fence + 1000, .spec = "spec" + std::to_string(fence), .attempt = attempt});
  }
  std::vector<WorkerAction> Finish(int slot, std::string result = "result", double cpu_seconds = 0.5) {
    return Do(RunFinished{slot, std::move(result), cpu_seconds});
  }
  WorkerState& state() { return state_; }
  const std::vector<WorkerAction>& last() const { return actions_; }

 private:
  WorkerSettings Settings(std::uint32_t slots, Duration orphan_timeout) {
    slots_ = slots;
    WorkerSettings settings;
    settings.identity.campaign_id = "c0ffee";
    settings.identity.instance_id = 7;
    settings.identity.slots = slots;
    settings.orphan_timeout = orphan_timeout;
    return settings;
  }

  std::uint32_t slots_ = 1;
  TimePoint now_{seconds(1000)};
  WorkerState state_;
  std::vector<WorkerAction> actions_;
};

Worker WelcomedWorker(std::uint32_t slots = 1) {
  Worker worker(slots);
  worker.Welcome();
  worker.Ready();
  return worker;
}

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
  EXPECT_EQ(starts[0].spec, "spec5");
  EXPECT_EQ(starts[0].cpu_limit_seconds, 60.0);
  EXPECT_EQ(starts[0].memory_limit_bytes, 1u << 30);
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
  EXPECT_THAT(results[0].failure->stderr_tail, testing::HasSubstr("1200 s"));
}

TEST(WorkerStateTest, AFrozenWorkerDoesNotHoldTheTimeAgainstItsRun) {
  Worker worker = WelcomedWorker();
  worker.Lease(5);
  EXPECT_THAT(Only<KillRunner>(worker.Jump(std::chrono::hours(2))), IsEmpty());
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
  EXPECT_EQ(starts[0].spec, "spec3");
}

// One slot, its runs take 0.1 ms, and the leases 2 to `last` were given to its runner at once.
Worker WorkerWithShortRuns(Fence last) {
  Worker worker = WelcomedWorker();
  for (Fence fence = 1; fence <= last; ++fence) worker.Lease(fence);
  worker.Finish(0, "result", 1e-4);
  return worker;
}

std::vector<std::string> Specs(const std::vector<WorkerAction>& actions) {
  std::vector<std::string> specs;
  for (const StartRun& start : Only<StartRun>(actions)) specs.push_back(start.spec);
  return specs;
}

TEST(WorkerStateTest, ShortRunsGoToTheRunnerAMillisecondAheadAndAgainWhenHalfAreDone) {
  Worker worker = WorkerWithShortRuns(30);
  EXPECT_EQ(Only<StartRun>(worker.last()).size(), 10u) << "of 0.1 ms each";
  for (int i = 0; i < 4; ++i) EXPECT_THAT(Specs(worker.Finish(0, "result", 1e-4)), IsEmpty());
  EXPECT_THAT(Specs(worker.Finish(0, "result", 1e-4)),
              ElementsAre("spec12", "spec13", "spec14", "spec15", "spec16"));
  EXPECT_EQ(worker.state().HeldLeases().size(), 30u) << "none is acknowledged";
}

TEST(WorkerStateTest, OneLongRunEndsTheRunningAhead) {
  Worker worker = WorkerWithShortRuns(12);
  for (int i = 0; i < 9; ++i) worker.Finish(0, "result", i == 3 ? 0.02 : 1e-4);
  EXPECT_THAT(Specs(worker.last()), IsEmpty()) << "one run is still there";
  EXPECT_THAT(Specs(worker.Finish(0, "result", 1e-4)), ElementsAre("spec12"));
  EXPECT_THAT(Specs(worker.Lease(13)), IsEmpty());
}

TEST(WorkerStateTest, DeadRunnerIsHeldAgainstItsFirstRunAloneAndTheOthersBeginAgainInOrder) {
  Worker worker = WorkerWithShortRuns(5);
  const auto results = Sent<LeaseResult>(worker.Do(RunnerDied{0, {FailureKind::kCrashed, 6, 0, ""}, 0.1}));
  ASSERT_EQ(results.size(), 1u);
  EXPECT_EQ(results[0].fence, 2u);
  EXPECT_THAT(worker.state().HeldLeases(), ElementsAre(1, 2, 3, 4, 5));
  EXPECT_THAT(Specs(worker.Do(SlotBecameReady{0})), ElementsAre("spec3", "spec4", "spec5"));
}

TEST(WorkerStateTest, CancelledRunAheadCostsNoRunnerAndIsNotReported) {
  Worker worker = WorkerWithShortRuns(4);
  EXPECT_THAT(Only<KillRunner>(worker.Hear(Cancel{3})), IsEmpty());
  EXPECT_THAT(worker.state().HeldLeases(), ElementsAre(1, 2, 4));
  EXPECT_EQ(Sent<LeaseResult>(worker.Finish(0)).size(), 1u);
  EXPECT_THAT(Sent<LeaseResult>(worker.Finish(0)), IsEmpty());
  const auto last = Sent<LeaseResult>(worker.Finish(0));
  ASSERT_EQ(last.size(), 1u);
  EXPECT_EQ(last[0].fence, 4u);
}

TEST(WorkerStateTest, CancelOfTheRunningOneLetsThoseBehindItBeginAgain) {
  Worker worker = WorkerWithShortRuns(4);
  EXPECT_EQ(Only<KillRunner>(worker.Hear(Cancel{2})).size(), 1u);
  EXPECT_THAT(Sent<LeaseResult>(worker.Finish(0)), IsEmpty()) << "crossed the cancel";
  worker.Do(RunnerDied{0, {FailureKind::kExternal, 9, 0, ""}, 0.0});
  EXPECT_THAT(Specs(worker.Do(SlotBecameReady{0})), ElementsAre("spec3", "spec4"));
}

TEST(WorkerStateTest, RunThatWasLeasedBeforeGoesAlone) {
  Worker worker = WelcomedWorker();
  worker.Lease(1);
  worker.Lease(2);
  worker.Lease(3, 2);
  worker.Lease(4);
  EXPECT_THAT(Specs(worker.Finish(0, "result", 1e-4)), ElementsAre("spec2"));
  EXPECT_THAT(Specs(worker.Finish(0, "result", 1e-4)), ElementsAre("spec3"));
  EXPECT_THAT(Specs(worker.Finish(0, "result", 1e-4)), ElementsAre("spec4"));
}

TEST(WorkerStateTest, DrainWithoutFinishingGivesBackWhatARunnerHadAhead) {
  Worker worker = WorkerWithShortRuns(4);
  const auto results = Sent<LeaseResult>(worker.Hear(Drain{"bye", false}));
  ASSERT_EQ(results.size(), 3u);
  for (const LeaseResult& result : results) {
    ASSERT_TRUE(result.failure.has_value());
    EXPECT_EQ(result.failure->kind, FailureKind::kExternal);
  }
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

TEST(WorkerStateTest, DrainFinishesWhatRunsGivesBackWhatWaitsAndLeavesWhenAcknowledged) {
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

TEST(WorkerStateTest, DrainWithoutFinishingDropsWhatRuns) {
  Worker worker = WelcomedWorker();
  worker.Lease(5);
  const auto actions = worker.Hear(Drain{"now", false});
  EXPECT_EQ(Only<KillRunner>(actions).size(), 1u);
  ASSERT_EQ(Sent<LeaseResult>(actions).size(), 1u);
  EXPECT_EQ(Sent<LeaseResult>(actions)[0].failure->kind, FailureKind::kExternal);
  EXPECT_EQ(Only<Exit>(worker.Hear(Acknowledge{{5}})).size(), 1u);
}

TEST(WorkerStateTest, DrainingWorkerTakesNoLease) {
  Worker worker = WelcomedWorker();
  worker.Lease(5);
  worker.Hear(Drain{"enough", true});
  const auto actions = worker.Lease(7);
  EXPECT_THAT(Only<StartRun>(actions), IsEmpty());
  ASSERT_EQ(Sent<LeaseResult>(actions).size(), 1u);
  EXPECT_EQ(Sent<LeaseResult>(actions)[0].fence, 7u);
}

TEST(WorkerStateTest, DrainLeavesAtItsDeadlineWhenNobodyAcknowledges) {
  Worker worker = WelcomedWorker();
  worker.Lease(5);
  worker.Finish(0);
  worker.Hear(Drain{"enough", true});
  EXPECT_THAT(Only<Exit>(worker.Pass(milliseconds(4900))), IsEmpty());
  const auto actions = worker.Pass(milliseconds(200));
  EXPECT_EQ(Sent<Goodbye>(actions).size(), 1u);
  EXPECT_EQ(Only<Exit>(actions).size(), 1u);
}

TEST(WorkerStateTest, IdleWorkerLeavesAtTheFirstSignal) {
  Worker worker = WelcomedWorker();
  const auto actions = worker.Do(StopRequested{"SIGTERM"});
  EXPECT_EQ(Sent<Goodbye>(actions).size(), 1u);
  ASSERT_EQ(Only<Exit>(actions).size(), 1u);
  EXPECT_EQ(Only<Exit>(actions)[0].code, kExitDone);
}

TEST(WorkerStateTest, WorkerWithoutAMasterAndWithoutResultsLeavesSilentlyAtASignal) {
  Worker worker;
  const auto actions = worker.Do(StopRequested{"SIGINT"});
  EXPECT_THAT(Sent<Goodbye>(actions), IsEmpty());
  EXPECT_EQ(Only<Exit>(actions).size(), 1u);
}

TEST(WorkerStateTest, SignalTellsTheMasterFinishesTheRunAndLeaves) {
  Worker worker = WelcomedWorker();
  worker.Lease(5);
  const auto told = Sent<Drain>(worker.Do(StopRequested{"SIGTERM"}));
  ASSERT_EQ(told.size(), 1u);
  EXPECT_EQ(told[0].reason, "SIGTERM");
  worker.Finish(0);
  EXPECT_EQ(Only<Exit>(worker.Hear(Acknowledge{{5}})).size(), 1u);
}

TEST(WorkerStateTest, SecondSignalDropsTheRun) {
  Worker worker = WelcomedWorker();
  worker.Lease(5);
  worker.Do(StopRequested{"SIGINT"});
  EXPECT_THAT(Only<KillRunner>(worker.last()), IsEmpty());
  EXPECT_EQ(Only<KillRunner>(worker.Do(StopRequested{"SIGINT"})).size(), 1u);
}

TEST(WorkerStateTest, SignalledWorkerIsGoneBeforeThirtySecondsWhateverRuns) {
  Worker worker = WelcomedWorker();
  worker.Lease(5);
  worker.Do(StopRequested{"SIGTERM"});
  EXPECT_THAT(Only<KillRunner>(worker.Pass(milliseconds(19'900))), IsEmpty());
  const auto dropped = worker.Pass(milliseconds(200));
  EXPECT_EQ(Only<KillRunner>(dropped).size(), 1u);
  EXPECT_EQ(Only<Exit>(worker.Pass(milliseconds(5'000))).size(), 1u);
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

TEST(WorkerStateTest, LongStopOfTheProcessGivesOneHeartbeatNotMany) {
  Worker worker = WelcomedWorker();
  worker.Hear(Heartbeat{});
  worker.Pass(milliseconds(1500));
  worker.Hear(Heartbeat{});  // arrives first after a stop: messages are read before the clock
  EXPECT_LE(Sent<Heartbeat>(worker.Pass(milliseconds(1000))).size(), 1u);
}

// Whatever happens in whatever order: every lease that was taken ends as exactly one kind of thing - still
// held, acknowledged or cancelled - no slot runs two leases unless runs are short, and no lease is in two.
RC_GTEST_PROP(WorkerStateProperty, NoLeaseIsLostAndNoneRunsTwice, ()) {
  const auto slots = *rc::gen::inRange(1, 4);
  Worker worker = WelcomedWorker(static_cast<std::uint32_t>(slots));
  std::set<Fence> taken;
  std::set<Fence> released;
  const double cpu_seconds = *rc::gen::element(0.5, 1e-4);
  std::map<int, std::deque<std::string>> busy;
  std::set<int> dying;
  Fence next = 1;
  const auto note = [&](const std::vector<WorkerAction>& actions) {
    for (const WorkerAction& action : actions) {  // in order: a killed runner's runs go elsewhere at once
      if (const auto* start = std::get_if<StartRun>(&action)) {
        RC_ASSERT(!dying.contains(start->slot));
        for (const auto& [other, specs] : busy) {
          RC_ASSERT(std::find(specs.begin(), specs.end(), start->spec) == specs.end());
        }
        busy[start->slot].push_back(start->spec);
        RC_ASSERT(busy[start->slot].size() <= (cpu_seconds < 1e-3 ? 10U : 1U));
      } else if (const auto* kill = std::get_if<KillRunner>(&action)) {
        RC_ASSERT(busy.erase(kill->slot) == 1U);
        dying.insert(kill->slot);
      }
    }
  };
  const int steps = *rc::gen::inRange(1, 60);
  for (int step = 0; step < steps; ++step) {
    const int slot = *rc::gen::inRange(0, slots);
    switch (*rc::gen::inRange(0, 9)) {
      case 0:
      case 7:
      case 8:
        if (worker.state().welcomed()) taken.insert(next);
        note(worker.Lease(next++));
        break;
      case 1:
        if (!busy.contains(slot)) break;
        busy[slot].pop_front();
        if (busy[slot].empty()) busy.erase(slot);
        note(worker.Finish(slot, "result", cpu_seconds));
        break;
      case 2: {
        const bool was_busy = busy.erase(slot) == 1;
        if (!was_busy && !dying.erase(slot)) break;
        note(worker.Do(RunnerDied{slot, {FailureKind::kCrashed, 6, 0, ""}, 0.1}));
        note(worker.Do(SlotBecameReady{slot}));
        break;
      }
      case 3: {
        const Fence fence = *rc::gen::inRange<Fence>(1, next + 1);
        released.insert(fence);
        note(worker.Hear(Acknowledge{{fence}}));
        break;
      }
      case 4: {
        const Fence fence = *rc::gen::inRange<Fence>(1, next + 1);
        released.insert(fence);
        note(worker.Hear(Cancel{fence}));
        break;
      }
      case 5:
        note(worker.Pass(milliseconds(*rc::gen::inRange(1, 12'000))));
        break;
      default:
        note(worker.Hear(Welcome{}));
        break;
    }
  }
  std::set<Fence> expected;
  for (const Fence fence : taken) {
    if (!released.contains(fence)) expected.insert(fence);
  }
  const auto held = worker.state().HeldLeases();
  const std::set<Fence> held_set(held.begin(), held.end());
  RC_ASSERT(held.size() == held_set.size());
  // A fence released before it was leased may be held.
  for (const Fence fence : expected) RC_ASSERT(held_set.contains(fence));
  for (const Fence fence : held_set) RC_ASSERT(taken.contains(fence));
}

}  // namespace
}  // namespace gauntlet::worker
