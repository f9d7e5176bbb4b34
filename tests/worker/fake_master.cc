#include "tests/worker/fake_master.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cstdio>
#include <fstream>
#include <zmq.hpp>

#include "base/thread_sanitizer.h"
#include "proto/run.pb.h"
#include "tests/support/process.h"

namespace gauntlet::worker {

using std::chrono::milliseconds;
using std::chrono::steady_clock;

struct FakeMaster::Socket {
  zmq::context_t context{1};
  zmq::socket_t router{context, zmq::socket_type::router};
};

FakeMaster::FakeMaster(const std::string& access_path, std::uint64_t epoch, const std::string& campaign)
    : socket_(std::make_unique<Socket>()), epoch_(epoch) {
  socket_->router.set(zmq::sockopt::linger, 0);
  socket_->router.bind("tcp://127.0.0.1:*");
  WriteAccess(access_path, epoch, {endpoint()}, campaign);
}

FakeMaster::~FakeMaster() = default;

std::string FakeMaster::endpoint() const {
  return socket_->router.get(zmq::sockopt::last_endpoint);
}

bool FakeMaster::BreakConnections() {
  const std::string same = endpoint();
  socket_->router.close();
  socket_->router = zmq::socket_t(socket_->context, zmq::socket_type::router);
  socket_->router.set(zmq::sockopt::linger, 0);
  // The former socket is closed by another thread.
  return testing_support::Eventually(
      [&] {
        try {
          socket_->router.bind(same);
          return true;
        } catch (const zmq::error_t&) {
          return false;
        }
      },
      kPatience);
}

std::optional<Incoming> FakeMaster::Next(milliseconds deadline) {
  zmq::pollitem_t item{socket_->router.handle(), 0, ZMQ_POLLIN, 0};
  if (zmq::poll(&item, 1, deadline) == 0) return std::nullopt;
  zmq::message_t peer;
  zmq::message_t frame;
  EXPECT_TRUE(socket_->router.recv(peer).has_value());
  EXPECT_TRUE(socket_->router.recv(frame).has_value());
  EXPECT_FALSE(frame.more()) << "one frame holds one envelope";
  Incoming incoming{peer.to_string(), {}};
  EXPECT_TRUE(incoming.envelope.ParseFromString(frame.to_string()));
  return incoming;
}

std::optional<Incoming> FakeMaster::Await(v1::Envelope::MessageCase kind, milliseconds deadline) {
  const auto end = steady_clock::now() + deadline;
  while (steady_clock::now() < end) {
    auto incoming = Next(std::chrono::ceil<milliseconds>(end - steady_clock::now()));
    if (!incoming) break;
    if (incoming->envelope.message_case() == v1::Envelope::kHeartbeat) {
      v1::Envelope heartbeat;
      heartbeat.mutable_heartbeat()->set_sequence(1);
      Send(incoming->peer, heartbeat);
    }
    if (incoming->envelope.message_case() == kind) return incoming;
  }
  return std::nullopt;
}

std::string FakeMaster::WelcomeOne(double cpu_limit_seconds, std::uint64_t memory_limit_bytes,
                                   std::uint32_t heartbeat_ms) {
  const auto hello = Await(v1::Envelope::kHello);
  if (!hello) return "";
  v1::Envelope envelope;
  v1::Welcome& welcome = *envelope.mutable_welcome();
  welcome.set_heartbeat_ms(heartbeat_ms);
  welcome.set_epoch(epoch_);
  welcome.set_cpu_limit_seconds(cpu_limit_seconds);
  welcome.set_memory_limit_bytes(memory_limit_bytes);
  Send(hello->peer, envelope);
  return hello->peer;
}

void FakeMaster::Send(const std::string& peer, const v1::Envelope& envelope) {
  SendRaw(peer, envelope.SerializeAsString());
}

void FakeMaster::SendRaw(const std::string& peer, const std::string& bytes) {
  socket_->router.send(zmq::buffer(peer), zmq::send_flags::sndmore);
  socket_->router.send(zmq::buffer(bytes), zmq::send_flags::none);
}

void FakeMaster::Lease(const std::string& peer, std::uint64_t fence, std::uint64_t what,
                       const std::string& scenario, bool record_trajectory) {
  v1::Envelope envelope;
  v1::Lease& lease = *envelope.mutable_lease();
  lease.set_fence(fence);
  lease.set_run_id(fence + 1000);
  lease.set_spec(SpecBytes(what, scenario, record_trajectory));
  lease.set_attempt(1);
  Send(peer, envelope);
}

void FakeMaster::Acknowledge(const std::string& peer, std::uint64_t fence) {
  v1::Envelope envelope;
  envelope.mutable_acknowledge()->add_fences(fence);
  Send(peer, envelope);
}

void FakeMaster::Drain(const std::string& peer, bool finish_current) {
  v1::Envelope envelope;
  envelope.mutable_drain()->set_reason("the test is over");
  envelope.mutable_drain()->set_finish_current(finish_current);
  Send(peer, envelope);
}

std::optional<v1::LeaseResult> FakeMaster::AwaitResult(const std::string& peer, std::uint64_t fence) {
  const auto end = steady_clock::now() + kPatience;
  while (steady_clock::now() < end) {
    const auto incoming = Await(v1::Envelope::kLeaseResult);
    if (!incoming || incoming->envelope.lease_result().fence() != fence) continue;
    Acknowledge(peer, fence);
    return incoming->envelope.lease_result();
  }
  return std::nullopt;
}

void WriteAccess(const std::string& path, std::uint64_t epoch, const std::vector<std::string>& endpoints,
                 const std::string& campaign) {
  const std::string temporary = path + ".new";
  std::ofstream(temporary) << fmt::format(
      R"({{"format": 1, "campaign": "{}", "epoch": {}, "endpoints": ["{}"]}})", campaign, epoch,
      fmt::join(endpoints, R"(", ")"));
  std::rename(temporary.c_str(), path.c_str());
}

std::string SpecBytes(std::uint64_t what, const std::string& scenario, bool record_trajectory) {
  v1::RunSpec spec;
  spec.set_seed(what);
  spec.set_scenario(scenario);
  spec.set_record_trajectory(record_trajectory);
  return spec.SerializeAsString();
}

}  // namespace gauntlet::worker
