#include "proto/message_codec.h"

#include <fmt/format.h>
#include <google/protobuf/stubs/logging.h>

#include <cmath>
#include <utility>

#include "proto/protocol.pb.h"

namespace gauntlet::worker {
namespace {

namespace v1 = gauntlet::v1;

constexpr std::uint32_t kMinHeartbeatMs = 10;
constexpr std::uint32_t kMaxHeartbeatMs = 600'000;

Result<MasterMessage> FromWire(const v1::Welcome& wire) {
  if (wire.heartbeat_ms() < kMinHeartbeatMs || wire.heartbeat_ms() > kMaxHeartbeatMs) {
    return InvalidInput(fmt::format("welcome: heartbeat_ms is {}, {} to {} is possible", wire.heartbeat_ms(),
                                    kMinHeartbeatMs, kMaxHeartbeatMs));
  }
  if (!std::isfinite(wire.cpu_limit_seconds()) || wire.cpu_limit_seconds() < 0.0) {
    return InvalidInput(fmt::format("welcome: cpu_limit_seconds is {}, a number from 0 is possible",
                                    wire.cpu_limit_seconds()));
  }
  return MasterMessage(Welcome{.heartbeat = std::chrono::milliseconds(wire.heartbeat_ms()),
                               .epoch = wire.epoch(),
                               .cpu_limit_seconds = wire.cpu_limit_seconds(),
                               .memory_limit_bytes = wire.memory_limit_bytes()});
}

struct ToWire {
  v1::Envelope& envelope;

  void operator()(const Hello& hello) const {
    v1::Hello& wire = *envelope.mutable_hello();
    wire.set_protocol_version(kProtocolVersion);
    wire.set_campaign_id(hello.campaign_id);
    wire.set_instance_id(hello.instance_id);
    wire.set_software_version(hello.software_version);
    wire.set_golden_hash(hello.golden_hash);
    wire.set_slots(hello.slots);
    wire.set_host(hello.host);
    wire.set_pid(hello.pid);
    wire.mutable_held_leases()->Add(hello.held_leases.begin(), hello.held_leases.end());
    wire.set_allocation(hello.allocation);
    for (const std::string& name : hello.controllers) wire.add_controllers(name);
    wire.set_boot_id(hello.boot_id);
    wire.set_pid_namespace(hello.pid_namespace);
    wire.set_start_time(hello.start_time);
  }
  void operator()(const LeaseResult& result) const {
    v1::LeaseResult& wire = *envelope.mutable_lease_result();
    wire.set_fence(result.fence);
    wire.set_run_id(result.run_id);
    wire.set_result(result.result);
    wire.set_cpu_seconds(result.cpu_seconds);
    if (!result.failure) return;
    v1::RunnerFailure& failure = *wire.mutable_failure();
    failure.set_kind(static_cast<v1::RunnerFailure::Kind>(result.failure->kind));
    failure.set_signal(result.failure->signal);
    failure.set_exit_code(result.failure->exit_code);
    failure.set_stderr_tail(result.failure->stderr_tail);
  }
  void operator()(const Heartbeat& heartbeat) const {
    v1::Heartbeat& wire = *envelope.mutable_heartbeat();
    wire.set_sequence(heartbeat.sequence);
    wire.mutable_held_leases()->Add(heartbeat.held_leases.begin(), heartbeat.held_leases.end());
  }
  void operator()(const Drain& drain) const {
    envelope.mutable_drain()->set_reason(drain.reason);
    envelope.mutable_drain()->set_finish_current(drain.finish_current);
  }
  void operator()(const Goodbye& goodbye) const { envelope.mutable_goodbye()->set_reason(goodbye.reason); }
};

}  // namespace

Result<MasterMessage> DecodeMasterMessage(std::string_view frame) {
  if (frame.size() > kMaxMessageBytes) {
    return InvalidInput(fmt::format("a message of {} bytes, {} are allowed", frame.size(), kMaxMessageBytes));
  }
  const google::protobuf::LogSilencer silencer;  // the error says enough
  v1::Envelope envelope;
  if (!envelope.ParseFromArray(frame.data(), static_cast<int>(frame.size()))) {
    return InvalidInput(fmt::format("{} bytes that are no envelope", frame.size()));
  }
  switch (envelope.message_case()) {
    case v1::Envelope::kWelcome:
      return FromWire(envelope.welcome());
    case v1::Envelope::kRefused:
      return MasterMessage(Refused{envelope.refused().reason()});
    case v1::Envelope::kLease: {
      v1::Lease& wire = *envelope.mutable_lease();
      return MasterMessage(Lease{.fence = wire.fence(),
                                 .run_id = wire.run_id(),
                                 .spec = std::move(*wire.mutable_spec()),
                                 .attempt = wire.attempt()});
    }
    case v1::Envelope::kAcknowledge: {
      const auto& fences = envelope.acknowledge().fences();
      return MasterMessage(Acknowledge{{fences.begin(), fences.end()}});
    }
    case v1::Envelope::kHeartbeat:
      return MasterMessage(Heartbeat{.sequence = envelope.heartbeat().sequence(), .held_leases = {}});
    case v1::Envelope::kCancel:
      return MasterMessage(Cancel{envelope.cancel().fence()});
    case v1::Envelope::kDrain:
      return MasterMessage(Drain{envelope.drain().reason(), envelope.drain().finish_current()});
    case v1::Envelope::kHello:
      return InvalidInput("hello, which only workers send");
    case v1::Envelope::kLeaseResult:
      return InvalidInput("lease_result, which only workers send");
    case v1::Envelope::kGoodbye:
      return InvalidInput("goodbye, which only workers send");
    case v1::Envelope::MESSAGE_NOT_SET:
      break;
  }
  return InvalidInput("an envelope without a message that this version knows");
}

std::string EncodeWorkerMessage(const WorkerMessage& message) {
  v1::Envelope envelope;
  std::visit(ToWire{envelope}, message);
  return envelope.SerializeAsString();
}

}  // namespace gauntlet::worker
