// Connections that come back, close, or do not read.
// Covers: master/dispatch/wire/admission.cc
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "base/printable.h"
#include "base/utf8.h"
#include "tests/master/dispatch/remote_backend_fixture.h"

namespace gauntlet {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::SizeIs;

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
  const v1::Lease lease = LeaseRun1To("a");
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

// Whoever wants to be admitted, and deaths, are heard of in Wait alone.
TEST_F(RemoteBackendTest, ResultsWithoutPauseDoNotKeepTheRestFromBeingHeard) {
  std::vector<RunRequest> runs;
  for (RunId run = 1; run <= 101; ++run) runs.push_back({run, "spec"});
  backend_->Submit(std::move(runs));
  SayHello("a", HelloOf(kAnna));
  Poll();
  int looks = 0;
  transport_.on_wait = [&looks] { ++looks; };
  for (int run = 1; run <= 100; ++run) {
    clock_.Advance(milliseconds(10));
    SendResult("a", LeasesSentTo("a").at(0), result_);
    ASSERT_THAT(Poll(), SizeIs(1));
  }
  EXPECT_GE(looks, 19) << "in a second";
}

std::vector<std::uint64_t> PacesIn(const std::vector<v1::Envelope>& sent) {
  std::vector<std::uint64_t> paces;
  for (const v1::Envelope& one : sent) {
    if (one.has_welcome()) paces.push_back(one.welcome().heartbeat_ms());
  }
  return paces;
}

// A master that hears thousands of workers each second does nothing else.
TEST_F(RemoteBackendTest, ACrowdIsHeardAsManyTimesMoreSeldomAsItHasThousands) {
  SayHello("first", HelloOf(1'000'000));
  Poll();
  EXPECT_THAT(PacesIn(Sent("first")), testing::ElementsAre(1000));
  clock_.Advance(milliseconds(1));
  constexpr InstanceId kCrowd = 2000;
  for (InstanceId worker = 1; worker < kCrowd; ++worker) {
    SayHello("p" + std::to_string(worker), HelloOf(worker));
    if (worker % 500 == 0) Poll();
  }
  Poll();
  EXPECT_THAT(PacesIn(Sent("p1999")), testing::ElementsAre(2000));
  clock_.Advance(seconds(1));
  SendHeartbeat("first");
  Poll();
  EXPECT_THAT(PacesIn(Sent("first")), testing::ElementsAre(2000)) << "is told with its next heartbeat";
  EXPECT_EQ(backend_->Statistics().connected, 2000);
}

TEST_F(RemoteBackendTest, AtMostAHundredAreToldAnotherPaceAtOnce) {
  constexpr InstanceId kCrowd = 2000;
  for (InstanceId worker = 1; worker <= kCrowd; ++worker)
    SayHello("p" + std::to_string(worker), HelloOf(worker));
  Poll();
  for (InstanceId worker = 1; worker <= kCrowd; ++worker) Sent("p" + std::to_string(worker));
  clock_.Advance(seconds(1));
  Poll();
  std::size_t told = 0;
  for (InstanceId worker = 1; worker <= kCrowd; ++worker)
    told += PacesIn(Sent("p" + std::to_string(worker))).size();
  EXPECT_EQ(told, 100U);
}

// What a worker says waits behind the handshakes of all who connect at once.
TEST_F(RemoteBackendTest, WhileACrowdIsGreetedNobodyIsLostSoSoon) {
  SayHello("p", HelloOf(kAnna));
  Poll();
  transport_.greeting = 1000;
  Poll(seconds(20));
  EXPECT_EQ(backend_->Statistics().lost, 0);
  transport_.greeting = 0;
  Poll(seconds(4));
  EXPECT_EQ(backend_->Statistics().lost, 1);
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

// 150 characters of two bytes each, one more than is shown, and a terminal's command.
TEST_F(RemoteBackendTest, WhatAStrangerSaysOfItselfIsShownAsOneLineOfUtf8) {
  std::string text = "\x1b[2J\n";
  for (int i = 0; i < 150; ++i) text += "\u00e9";
  text += "x";
  v1::Hello hello = HelloOf(kAnna);
  hello.set_host(text);
  hello.set_allocation(text);
  SayHello("a", hello);
  hello = HelloOf(kBert);
  hello.set_campaign_id(text);
  SayHello("b", hello);
  Poll();
  const BackendView view = backend_->Describe();
  ASSERT_THAT(view.workers, SizeIs(1));
  EXPECT_TRUE(IsUtf8(view.workers[0].label)) << view.workers[0].label;
  EXPECT_TRUE(IsUtf8(view.workers[0].allocation));
  EXPECT_TRUE(IsUtf8(view.last_refusal)) << view.last_refusal;
  ASSERT_THAT(Sent("b"), SizeIs(1)) << "and protobuf takes it";
  hello.set_campaign_id("\x1b[2J\nNONDETERMINISTIC");
  SayHello("b", hello);
  Poll();
  EXPECT_EQ(backend_->Describe().last_refusal,
            "this worker belongs to campaign '\\x1b[2J\\nNONDETERMINISTIC', this master serves campaign "
            "'campaign-1'");
  for (const DispatchEvent& event : backend_->TakeEvents()) EXPECT_EQ(event.text, Printable(event.text));
}

TEST_F(RemoteBackendTest, StrangersCannotFillTheLog) {
  v1::Hello hello = HelloOf(kAnna);
  hello.set_campaign_id("other");
  const auto refused = [&](int times) {
    for (int i = 0; i < times; ++i) SayHello("a", hello);
    Poll();
    const std::string told = EventsOf("worker-refused");
    return std::pair(std::count(told.begin(), told.end(), '\n'), told);
  };
  EXPECT_EQ(refused(25).first, 10);
  EXPECT_EQ(refused(25).first, 0) << "and none again within the minute";
  EXPECT_EQ(backend_->Describe().refused_workers, 50U) << "but all are counted";
  clock_.Advance(std::chrono::minutes(1));
  const auto [count, told] = refused(1);
  EXPECT_EQ(count, 1);
  EXPECT_EQ(told,
            "worker 000000000000000a@node7 was refused: this worker belongs to campaign 'other', this master "
            "serves campaign 'campaign-1' (and 40 others since the last that was told)\n");
}

}  // namespace
}  // namespace gauntlet
