#include "proto/message_codec.h"

#include <fmt/format.h>
#include <google/protobuf/stubs/logging.h>

#include <cmath>
#include <limits>
#include <utility>

#include "proto/protocol.pb.h"

namespace gauntlet::proto {
namespace {

constexpr std::uint32_t kMinHeartbeatMs = 10;
constexpr std::uint32_t kMaxHeartbeatMs = 600'000;

struct ToWire {
  v1::Envelope& envelope;

  void operator()(const Hello& hello) const {
    v1::Hello& wire = *envelope.mutable_hello();
    wire.set_protocol_version(hello.protocol_version);
    wire.set_campaign_id(hello.campaign_id);
    wire.set_instance_id(hello.instance_id);
    wire.set_software_version(hello.software_version);
    wire.set_slots(hello.slots);
    wire.set_host(hello.process.host);
    wire.set_pid(hello.process.pid);
    wire.set_boot_id(hello.process.boot_id);
    wire.set_pid_namespace(hello.process.pid_namespace);
    wire.set_start_time(hello.process.start_time);
    wire.mutable_held_leases()->Add(hello.held_leases.begin(), hello.held_leases.end());
    wire.set_allocation(hello.allocation);
    for (const auto& [controller, hash] : hello.golden_hashes) {
      v1::GoldenHash& golden = *wire.add_golden_hashes();
      golden.set_controller(controller);
      golden.set_hash(hash);
    }
  }
  void operator()(const Welcome& welcome) const {
    v1::Welcome& wire = *envelope.mutable_welcome();
    wire.set_heartbeat_ms(static_cast<std::uint32_t>(welcome.heartbeat.count()));
    wire.set_epoch(welcome.epoch);
    wire.set_cpu_limit_seconds(welcome.cpu_limit_seconds);
    wire.set_memory_limit_bytes(welcome.memory_limit_bytes);
    wire.set_without_ways(welcome.without_ways);
  }
  void operator()(const Refused& refused) const { envelope.mutable_refused()->set_reason(refused.reason); }
  void operator()(const Lease& lease) const {
    v1::Lease& wire = *envelope.mutable_lease();
    wire.set_fence(lease.fence);
    wire.set_run_id(lease.run_id);
    wire.set_spec(lease.spec);
    wire.set_attempt(lease.attempt);
    wire.set_result_wait_ms(static_cast<std::uint32_t>(lease.result_wait.count()));
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
  void operator()(const Acknowledge& acknowledge) const {
    envelope.mutable_acknowledge()->mutable_fences()->Add(acknowledge.fences.begin(),
                                                          acknowledge.fences.end());
  }
  void operator()(const Heartbeat& heartbeat) const {
    v1::Heartbeat& wire = *envelope.mutable_heartbeat();
    wire.set_sequence(heartbeat.sequence);
    wire.mutable_held_leases()->Add(heartbeat.held_leases.begin(), heartbeat.held_leases.end());
  }
  void operator()(const Cancel& cancel) const { envelope.mutable_cancel()->set_fence(cancel.fence); }
  void operator()(const Drain& drain) const {
    envelope.mutable_drain()->set_reason(drain.reason);
    envelope.mutable_drain()->set_finish_current(drain.finish_current);
  }
  void operator()(const Goodbye& goodbye) const { envelope.mutable_goodbye()->set_reason(goodbye.reason); }
};

template <typename Message>
std::string Encode(const Message& message) {
  v1::Envelope envelope;
  std::visit(ToWire{envelope}, message);
  return envelope.SerializeAsString();
}

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
                               .memory_limit_bytes = wire.memory_limit_bytes(),
                               .without_ways = wire.without_ways()});
}

Hello FromWire(v1::Hello& wire) {
  Hello hello;
  hello.protocol_version = wire.protocol_version();
  hello.campaign_id = std::move(*wire.mutable_campaign_id());
  hello.instance_id = wire.instance_id();
  hello.software_version = std::move(*wire.mutable_software_version());
  hello.slots = wire.slots();
  const bool possible = wire.pid() > 0 && wire.pid() <= std::numeric_limits<pid_t>::max();
  hello.process = {.host = std::move(*wire.mutable_host()),
                   .boot_id = std::move(*wire.mutable_boot_id()),
                   .pid_namespace = std::move(*wire.mutable_pid_namespace()),
                   .pid = possible ? static_cast<pid_t>(wire.pid()) : 0,
                   .start_time = wire.start_time()};
  hello.held_leases.assign(wire.held_leases().begin(), wire.held_leases().end());
  hello.allocation = std::move(*wire.mutable_allocation());
  for (const v1::GoldenHash& golden : wire.golden_hashes())
    hello.golden_hashes[golden.controller()] = golden.hash();
  return hello;
}

FailureKind FromWire(v1::RunnerFailure::Kind kind) {
  switch (kind) {
    case v1::RunnerFailure::KIND_CRASHED:
    case v1::RunnerFailure::KIND_HUNG:
    case v1::RunnerFailure::KIND_OUT_OF_MEMORY:
      return static_cast<FailureKind>(kind);
    default:
      return FailureKind::kExternal;  // what is not known is not held against the run
  }
}

LeaseResult FromWire(v1::LeaseResult& wire) {
  LeaseResult result{.fence = wire.fence(),
                     .run_id = wire.run_id(),
                     .result = std::move(*wire.mutable_result()),
                     .failure = std::nullopt,
                     .cpu_seconds = wire.cpu_seconds()};
  if (wire.has_failure()) {
    v1::RunnerFailure& failure = *wire.mutable_failure();
    std::string tail = std::move(*failure.mutable_stderr_tail());
    if (tail.size() > kMaxStderrTail) tail.erase(0, tail.size() - kMaxStderrTail);
    result.failure = {FromWire(failure.kind()), failure.signal(), failure.exit_code(), std::move(tail)};
  }
  return result;
}

bool Parse(std::string_view frame, v1::Envelope& envelope) {
  const google::protobuf::LogSilencer silencer;  // strangers must not write to our stderr
  return envelope.ParseFromArray(frame.data(), static_cast<int>(frame.size()));
}

}  // namespace

std::string EncodeMasterMessage(const MasterMessage& message) {
  return Encode(message);
}

std::string EncodeWorkerMessage(const WorkerMessage& message) {
  return Encode(message);
}

Result<MasterMessage> DecodeMasterMessage(std::string_view frame) {
  if (frame.size() > kMaxMessageBytes) {
    return InvalidInput(fmt::format("a message of {} bytes, {} are allowed", frame.size(), kMaxMessageBytes));
  }
  v1::Envelope envelope;
  if (!Parse(frame, envelope))
    return InvalidInput(fmt::format("{} bytes that are no envelope", frame.size()));
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
                                 .attempt = wire.attempt(),
                                 .result_wait = std::chrono::milliseconds(wire.result_wait_ms())});
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

Result<WorkerMessage> DecodeWorkerMessage(std::string_view frame) {
  v1::Envelope envelope;
  if (!Parse(frame, envelope)) return InvalidInput("does not parse as an envelope");
  switch (envelope.message_case()) {
    case v1::Envelope::kHello:
      return WorkerMessage(FromWire(*envelope.mutable_hello()));
    case v1::Envelope::kHeartbeat: {
      const v1::Heartbeat& wire = envelope.heartbeat();
      return WorkerMessage(
          Heartbeat{wire.sequence(), {wire.held_leases().begin(), wire.held_leases().end()}});
    }
    case v1::Envelope::kLeaseResult:
      return WorkerMessage(FromWire(*envelope.mutable_lease_result()));
    case v1::Envelope::kDrain:
      return WorkerMessage(Drain{envelope.drain().reason(), envelope.drain().finish_current()});
    case v1::Envelope::kGoodbye:
      return WorkerMessage(Goodbye{envelope.goodbye().reason()});
    case v1::Envelope::MESSAGE_NOT_SET:
      return InvalidInput("is an envelope with no message that this version knows");
    default:
      return InvalidInput("is a message that only a master sends");
  }
}

}  // namespace gauntlet::proto
