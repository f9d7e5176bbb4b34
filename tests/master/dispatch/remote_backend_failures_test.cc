// What the master makes of failed runs and of messages that are not what they should be.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "tests/master/dispatch/remote_backend_fixture.h"

namespace gauntlet {
namespace {

using std::chrono::milliseconds;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::SizeIs;

TEST_F(RemoteBackendTest, ThreeCrashesBecomeAVerdictWithAReproducibleMessage) {
  const std::vector<FinishedRun> finished = FailRun1([this](const v1::Lease& lease, int attempt) {
    SendFailure("p", lease, v1::RunnerFailure::KIND_CRASHED, 11,
                fmt::format("assertion failed at 0x{}", attempt));
  });
  EXPECT_EQ(finished[0].result.verdict, sim::Verdict::kCrashed);
  EXPECT_EQ(finished[0].result.message, "crashed with signal 11");
  EXPECT_EQ(finished[0].result.hash, sim::HashOf(finished[0].result));
  EXPECT_EQ(finished[0].attempt, 3U);
  EXPECT_THAT(EventsOf("runner-failure"), HasSubstr("assertion failed at 0x2"));
}

TEST_F(RemoteBackendTest, EveryKindOfOwnFailureHasItsVerdict) {
  struct Expectation {
    v1::RunnerFailure::Kind kind;
    sim::Verdict verdict;
    std::string message;
  };
  const std::vector<Expectation> expectations = {
      {v1::RunnerFailure::KIND_CRASHED, sim::Verdict::kCrashed, "crashed with exit code 0"},
      {v1::RunnerFailure::KIND_HUNG, sim::Verdict::kHung, "exceeded its CPU time"},
      {v1::RunnerFailure::KIND_OUT_OF_MEMORY, sim::Verdict::kOutOfMemory, "exceeded its memory"}};
  SayHello("p", HelloOf(kAnna));
  EarnTrust("p");
  RunId run = 0;
  for (const Expectation& expectation : expectations) {
    backend_->Submit({{++run, "spec"}});
    std::vector<FinishedRun> finished;
    for (int attempt = 1; attempt <= 3; ++attempt) {
      Poll();
      SendFailure("p", LeasesSentTo("p").at(0), expectation.kind, 0, "");
      finished = Poll();
    }
    ASSERT_THAT(finished, SizeIs(1));
    EXPECT_EQ(finished[0].result.verdict, expectation.verdict);
    EXPECT_EQ(finished[0].result.message, expectation.message);
  }
}

TEST_F(RemoteBackendTest, AResultOfMoreCpuTimeThanItMayTakeIsNotBelieved) {
  SayHello("p", HelloOf(kAnna));
  for (RunId run = 1; const double cpu_time : {1e9, -1.0, std::nan("")}) {
    backend_->Submit({{run, "spec"}});
    Poll();
    SendResult("p", LeasesSentTo("p").at(0), result_, cpu_time);
    EXPECT_THAT(Poll(), IsEmpty());
    ++run;
  }
  EXPECT_THAT(EventsOf("worker-quarantined"), HasSubstr("3 of its answers could not be read"));
}

TEST_F(RemoteBackendTest, WhatIsGivenBackNeverBecomesAVerdict) {
  backend_->Submit({{1, "spec"}});
  SayHello("p", HelloOf(kAnna));
  for (int attempt = 1; attempt <= 10; ++attempt) {
    Poll();
    SendFailure("p", LeasesSentTo("p").at(0), v1::RunnerFailure::KIND_EXTERNAL, 0, "");
  }
  EXPECT_THAT(Poll(), IsEmpty());
  SendResult("p", LeasesSentTo("p").at(0), result_);
  EXPECT_EQ(Poll().at(0).attempt, 11U);
}

// Such a run would be tried for ever; the same is told three times, and then once more with its count.
TEST_F(RemoteBackendTest, ARunThatIsAlwaysKilledEndsWithAVerdictAndAFewEvents) {
  SayHello("p", HelloOf(kAnna));
  EarnTrust("p");
  backend_->Submit({{1, "spec"}});
  std::vector<FinishedRun> finished;
  int attempts = 0;
  for (int second = 0; second < 30 && finished.empty(); ++second) {
    finished = Poll();
    for (const v1::Lease& lease : LeasesSentTo("p")) {
      ++attempts;
      SendFailure("p", lease, v1::RunnerFailure::KIND_EXTERNAL, 9, "");
    }
    clock_.Advance(std::chrono::seconds(1));
    SendHeartbeat("p");
  }
  ASSERT_EQ(finished.size(), 1U);
  EXPECT_EQ(attempts, 3);
  EXPECT_EQ(finished[0].result.verdict, sim::Verdict::kKilled);
  EXPECT_EQ(finished[0].result.message, "was ended from outside by signal 9");
}

TEST_F(RemoteBackendTest, OfAProgramOneCrashIsTheVerdictAndADifferenceAnEvent) {
  Connect(nullptr, /*without_ways=*/false, Reproducible::kUnknown);
  backend_->Submit({{1, "spec"}, {2, "spec"}});
  SayHello("p", HelloOf(kAnna));
  Poll();
  SendFailure("p", LeasesSentTo("p").at(0), v1::RunnerFailure::KIND_CRASHED, 11, "");
  const std::vector<FinishedRun> crashed = Poll();
  ASSERT_THAT(crashed, SizeIs(1));
  EXPECT_EQ(crashed[0].result.message, "crashed with signal 11");
  EXPECT_EQ(EventsOf("run-given-up"),
            "run 1 crashed with signal 11 on worker 000000000000000a@node7: its first ending counts, because "
            "it is not known to be reproducible\n");
  EXPECT_EQ(backend_->Statistics().lone_verdicts, 0U);
  SendResult("p", LeasesSentTo("p").at(0), result_);
  EXPECT_THAT(Poll(), SizeIs(1));
  for (int i = 0; i < 5 && backend_->Statistics().busy == 0; ++i) {
    clock_.Advance(milliseconds(500));
    SendHeartbeat("p");
    Poll();
  }
  SendResult("p", LeasesSentTo("p").at(0), proto::EncodeRunResult(SampleResult(0.25)));
  EXPECT_THAT(Poll(), IsEmpty());
  EXPECT_EQ(EventsOf("not-reproducible"), "run 2 ended differently when it was simulated again on node7\n");
}

TEST_F(RemoteBackendTest, AnUnreadableOrForgedResultIsItsWorkersFaultAndNeverAVerdict) {
  backend_->Submit({{1, "spec"}});
  SayHello("p", HelloOf(kAnna));
  Poll();
  SendResult("p", LeasesSentTo("p").at(0), "\xff\xff");
  EXPECT_THAT(Poll(), IsEmpty());
  EXPECT_THAT(EventsOf("rejected-message"),
              HasSubstr("worker 000000000000000a@node7 gave a result of run 1"));
  sim::RunResult forged = SampleResult(0.5);
  forged.fitness = 0.0;
  SendResult("p", LeasesSentTo("p").at(0), proto::EncodeRunResult(forged));
  EXPECT_THAT(Poll(), IsEmpty());
  SendResult("p", LeasesSentTo("p").at(0), "");
  EXPECT_THAT(Poll(), IsEmpty());
  EXPECT_EQ(EventsOf("worker-quarantined"),
            "worker 000000000000000a@node7 is quarantined and gets no more runs: 0 of its 0 failed runs were "
            "finished by other workers, 3 of its answers could not be read or were to leases that are not "
            "its own, and 0 of its runs ended well\n");
  EXPECT_EQ(backend_->Statistics().quarantined, 1);
  EXPECT_TRUE(backend_->Describe().workers.at(0).record.quarantined);
  SayHello("q", HelloOf(kBert));
  Poll();
  SendResult("q", LeasesSentTo("q").at(0), result_);
  EXPECT_THAT(Poll(), SizeIs(1)) << "the run is done by another";
}

TEST_F(RemoteBackendTest, AResultWithoutWaysIsUnreadableWhereTheyAreWanted) {
  const std::string result = proto::EncodeWithoutWays(SampleResult(0.5));
  for (const bool without_ways : {false, true}) {
    Connect(nullptr, without_ways);
    backend_->Submit({{1, "spec"}});
    const PeerId peer = without_ways ? "p" : "q";
    SayHello(peer, HelloOf(kAnna));
    Poll();
    SendResult(peer, LeasesSentTo(peer).at(0), result);
    EXPECT_THAT(Poll(), SizeIs(without_ways ? 1 : 0));
    EXPECT_EQ(EventsOf("rejected-message").find("are left out") != std::string::npos, !without_ways);
  }
}

TEST_F(RemoteBackendTest, AVerdictOfOneWorkerSaysSo) {
  EXPECT_EQ(FailRun1([this](const v1::Lease& lease, int) {
              SendFailure("p", lease, v1::RunnerFailure::KIND_CRASHED, 11, "");
            })[0]
                .result.message,
            "crashed with signal 11");
  EXPECT_EQ(EventsOf("run-given-up-alone"),
            "run 1 crashed with signal 11 in 3 of 3 attempts, all on worker 000000000000000a@node7: there "
            "was no other to ask\n");
  EXPECT_EQ(backend_->Statistics().lone_verdicts, 1U);
}

// The processes are the master's own: others will not come.
TEST_F(RemoteBackendTest, AMasterWhoseOwnWorkersAreAllQuarantinedEndsAndSaysWhy) {
  FakePool pool;
  pool.processes = 1;
  pool.on_this_machine = true;
  Connect(&pool);
  backend_->Submit({{1, "spec"}});
  SayHello("p", HelloOf(kAnna));
  Poll();
  for (int i = 0; i < 2; ++i) {
    SendResult("p", LeasesSentTo("p").at(0), "");
    Poll();
  }
  SendResult("p", LeasesSentTo("p").at(0), "");
  Result<std::vector<FinishedRun>> polled = backend_->Poll(milliseconds(500));
  ASSERT_FALSE(polled.ok());
  EXPECT_EQ(polled.error().message,
            "all 1 workers on this machine are quarantined, and nobody is left to do 1 runs: of worker "
            "000000000000000a@node7, 0 of its 0 failed runs were finished by other workers, 3 of its answers "
            "could not be read or were to leases that are not its own, and 0 of its runs ended well");
}

TEST_F(RemoteBackendTest, GarbageIsDroppedCountedAndReportedOncePerKind) {
  transport_.Deliver("x", "\xff\xfe garbage");
  transport_.Deliver("x", "more \xff garbage");
  SendHeartbeat("stranger");
  v1::Envelope envelope;
  envelope.mutable_welcome()->set_epoch(1);
  transport_.Deliver("x", envelope.SerializeAsString());
  transport_.Deliver("x", "");
  Poll();
  EXPECT_EQ(backend_->Statistics().rejected_messages, 5U);
  EXPECT_THAT(backend_->TakeEvents(), SizeIs(2));
  transport_.rejections.oversized = 3;
  Poll(milliseconds(10));
  EXPECT_EQ(backend_->Statistics().rejected_messages, 8U);
  EXPECT_EQ(
      EventsOf("rejected-message"),
      "a message was longer than allowed; it was dropped, and so will others of its kind without a word\n");
  EXPECT_THAT(Sent("x"), IsEmpty());
}

TEST_F(RemoteBackendTest, AStrangersLongMessageIsNotEvenParsed) {
  v1::Hello hello = HelloOf(kAnna);
  hello.set_host(std::string(2 << 20, 'x'));
  SayHello("a", hello);
  Poll();
  EXPECT_THAT(Sent("a"), IsEmpty());
  EXPECT_EQ(backend_->Statistics().rejected_messages, 1U);
  EXPECT_THAT(EventsOf("rejected-message"), HasSubstr("a peer that has not said hello sent 2097"));
}

TEST_F(RemoteBackendTest, AnAnswerToSomebodyElsesLeaseIsRejected) {
  backend_->Submit({{1, "spec"}});
  SayHello("a", HelloOf(kAnna));
  SayHello("b", HelloOf(kBert));
  Poll();
  SendResult("b", LeasesSentTo("a").at(0), result_);
  EXPECT_THAT(Poll(), IsEmpty());
  EXPECT_EQ(backend_->Statistics().rejected_messages, 1U);
}

// What the bundle of a run shows is what its own last failure printed: neither a worker without its lease nor
// one that gives the run back replaces it.
TEST_F(RemoteBackendTest, OnlyAFailureThatCountsLeavesItsOutput) {
  SayHello("a", HelloOf(kAnna));
  EarnTrust("a");
  SayHello("b", HelloOf(kBert));
  backend_->Submit({{1, "spec"}});
  Poll();
  PeerId holder;
  v1::Lease lease;
  const auto see_who_has_it = [&] {
    for (const PeerId peer : {"a", "b"}) {
      for (const v1::Lease& given : LeasesSentTo(peer)) {
        holder = peer;
        lease = given;
      }
    }
  };
  std::vector<FinishedRun> finished;
  for (int attempt = 1; attempt <= 3; ++attempt) {
    see_who_has_it();
    SendFailure(holder, lease, v1::RunnerFailure::KIND_EXTERNAL, 0, "drained");
    Poll();
    see_who_has_it();
    SendFailure(holder, lease, v1::RunnerFailure::KIND_CRASHED, 6, fmt::format("attempt {}", attempt));
    SendFailure(holder == "a" ? "b" : "a", lease, v1::RunnerFailure::KIND_CRASHED, 6, "not mine");
    finished = Poll();
  }
  ASSERT_THAT(finished, SizeIs(1));
  EXPECT_EQ(finished[0].stderr_tail, "attempt 3");
}

TEST_F(RemoteBackendTest, OfALongOutputTheEndIsKept) {
  const std::vector<FinishedRun> finished = FailRun1([this](const v1::Lease& lease, int) {
    SendFailure("p", lease, v1::RunnerFailure::KIND_CRASHED, 6, std::string(100'000, 'x') + "the end");
  });
  EXPECT_EQ(finished[0].stderr_tail, std::string(4096 - 7, 'x') + "the end");
}

}  // namespace
}  // namespace gauntlet
