// The master's side of proto/protocol.proto as plain structs: what workers say is decoded, what the master
// says is encoded. One envelope per message.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "base/result.h"
#include "master/dispatch/scheduler.h"

namespace gauntlet::master {

inline constexpr std::uint32_t kProtocolVersion = 1;

struct HelloMessage {
  std::uint32_t protocol_version = 0;
  std::string campaign_id;
  InstanceId instance_id = 0;
  std::string software_version;
  std::uint64_t golden_hash = 0;
  std::uint32_t slots = 0;
  std::string host;
  std::int64_t pid = 0;
  std::string boot_id;  // with the two below: who `pid` is (ProcessIdentity); "" when not known
  std::string pid_namespace;
  std::uint64_t start_time = 0;
  std::vector<Fence> held;
  std::string allocation;  // "" for none
  std::vector<std::string> controllers;
};

struct HeartbeatMessage {
  std::vector<Fence> held;
};

// Workers send no more; of a longer one the end is kept.
inline constexpr std::size_t kMostStderrTail = 4096;

struct ResultMessage {
  Fence fence = 0;
  RunId run = 0;
  std::string result;  // serialized RunResult; empty when the runner failed
  std::optional<RunFailure> failure;
  std::string stderr_tail;  // at most kMostStderrTail bytes, the end
  double cpu_seconds = 0.0;
};

struct DrainMessage {
  std::string reason;
};

struct GoodbyeMessage {
  std::string reason;
};

using WorkerMessage =
    std::variant<HelloMessage, HeartbeatMessage, ResultMessage, DrainMessage, GoodbyeMessage>;

// Error: not an envelope, or one that only masters send.
Result<WorkerMessage> DecodeWorkerMessage(std::string_view bytes);

std::string EncodeWelcome(const DispatchOptions& options, std::uint64_t epoch);
std::string EncodeRefused(const std::string& reason);
std::string EncodeLease(const LeaseOrder& lease, const std::string& spec);
std::string EncodeAcknowledge(const std::vector<Fence>& fences);
std::string EncodeHeartbeat(std::uint64_t sequence);
std::string EncodeCancel(Fence fence);
std::string EncodeDrain(const std::string& reason, bool finish_current);

}  // namespace gauntlet::master
