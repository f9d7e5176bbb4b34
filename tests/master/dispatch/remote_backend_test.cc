// From a hello to a stored result.
// Covers: master/dispatch/dispatch_log.cc, master/dispatch/wire/worker_connections.cc
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/master/dispatch/remote_backend_fixture.h"

namespace gauntlet {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::SizeIs;

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

// Whoever knows no key must not learn from one refusal after the other how to be admitted.
TEST_P(RefusalTest, TellsAStrangerNothingOfTheCampaign) {
  transport_.knows_its_peers = false;
  v1::Hello hello = HelloOf(kAnna);
  GetParam().change(hello);
  SayHello("p", hello);
  Poll();
  const std::vector<v1::Envelope> sent = Sent("p");
  ASSERT_THAT(sent, SizeIs(1));
  const std::string& reason = sent[0].refused().reason();
  EXPECT_THAT(reason, HasSubstr(GetParam().reason.substr(0, 20))) << "what differs";
  for (const char* secret : {"campaign-1", "1.2.3", "000000000000f00d", "000000000000feed"})
    EXPECT_THAT(reason, testing::Not(HasSubstr(secret)));
  EXPECT_THAT(EventsOf("worker-refused"), HasSubstr(GetParam().reason)) << "we are told all";
}

INSTANTIATE_TEST_SUITE_P(
    AllReasons, RefusalTest,
    testing::Values(
        RefusalCase{"Protocol", [](v1::Hello& hello) { hello.set_protocol_version(2); },
                    "speaks protocol version 2, this master speaks 1: use gauntlet-worker 1.2.3"},
        RefusalCase{"Campaign", [](v1::Hello& hello) { hello.set_campaign_id("other"); },
                    "belongs to campaign 'other', this master serves campaign 'campaign-1'"},
        RefusalCase{"ControllerMissing",
                    [](v1::Hello& hello) { hello.mutable_golden_hashes()->RemoveLast(); },
                    "built without the controller 'second', which the campaign uses"},
        RefusalCase{"ControllersMissing", [](v1::Hello& hello) { hello.clear_golden_hashes(); },
                    "built without the controller 'first'"},
        RefusalCase{
            "Golden", [](v1::Hello& hello) { hello.mutable_golden_hashes(1)->set_hash(0xbad); },
            "golden hash of controller 'second' is 0000000000000bad, the campaign's is 000000000000f00d"},
        RefusalCase{"Instance", [](v1::Hello& hello) { hello.set_instance_id(0); }, "instance id 0"},
        RefusalCase{"Slots", [](v1::Hello& hello) { hello.set_slots(0); }, "has 0 slots; 1 to 4096"}),
    [](const auto& parameter) { return parameter.param.name; });

TEST_F(RemoteBackendTest, AWorkerMayDifferInVersionAndInControllersThatTheCampaignDoesNotUse) {
  v1::Hello hello = HelloOf(kAnna);
  hello.set_software_version("1.2.4");
  SetGoldenHash(hello, "mine", 0xbad);
  SayHello("p", hello);
  Poll();
  EXPECT_EQ(backend_->Statistics().connected, 1);
}

TEST_F(RemoteBackendTest, AResultComesOutAndIsAcknowledgedWhenStored) {
  const v1::Lease lease = LeaseRun1To("p");
  SendResult("p", lease, result_);
  const std::vector<FinishedRun> finished = Poll(seconds(1));
  ASSERT_THAT(finished, SizeIs(1));
  EXPECT_EQ(finished[0].id, 1U);
  EXPECT_EQ(finished[0].result.hash, SampleResult(0.5).hash);
  EXPECT_TRUE(finished[0].result.trajectory.empty()) << "trajectories are not stored";
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
  hello.mutable_held_leases()->Add(leases[1].fence());
  SayHello("p", hello);
  Poll();
  EXPECT_TRUE(Sent("p").at(0).has_welcome()) << "and a hello said again loses none";
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
  const v1::Lease first = LeaseRun1To("a");
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
  EXPECT_EQ(EventsOf("worker-lost"),
            "worker 000000000000000a@node7 is lost; 1 of its runs wait for another worker (run 1)\n");
  transport_.on_wait = nullptr;

  SendResult("b", leases[0], result_);
  EXPECT_EQ(Poll().at(0).attempt, 2U);
  SendResult("a", first, result_);
  EXPECT_THAT(Poll(), IsEmpty());
  EXPECT_EQ(backend_->Statistics().duplicates, 1U);
  EXPECT_EQ(backend_->Statistics().nondeterministic, 0U);
  EXPECT_EQ(EventsOf("worker-back"), "") << "only a heartbeat says that it works on";
  SendHeartbeat("a");
  Poll();
  EXPECT_EQ(EventsOf("worker-back"), "worker 000000000000000a@node7 was lost and is heard again\n");
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
  EXPECT_THAT(LeasesSentTo("b"), IsEmpty()) << "what it said last may be on its way";
  Poll(milliseconds(200));
  const std::vector<v1::Lease> second = LeasesSentTo("b");
  ASSERT_THAT(second, SizeIs(1)) << "leased again soon after the pool has reported the death";
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
  Poll(milliseconds(450));
  SendResult("b", LeasesSentTo("b").at(0), result_);
  Poll();
  SendResult("a", first, proto::EncodeRunResult(SampleResult(0.25)));
  Poll();
  EXPECT_EQ(backend_->Statistics().nondeterministic, 1U);
  const std::string text = EventsOf("nondeterministic");
  EXPECT_THAT(text, HasSubstr("run 1 ended differently"));
  EXPECT_THAT(text, HasSubstr("000000000000000a@node7"));
  EXPECT_THAT(text, HasSubstr("000000000000000b@node7"));
}

}  // namespace
}  // namespace gauntlet
