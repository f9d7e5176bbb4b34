#include "master/dispatch/remote_backend.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <csignal>

#include "master/dispatch/run_codec.h"
#include "proto/protocol.pb.h"
#include "tests/master/dispatch/sample_runs.h"
#include "tests/support/fake_clock.h"
#include "tests/support/fake_transport.h"

namespace gauntlet::master {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::SizeIs;

constexpr InstanceId kAnna = 0xa;
constexpr InstanceId kBert = 0xb;

class FakePool final : public WorkerPool {
 public:
  Result<std::vector<pid_t>> Supervise(TimePoint) override {
    if (error) return *error;
    return std::exchange(ended, {});
  }
  void AppendWaitFds(std::vector<int>& fds) const override { fds.push_back(77); }
  int running() const override { return processes; }
  void StopReplacing() override { replacing = false; }
  void SignalAll(int signal) override {
    signals.push_back(signal);
    if (signal == deadly_signal) processes = 0;
  }
  std::vector<DispatchEvent> TakeEvents() override { return {}; }
  void Observe(const PoolView& now_seen, TimePoint) override { seen = now_seen; }
  std::vector<AllocationView> Allocations() const override {
    return {{"12", "RUNNING", "", "node1", 1, false}};
  }
  std::string Trouble(TimePoint) const override { return "job 13 waits in the queue"; }

  PoolView seen;
  std::optional<Error> error;
  std::vector<pid_t> ended;
  int processes = 0;
  bool replacing = true;
  int deadly_signal = SIGKILL;
  std::vector<int> signals;
};

class RemoteBackendTest : public testing::Test {
 protected:
  RemoteBackendTest() { Connect(nullptr); }

  void Connect(WorkerPool* pool) {
    DispatchOptions options;
    options.credit = 1;
    options.cpu_limit_seconds = 75.0;
    options.memory_limit_bytes = 123456789;
    backend_.emplace(CampaignIdentity{"campaign-1", 5, "1.2.3", 0xfeed, {"first", "second"}}, options,
                     transport_, clock_, pool);
  }

  static v1::Hello HelloOf(InstanceId instance) {
    v1::Hello hello;
    hello.set_protocol_version(1);
    hello.set_campaign_id("campaign-1");
    hello.set_instance_id(instance);
    hello.set_software_version("1.2.3");
    hello.set_golden_hash(0xfeed);
    hello.set_slots(1);
    hello.set_host("node7");
    hello.set_pid(1000 + static_cast<std::int64_t>(instance));
    return hello;
  }
  void SayHello(const PeerId& peer, const v1::Hello& hello) {
    v1::Envelope envelope;
    *envelope.mutable_hello() = hello;
    transport_.Deliver(peer, envelope.SerializeAsString());
  }
  void SendHeartbeat(const PeerId& peer, const std::vector<Fence>& held = {}) {
    v1::Envelope envelope;
    envelope.mutable_heartbeat()->mutable_held_leases()->Add(held.begin(), held.end());
    transport_.Deliver(peer, envelope.SerializeAsString());
  }
  void SendResult(const PeerId& peer, const v1::Lease& lease, const std::string& result) {
    v1::Envelope envelope;
    envelope.mutable_lease_result()->set_fence(lease.fence());
    envelope.mutable_lease_result()->set_run_id(lease.run_id());
    envelope.mutable_lease_result()->set_result(result);
    envelope.mutable_lease_result()->set_cpu_seconds(0.25);
    transport_.Deliver(peer, envelope.SerializeAsString());
  }
  void SendFailure(const PeerId& peer, const v1::Lease& lease, v1::RunnerFailure::Kind kind, int signal,
                   const std::string& text) {
    v1::Envelope envelope;
    v1::LeaseResult& result = *envelope.mutable_lease_result();
    result.set_fence(lease.fence());
    result.set_run_id(lease.run_id());
    result.mutable_failure()->set_kind(kind);
    result.mutable_failure()->set_signal(signal);
    result.mutable_failure()->set_stderr_tail(text);
    transport_.Deliver(peer, envelope.SerializeAsString());
  }
  std::vector<v1::Envelope> Sent(const PeerId& peer) {
    std::vector<v1::Envelope> envelopes;
    for (const std::string& bytes : transport_.TakeSentTo(peer)) {
      EXPECT_TRUE(envelopes.emplace_back().ParseFromString(bytes));
    }
    return envelopes;
  }
  std::vector<v1::Lease> LeasesSentTo(const PeerId& peer) {
    std::vector<v1::Lease> leases;
    for (const v1::Envelope& envelope : Sent(peer)) {
      if (envelope.has_lease()) leases.push_back(envelope.lease());
    }
    return leases;
  }
  std::vector<FinishedRun> Poll(milliseconds timeout = milliseconds(0)) {
    Result<std::vector<FinishedRun>> finished = backend_->Poll(timeout);
    EXPECT_TRUE(finished.ok());
    return finished.ok() ? *std::move(finished) : std::vector<FinishedRun>{};
  }
  std::string EventsOf(const std::string& kind) {
    std::string texts;
    for (const DispatchEvent& event : backend_->TakeEvents()) {
      if (event.kind == kind) texts += event.text + "\n";
    }
    return texts;
  }

  testing_support::FakeClock clock_;
  testing_support::FakeTransport transport_{clock_};
  std::optional<RemoteBackend> backend_;
  const std::string result_ = EncodeRunResult(SampleResult(0.5));
};

TEST_F(RemoteBackendTest, WelcomesAWorkerAndLeasesIt) {
  backend_->Submit({{1, "spec bytes \x01\xff"}});
  SayHello("p", HelloOf(kAnna));
  Poll();
  const std::vector<v1::Envelope> sent = Sent("p");
  ASSERT_GE(sent.size(), 2U);
  ASSERT_TRUE(sent[0].has_welcome()) << "first of all";
  EXPECT_EQ(sent[0].welcome().heartbeat_ms(), 1000U);
  EXPECT_EQ(sent[0].welcome().epoch(), 5U);
  EXPECT_EQ(sent[0].welcome().cpu_limit_seconds(), 75.0);
  EXPECT_EQ(sent[0].welcome().memory_limit_bytes(), 123456789U);
  const v1::Lease& lease = sent.back().lease();
  EXPECT_EQ(lease.run_id(), 1U);
  EXPECT_EQ(lease.spec(), "spec bytes \x01\xff") << "sent verbatim";
  EXPECT_EQ(lease.attempt(), 1U);
  EXPECT_EQ(lease.fence() >> 32, 5U) << "fences begin with the epoch";
  EXPECT_EQ(backend_->Statistics().connected, 1);
  EXPECT_EQ(backend_->Statistics().busy, 1);
}

struct RefusalCase {
  std::string name;
  std::function<void(v1::Hello&)> change;
  std::string reason;
};

void PrintTo(const RefusalCase& param, std::ostream* out) {
  *out << param.name;
}

class RefusalTest : public RemoteBackendTest, public testing::WithParamInterface<RefusalCase> {};

TEST_P(RefusalTest, SaysWhatDiffers) {
  backend_->Submit({{1, "spec"}});
  v1::Hello hello = HelloOf(kAnna);
  GetParam().change(hello);
  SayHello("p", hello);
  Poll();
  const std::vector<v1::Envelope> sent = Sent("p");
  ASSERT_THAT(sent, SizeIs(1));
  EXPECT_THAT(sent[0].refused().reason(), HasSubstr(GetParam().reason));
  EXPECT_THAT(EventsOf("worker-refused"), HasSubstr(GetParam().reason));
  EXPECT_EQ(backend_->Statistics().connected, 0);
}

INSTANTIATE_TEST_SUITE_P(
    AllReasons, RefusalTest,
    testing::Values(
        RefusalCase{"Protocol", [](v1::Hello& hello) { hello.set_protocol_version(2); },
                    "speaks protocol version 2, this master speaks 1: use gauntlet-worker 1.2.3"},
        RefusalCase{"Campaign", [](v1::Hello& hello) { hello.set_campaign_id("other"); },
                    "belongs to campaign 'other', this master serves campaign 'campaign-1'"},
        RefusalCase{"Version", [](v1::Hello& hello) { hello.set_software_version("1.2.4"); },
                    "software version 1.2.4, this master has 1.2.3"},
        RefusalCase{"ControllerMissing", [](v1::Hello& hello) { hello.add_controllers("second"); },
                    "another set of controllers: it lacks 'first'"},
        RefusalCase{"ControllerTooMany",
                    [](v1::Hello& hello) {
                      for (const char* name : {"first", "mine", "second"}) hello.add_controllers(name);
                    },
                    "another set of controllers: it has, and this master has not, 'mine'"},
        RefusalCase{"Golden", [](v1::Hello& hello) { hello.set_golden_hash(0xbad); },
                    "golden hash is 0000000000000bad, the campaign's is 000000000000feed"},
        RefusalCase{"Instance", [](v1::Hello& hello) { hello.set_instance_id(0); }, "instance id 0"},
        RefusalCase{"Slots", [](v1::Hello& hello) { hello.set_slots(0); }, "has 0 slots; 1 to 4096"}),
    [](const auto& parameter) { return parameter.param.name; });

TEST_F(RemoteBackendTest, AResultComesOutAndIsAcknowledgedWhenStored) {
  backend_->Submit({{1, "spec"}});
  SayHello("p", HelloOf(kAnna));
  Poll();
  const v1::Lease lease = LeasesSentTo("p").at(0);
  SendResult("p", lease, result_);
  const std::vector<FinishedRun> finished = Poll(seconds(1));
  ASSERT_THAT(finished, SizeIs(1));
  EXPECT_EQ(finished[0].id, 1U);
  EXPECT_EQ(finished[0].result.hash, SampleResult(0.5).hash);
  const Result<sim::RunResult> stored = DecodeRunResult(finished[0].encoded);
  ASSERT_TRUE(stored.ok()) << stored.error().message;
  EXPECT_EQ(stored->hash, finished[0].result.hash);
  EXPECT_TRUE(stored->trajectory.empty()) << "trajectories are not stored";
  EXPECT_EQ(finished[0].worker, "000000000000000a@node7");
  EXPECT_EQ(finished[0].attempt, 1U);
  Poll();
  for (const v1::Envelope& envelope : Sent("p")) EXPECT_FALSE(envelope.has_acknowledge());
  backend_->Acknowledge({1});
  Poll();
  const std::vector<v1::Envelope> sent = Sent("p");
  ASSERT_THAT(sent, SizeIs(1));
  EXPECT_THAT(sent[0].acknowledge().fences(), ElementsAre(lease.fence()));
}

TEST_F(RemoteBackendTest, AcknowledgementsForABusyWorkerGoAlongWithTheNextMessage) {
  v1::Hello hello = HelloOf(kAnna);
  hello.set_slots(2);
  SayHello("p", hello);
  backend_->Submit({{1, "spec"}, {2, "spec"}, {3, "spec"}});
  Poll();
  const auto leases = LeasesSentTo("p");
  ASSERT_GE(leases.size(), 2U);
  SendResult("p", leases[0], result_);
  ASSERT_THAT(Poll(seconds(1)), SizeIs(1));
  Poll();
  Sent("p");
  backend_->Acknowledge({leases[0].run_id()});
  Poll();
  EXPECT_THAT(Sent("p"), IsEmpty()) << "it has something to do";
  clock_.Advance(DispatchOptions{}.heartbeat);
  Poll();
  const std::vector<v1::Envelope> sent = Sent("p");
  ASSERT_THAT(sent, SizeIs(2));
  EXPECT_THAT(sent[0].acknowledge().fences(), ElementsAre(leases[0].fence()));
  EXPECT_TRUE(sent[1].has_heartbeat());
}

TEST_F(RemoteBackendTest, PollReturnsAtOnceWithResultsAndAtItsTimeoutWithout) {
  const TimePoint start = clock_.Now();
  EXPECT_THAT(Poll(milliseconds(730)), IsEmpty());
  EXPECT_EQ(clock_.Now() - start, milliseconds(730));
}

TEST_F(RemoteBackendTest, PollReturnsWhenTheWatchedDescriptorIsReadable) {
  backend_->WatchFd(42);
  transport_.ready_fds = {42};
  const TimePoint start = clock_.Now();
  Poll(seconds(10));
  EXPECT_EQ(clock_.Now(), start);
}

TEST_F(RemoteBackendTest, PollReturnsWhenItIsWokenUp) {
  transport_.WakeUp();
  const TimePoint start = clock_.Now();
  Poll(seconds(10));
  EXPECT_EQ(clock_.Now(), start);
}

TEST_F(RemoteBackendTest, ASilentWorkersRunGoesElsewhereAndItsLateResultIsADuplicate) {
  backend_->Submit({{1, "spec"}});
  SayHello("a", HelloOf(kAnna));
  Poll();
  const v1::Lease first = LeasesSentTo("a").at(0);
  SayHello("b", HelloOf(kBert));
  transport_.on_wait = [this] { SendHeartbeat("b"); };
  const TimePoint start = clock_.Now();
  std::vector<v1::Lease> leases;
  while (leases.empty() && clock_.Now() - start < seconds(10)) {
    Poll(milliseconds(50));
    leases = LeasesSentTo("b");
  }
  ASSERT_THAT(leases, SizeIs(1));
  EXPECT_GE(clock_.Now() - start, seconds(3));
  EXPECT_LE(clock_.Now() - start, milliseconds(3300));
  EXPECT_EQ(leases[0].attempt(), 2U);
  EXPECT_THAT(EventsOf("worker-lost"),
              HasSubstr("000000000000000a@node7 is lost; 1 of its runs wait for another worker (run 1)"));
  transport_.on_wait = nullptr;

  SendResult("b", leases[0], result_);
  EXPECT_EQ(Poll().at(0).attempt, 2U);
  SendResult("a", first, result_);
  EXPECT_THAT(Poll(), IsEmpty());
  EXPECT_EQ(backend_->Statistics().duplicates, 1U);
  EXPECT_EQ(backend_->Statistics().nondeterministic, 0U);
}

TEST_F(RemoteBackendTest, ALateResultIsTakenAndTheOtherWorkerIsTold) {
  backend_->Submit({{1, "spec"}});
  FakePool pool;
  Connect(&pool);
  backend_->Submit({{1, "spec"}});
  SayHello("a", HelloOf(kAnna));
  SayHello("b", HelloOf(kBert));
  Poll();
  const v1::Lease first = LeasesSentTo("a").at(0);
  pool.ended = {1000 + static_cast<pid_t>(kAnna)};
  Poll(milliseconds(150));
  const std::vector<v1::Lease> second = LeasesSentTo("b");
  ASSERT_THAT(second, SizeIs(1)) << "leased again as soon as the pool reports the death";
  SendResult("a", first, result_);
  EXPECT_THAT(Poll(), SizeIs(1));
  const std::vector<v1::Envelope> sent = Sent("b");
  ASSERT_FALSE(sent.empty());
  EXPECT_EQ(sent.back().cancel().fence(), second[0].fence());
}

TEST_F(RemoteBackendTest, DifferentDuplicatesAreShownWithBothWorkers) {
  FakePool pool;
  Connect(&pool);
  backend_->Submit({{1, "spec"}});
  SayHello("a", HelloOf(kAnna));
  SayHello("b", HelloOf(kBert));
  Poll();
  const v1::Lease first = LeasesSentTo("a").at(0);
  pool.ended = {1000 + static_cast<pid_t>(kAnna)};
  Poll(milliseconds(150));
  SendResult("b", LeasesSentTo("b").at(0), result_);
  Poll();
  SendResult("a", first, EncodeRunResult(SampleResult(0.25)));
  Poll();
  EXPECT_EQ(backend_->Statistics().nondeterministic, 1U);
  const std::string text = EventsOf("nondeterministic");
  EXPECT_THAT(text, HasSubstr("run 1 ended differently"));
  EXPECT_THAT(text, HasSubstr("000000000000000a@node7"));
  EXPECT_THAT(text, HasSubstr("000000000000000b@node7"));
}

TEST_F(RemoteBackendTest, ThreeCrashesBecomeAVerdictWithAReproducibleMessage) {
  backend_->Submit({{1, "spec"}});
  SayHello("p", HelloOf(kAnna));
  std::vector<FinishedRun> finished;
  for (int attempt = 1; attempt <= 3; ++attempt) {
    EXPECT_THAT(finished, IsEmpty());
    Poll();
    SendFailure("p", LeasesSentTo("p").at(0), v1::RunnerFailure::KIND_CRASHED, 11,
                fmt::format("assertion failed at 0x{}", attempt));
    finished = Poll();
  }
  ASSERT_THAT(finished, SizeIs(1));
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

TEST_F(RemoteBackendTest, ExternalFailuresNeverBecomeAVerdict) {
  backend_->Submit({{1, "spec"}});
  SayHello("p", HelloOf(kAnna));
  for (int attempt = 1; attempt <= 10; ++attempt) {
    Poll();
    SendFailure("p", LeasesSentTo("p").at(0), v1::RunnerFailure::KIND_EXTERNAL, 15, "");
  }
  EXPECT_THAT(Poll(), IsEmpty());
  SendResult("p", LeasesSentTo("p").at(0), result_);
  EXPECT_EQ(Poll().at(0).attempt, 11U);
}

TEST_F(RemoteBackendTest, AnUnreadableOrForgedResultIsAFailureOfTheRun) {
  backend_->Submit({{1, "spec"}});
  SayHello("p", HelloOf(kAnna));
  Poll();
  SendResult("p", LeasesSentTo("p").at(0), "\xff\xff");
  EXPECT_THAT(Poll(), IsEmpty());
  EXPECT_THAT(EventsOf("runner-failure"), HasSubstr("run 1 gave an unreadable result"));
  sim::RunResult forged = SampleResult(0.5);
  forged.fitness = 0.0;
  SendResult("p", LeasesSentTo("p").at(0), EncodeRunResult(forged));
  EXPECT_THAT(Poll(), IsEmpty());
  EXPECT_THAT(EventsOf("runner-failure"), HasSubstr("its content's hash is"));
  SendResult("p", LeasesSentTo("p").at(0), "");
  const std::vector<FinishedRun> finished = Poll();
  ASSERT_THAT(finished, SizeIs(1));
  EXPECT_EQ(finished[0].result.message, "gave an unreadable result");
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
  EXPECT_THAT(EventsOf("rejected-message"), HasSubstr("longer than allowed"));
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

TEST_F(RemoteBackendTest, AReconnectedWorkerContinuesUnderItsNewPeer) {
  backend_->Submit({{1, "spec"}, {2, "spec"}});
  SayHello("old", HelloOf(kAnna));
  Poll();
  const v1::Lease lease = LeasesSentTo("old").at(0);
  v1::Hello again = HelloOf(kAnna);
  again.add_held_leases(lease.fence());
  SayHello("new", again);
  SendResult("new", lease, result_);
  EXPECT_THAT(Poll(), SizeIs(1));
  EXPECT_THAT(LeasesSentTo("new"), SizeIs(1));
  EXPECT_EQ(backend_->Statistics().connected, 1);
  EXPECT_EQ(backend_->Statistics().releases, 0U);
  SendHeartbeat("old");
  Poll();
  EXPECT_EQ(backend_->Statistics().rejected_messages, 1U) << "the old connection speaks for nobody";
}

// A worker says hello every second until it is welcomed, on the same connection.
TEST_F(RemoteBackendTest, AHelloThatCrossedTheWelcomeIsNoReconnect) {
  backend_->Submit({{1, "spec"}});
  SayHello("a", HelloOf(kAnna));
  Poll();
  const v1::Lease lease = LeasesSentTo("a").at(0);
  EXPECT_THAT(EventsOf("worker-joined"), HasSubstr("joined"));
  SayHello("a", HelloOf(kAnna));
  Poll();
  const std::vector<v1::Envelope> sent = Sent("a");
  ASSERT_THAT(sent, SizeIs(1)) << "no second lease";
  EXPECT_TRUE(sent[0].has_welcome()) << "the first may have been lost";
  EXPECT_THAT(EventsOf("worker-joined"), IsEmpty());
  EXPECT_EQ(backend_->Statistics().releases, 0U);
  SendResult("a", lease, result_);
  EXPECT_THAT(Poll(), SizeIs(1));
}

TEST_F(RemoteBackendTest, HeartbeatsGoToEveryWorkerOncePerSecond) {
  SayHello("p", HelloOf(kAnna));
  transport_.on_wait = [this] { SendHeartbeat("p"); };
  Poll(seconds(10));
  std::uint64_t beats = 0;
  for (const v1::Envelope& envelope : Sent("p")) beats += envelope.has_heartbeat() ? 1U : 0U;
  EXPECT_GE(beats, 9U);
  EXPECT_LE(beats, 11U);
}

TEST_F(RemoteBackendTest, AClosedConnectionIsNoticedBeforeThreeHeartbeats) {
  backend_->Submit({{1, "spec"}});
  SayHello("a", HelloOf(kAnna));
  Poll();
  SayHello("b", HelloOf(kBert));
  transport_.SetUnreachable("a");
  transport_.on_wait = [this] { SendHeartbeat("b"); };
  Poll(milliseconds(2200));
  EXPECT_THAT(LeasesSentTo("b"), SizeIs(1));
}

TEST_F(RemoteBackendTest, AWorkerThatDoesNotReadGetsNoLease) {
  SayHello("a", HelloOf(kAnna));
  Poll();
  transport_.SetFull("a", true);
  backend_->Submit({{1, "spec"}});
  Poll();
  SayHello("b", HelloOf(kBert));
  Poll();
  EXPECT_EQ(LeasesSentTo("b").at(0).attempt(), 1U);
  transport_.SetFull("a", false);
  backend_->Submit({{2, "spec"}});
  SendHeartbeat("a");
  Poll();
  EXPECT_THAT(LeasesSentTo("a"), SizeIs(1));
}

TEST_F(RemoteBackendTest, ADrainingWorkerFinishesAndGoodbyeReleasesTheRest) {
  v1::Hello hello = HelloOf(kAnna);
  hello.set_slots(2);
  SayHello("a", hello);
  backend_->Submit({{1, "spec"}, {2, "spec"}, {3, "spec"}});
  Poll();
  const std::vector<v1::Lease> leases = LeasesSentTo("a");
  ASSERT_THAT(leases, SizeIs(2));
  v1::Envelope drain;
  drain.mutable_drain()->set_reason("walltime ends");
  transport_.Deliver("a", drain.SerializeAsString());
  SendResult("a", leases[0], result_);
  EXPECT_THAT(Poll(), SizeIs(1));
  EXPECT_THAT(LeasesSentTo("a"), IsEmpty());
  v1::Envelope goodbye;
  goodbye.mutable_goodbye()->set_reason("walltime ends");
  transport_.Deliver("a", goodbye.SerializeAsString());
  SayHello("b", HelloOf(kBert));
  Poll();
  EXPECT_EQ(LeasesSentTo("b").at(0).run_id(), 2U);
  EXPECT_THAT(EventsOf("worker-left"), HasSubstr("walltime ends"));
  EXPECT_EQ(backend_->Statistics().connected, 1);
}

TEST_F(RemoteBackendTest, ThePoolSeesRunsAndWorkersByTheirAllocationAndIsShown) {
  FakePool pool;
  Connect(&pool);
  backend_->Submit({{1, "spec"}});
  v1::Hello hello = HelloOf(kAnna);
  hello.set_allocation("12:0:node1");
  SayHello("a", hello);
  SayHello("b", HelloOf(kBert));
  Poll();
  Poll(milliseconds(150));
  EXPECT_EQ(pool.seen.unfinished_runs, 1);
  ASSERT_THAT(pool.seen.workers, SizeIs(2));
  EXPECT_EQ(pool.seen.workers[0].allocation, "12:0:node1");
  EXPECT_TRUE(pool.seen.workers[0].busy);
  EXPECT_EQ(pool.seen.workers[1].allocation, "");
  EXPECT_FALSE(pool.seen.workers[1].busy);

  const BackendView view = backend_->Describe();
  ASSERT_THAT(view.allocations, SizeIs(1));
  EXPECT_EQ(view.allocations[0].job, "12");
  EXPECT_EQ(view.pool_trouble, "job 13 waits in the queue");
  EXPECT_EQ(view.workers.at(0).allocation, "12:0:node1");
}

TEST_F(RemoteBackendTest, ThePoolsErrorComesOutOfPoll) {
  FakePool pool;
  Connect(&pool);
  pool.error = Error{ErrorKind::kInternal, "workers do not stay alive"};
  const Result<std::vector<FinishedRun>> polled = backend_->Poll(seconds(1));
  ASSERT_FALSE(polled.ok());
  EXPECT_EQ(polled.error().message, "workers do not stay alive");
}

TEST_F(RemoteBackendTest, ShutdownDrainsAndEndsWithTheLastGoodbye) {
  SayHello("a", HelloOf(kAnna));
  backend_->Submit({{1, "spec"}});
  Poll();
  const v1::Lease lease = LeasesSentTo("a").at(0);
  transport_.on_wait = [this, &lease] {
    for (const v1::Envelope& envelope : Sent("a")) {
      if (envelope.has_drain()) {
        EXPECT_FALSE(envelope.drain().finish_current());
        SendResult("a", lease, result_);
      }
      if (envelope.has_acknowledge()) {
        EXPECT_THAT(envelope.acknowledge().fences(), ElementsAre(lease.fence()));
        v1::Envelope goodbye;
        goodbye.mutable_goodbye();
        transport_.Deliver("a", goodbye.SerializeAsString());
      }
    }
  };
  const TimePoint start = clock_.Now();
  backend_->Shutdown(seconds(10));
  EXPECT_LT(clock_.Now() - start, seconds(1));
  EXPECT_EQ(backend_->Statistics().connected, 0);
}

TEST_F(RemoteBackendTest, ShutdownGivesNoLeaseToThoseWhoComeLate) {
  backend_->Submit({{1, "spec"}});
  transport_.on_wait = [this] { SayHello("late", HelloOf(kBert)); };
  SayHello("a", HelloOf(kAnna));
  Poll();
  Sent("a");
  backend_->Shutdown(seconds(2));
  const std::vector<v1::Envelope> sent = Sent("late");
  ASSERT_GE(sent.size(), 2U);
  EXPECT_TRUE(sent[0].has_welcome());
  EXPECT_TRUE(sent[1].has_drain());
  for (const v1::Envelope& envelope : sent) EXPECT_FALSE(envelope.has_lease());
}

TEST_F(RemoteBackendTest, ShutdownTakesHarsherMeansAgainstAPoolThatStays) {
  FakePool pool;
  pool.processes = 2;
  Connect(&pool);
  const TimePoint start = clock_.Now();
  backend_->Shutdown(seconds(4));
  EXPECT_FALSE(pool.replacing);
  EXPECT_THAT(pool.signals, ElementsAre(SIGTERM, SIGKILL));
  EXPECT_LE(clock_.Now() - start, seconds(4));
  EXPECT_EQ(pool.running(), 0);
}

}  // namespace
}  // namespace gauntlet::master
