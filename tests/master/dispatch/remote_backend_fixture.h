// A RemoteBackend whose transport and clock are in memory.
#pragma once

#include <gtest/gtest.h>

#include <chrono>
#include <csignal>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "master/dispatch/remote_backend.h"
#include "proto/protocol.pb.h"
#include "proto/run_codec.h"
#include "tests/master/dispatch/sample_runs.h"
#include "tests/support/fake_clock.h"
#include "tests/support/fake_transport.h"

namespace gauntlet {

inline constexpr InstanceId kAnna = 0xa;
inline constexpr InstanceId kBert = 0xb;

class FakePool final : public WorkerPool {
 public:
  Result<std::vector<pid_t>> Supervise(TimePoint) override {
    if (error) return *error;
    return std::exchange(ended, {});
  }
  void AppendWaitFds(std::vector<int>& fds) const override { fds.push_back(77); }
  int running() const override { return processes; }
  bool OnThisMachine() const override { return on_this_machine; }
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
  bool on_this_machine = false;
  bool replacing = true;
  int deadly_signal = SIGKILL;
  std::vector<int> signals;
};

class RemoteBackendTest : public testing::Test {
 protected:
  RemoteBackendTest() { Connect(nullptr); }

  void Connect(WorkerPool* pool, bool without_ways = false, Reproducible known = Reproducible::kPromised) {
    DispatchOptions options;
    options.credit = 1;
    options.many_waiting = 1'000'000;  // never so many: leases are given one by one
    options.cpu_limit_seconds = 75.0;
    options.memory_limit_bytes = 123456789;
    options.without_ways = without_ways;
    options.reproducible = known;
    backend_.emplace(CampaignIdentity{"campaign-1", 5, "1.2.3", {{"first", 0xfeed}, {"second", 0xf00d}}},
                     options, transport_, clock_, pool);
  }

  static void SetGoldenHash(v1::Hello& hello, const std::string& controller, std::uint64_t hash) {
    v1::GoldenHash& golden = *hello.add_golden_hashes();
    golden.set_controller(controller);
    golden.set_hash(hash);
  }
  static v1::Hello HelloOf(InstanceId instance) {
    v1::Hello hello;
    hello.set_protocol_version(1);
    hello.set_campaign_id("campaign-1");
    hello.set_instance_id(instance);
    hello.set_software_version("1.2.3");
    for (const auto& [controller, hash] : {std::pair("first", 0xfeed), std::pair("second", 0xf00d)}) {
      SetGoldenHash(hello, controller, static_cast<std::uint64_t>(hash));
    }
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
  void SendResult(const PeerId& peer, const v1::Lease& lease, const std::string& result,
                  double cpu_seconds = 0.25) {
    v1::Envelope envelope;
    envelope.mutable_lease_result()->set_fence(lease.fence());
    envelope.mutable_lease_result()->set_run_id(lease.run_id());
    envelope.mutable_lease_result()->set_result(result);
    envelope.mutable_lease_result()->set_cpu_seconds(cpu_seconds);
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
  // Run 1 is submitted, and leased to kAnna, who says hello through this connection.
  v1::Lease LeaseRun1To(const PeerId& peer) {
    backend_->Submit({{1, "spec"}});
    SayHello(peer, HelloOf(kAnna));
    Poll();
    return LeasesSentTo(peer).at(0);
  }
  // The worker that has said hello through this connection finishes a run: its failures count from now on.
  void EarnTrust(const PeerId& peer, RunId run = 999) {
    backend_->Submit({{run, "spec"}});
    Poll();
    SendResult(peer, LeasesSentTo(peer).at(0), result_);
    EXPECT_EQ(Poll().size(), 1U);
    backend_->Acknowledge({run});
  }
  // Run 1 fails three times, each attempt as `fail` makes it; what came of it.
  std::vector<FinishedRun> FailRun1(const std::function<void(const v1::Lease&, int attempt)>& fail) {
    SayHello("p", HelloOf(kAnna));
    EarnTrust("p");
    backend_->Submit({{1, "spec"}});
    std::vector<FinishedRun> finished;
    for (int attempt = 1; attempt <= 3; ++attempt) {
      EXPECT_TRUE(finished.empty()) << attempt;
      Poll();
      fail(LeasesSentTo("p").at(0), attempt);
      finished = Poll();
    }
    EXPECT_EQ(finished.size(), 1U);
    finished.resize(1);
    return finished;
  }
  std::vector<FinishedRun> Poll(std::chrono::milliseconds timeout = std::chrono::milliseconds(0)) {
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
  const std::string result_ = proto::EncodeRunResult(SampleResult(0.5));
};

}  // namespace gauntlet
