#include "master/dispatch/wire.h"

#include <google/protobuf/stubs/logging.h>

#include <utility>

#include "proto/protocol.pb.h"

namespace gauntlet::master {
namespace {

FailureKind KindOf(v1::RunnerFailure::Kind kind) {
  switch (kind) {
    case v1::RunnerFailure::KIND_CRASHED:
      return FailureKind::kCrashed;
    case v1::RunnerFailure::KIND_HUNG:
      return FailureKind::kHung;
    case v1::RunnerFailure::KIND_OUT_OF_MEMORY:
      return FailureKind::kOutOfMemory;
    default:
      // A kind of failure that this version does not know is not held against the run.
      return FailureKind::kExternal;
  }
}

HelloMessage From(v1::Hello& hello) {
  HelloMessage message;
  message.protocol_version = hello.protocol_version();
  message.campaign_id = std::move(*hello.mutable_campaign_id());
  message.instance_id = hello.instance_id();
  message.software_version = std::move(*hello.mutable_software_version());
  message.golden_hash = hello.golden_hash();
  message.slots = hello.slots();
  message.host = std::move(*hello.mutable_host());
  message.pid = hello.pid();
  message.boot_id = std::move(*hello.mutable_boot_id());
  message.pid_namespace = std::move(*hello.mutable_pid_namespace());
  message.start_time = hello.start_time();
  message.held.assign(hello.held_leases().begin(), hello.held_leases().end());
  message.allocation = std::move(*hello.mutable_allocation());
  message.controllers.assign(hello.controllers().begin(), hello.controllers().end());
  return message;
}

ResultMessage From(v1::LeaseResult& result) {
  ResultMessage message;
  message.fence = result.fence();
  message.run = result.run_id();
  message.result = std::move(*result.mutable_result());
  message.cpu_seconds = result.cpu_seconds();
  if (result.has_failure()) {
    v1::RunnerFailure& failure = *result.mutable_failure();
    message.failure = RunFailure{KindOf(failure.kind()), failure.signal(), failure.exit_code()};
    message.stderr_tail = std::move(*failure.mutable_stderr_tail());
    if (message.stderr_tail.size() > kMostStderrTail)
      message.stderr_tail.erase(0, message.stderr_tail.size() - kMostStderrTail);
  }
  return message;
}

}  // namespace

Result<WorkerMessage> DecodeWorkerMessage(std::string_view bytes) {
  const google::protobuf::LogSilencer silencer;  // strangers must not write to our stderr
  v1::Envelope envelope;
  if (!envelope.ParseFromArray(bytes.data(), static_cast<int>(bytes.size()))) {
    return InvalidInput("does not parse as an envelope");
  }
  switch (envelope.message_case()) {
    case v1::Envelope::kHello:
      return WorkerMessage(From(*envelope.mutable_hello()));
    case v1::Envelope::kHeartbeat:
      return WorkerMessage(HeartbeatMessage{
          {envelope.heartbeat().held_leases().begin(), envelope.heartbeat().held_leases().end()}});
    case v1::Envelope::kLeaseResult:
      return WorkerMessage(From(*envelope.mutable_lease_result()));
    case v1::Envelope::kDrain:
      return WorkerMessage(DrainMessage{std::move(*envelope.mutable_drain()->mutable_reason())});
    case v1::Envelope::kGoodbye:
      return WorkerMessage(GoodbyeMessage{std::move(*envelope.mutable_goodbye()->mutable_reason())});
    case v1::Envelope::MESSAGE_NOT_SET:
      return InvalidInput("is an envelope with no message that this version knows");
    default:
      return InvalidInput("is a message that only a master sends");
  }
}

std::string EncodeWelcome(const DispatchOptions& options, std::uint64_t epoch) {
  v1::Envelope envelope;
  v1::Welcome& welcome = *envelope.mutable_welcome();
  welcome.set_heartbeat_ms(static_cast<std::uint32_t>(options.heartbeat.count()));
  welcome.set_epoch(epoch);
  welcome.set_cpu_limit_seconds(options.cpu_limit_seconds);
  welcome.set_memory_limit_bytes(options.memory_limit_bytes);
  return envelope.SerializeAsString();
}

std::string EncodeRefused(const std::string& reason) {
  v1::Envelope envelope;
  envelope.mutable_refused()->set_reason(reason);
  return envelope.SerializeAsString();
}

std::string EncodeLease(const LeaseOrder& lease, const std::string& spec) {
  v1::Envelope envelope;
  v1::Lease& message = *envelope.mutable_lease();
  message.set_fence(lease.fence);
  message.set_run_id(lease.run);
  message.set_spec(spec);
  message.set_attempt(lease.attempt);
  return envelope.SerializeAsString();
}

std::string EncodeAcknowledge(const std::vector<Fence>& fences) {
  v1::Envelope envelope;
  envelope.mutable_acknowledge()->mutable_fences()->Add(fences.begin(), fences.end());
  return envelope.SerializeAsString();
}

std::string EncodeHeartbeat(std::uint64_t sequence) {
  v1::Envelope envelope;
  envelope.mutable_heartbeat()->set_sequence(sequence);
  return envelope.SerializeAsString();
}

std::string EncodeCancel(Fence fence) {
  v1::Envelope envelope;
  envelope.mutable_cancel()->set_fence(fence);
  return envelope.SerializeAsString();
}

std::string EncodeDrain(const std::string& reason, bool finish_current) {
  v1::Envelope envelope;
  envelope.mutable_drain()->set_reason(reason);
  envelope.mutable_drain()->set_finish_current(finish_current);
  return envelope.SerializeAsString();
}

}  // namespace gauntlet::master
