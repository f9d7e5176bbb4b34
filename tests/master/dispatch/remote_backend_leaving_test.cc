// How workers leave, the pool of the master among them.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <csignal>
#include <utility>

#include "tests/master/dispatch/remote_backend_fixture.h"

namespace gauntlet {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;
using testing::ElementsAre;
using testing::IsEmpty;
using testing::SizeIs;

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
  EXPECT_EQ(EventsOf("worker-left"),
            "worker 000000000000000a@node7 wants no more runs: walltime ends\nworker 000000000000000a@node7 "
            "left: walltime ends\n");
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
  const v1::Lease lease = LeaseRun1To("a");
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

// Its end is seen before its goodbye is read.
TEST_F(RemoteBackendTest, AWorkerOfThePoolThatSaidGoodbyeAndEndedHasLeftAndIsNotLost) {
  FakePool pool;
  pool.processes = 1;
  Connect(&pool);
  SayHello("a", HelloOf(kAnna));
  Poll();
  transport_.on_wait = [&, said = false]() mutable {
    if (std::exchange(said, true)) return;
    v1::Envelope goodbye;
    goodbye.mutable_goodbye()->set_reason("the master is leaving");
    transport_.Deliver("a", goodbye.SerializeAsString());
    pool.ended = {1000 + static_cast<pid_t>(kAnna)};
    pool.processes = 0;
  };
  backend_->Shutdown(seconds(10));
  std::vector<std::string> kinds;
  for (const DispatchEvent& event : backend_->TakeEvents()) kinds.push_back(event.kind);
  EXPECT_THAT(kinds, ElementsAre("worker-joined", "worker-left"));
  EXPECT_EQ(backend_->Statistics().lost, 0);
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
}  // namespace gauntlet
