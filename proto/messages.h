// What master and worker say to each other, as plain structs. The wire form and the meaning of every message
// stand in proto/README.md; proto/message_codec.h translates.
#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>
#include <variant>
#include <vector>

namespace gauntlet::worker {

// The protocol this worker speaks; a master refuses any other.
inline constexpr std::uint32_t kProtocolVersion = 1;

// Fencing number: names a lease within a campaign, for ever.
using Fence = std::uint64_t;

struct Hello {
  std::string campaign_id;
  std::uint64_t instance_id = 0;  // random, one per worker process
  std::string software_version;
  std::uint64_t golden_hash = 0;
  std::uint32_t slots = 1;  // runs simulated at the same time
  std::string host;
  std::int64_t pid = 0;
  std::vector<Fence> held_leases;
  std::string allocation;  // the batch job that holds the worker, as its script says; "" for none
  std::vector<std::string> controllers = {};  // names of those it can simulate
  // Who `pid` is, for a master on the same machine (worker/process_identity.h); "" and 0 when not known.
  std::string boot_id = {};
  std::string pid_namespace = {};
  std::uint64_t start_time = 0;  // clock ticks since boot
  bool operator==(const Hello&) const = default;
};

struct Welcome {
  std::chrono::milliseconds heartbeat{1000};
  std::uint64_t epoch = 0;               // number of the master's start
  double cpu_limit_seconds = 0.0;        // CPU time of one run; 0 = no limit
  std::uint64_t memory_limit_bytes = 0;  // address space of one runner; 0 = no limit
};

struct Refused {
  std::string reason;
};

struct Lease {
  Fence fence = 0;
  std::uint64_t run_id = 0;
  std::string spec;  // serialized gauntlet.v1.RunSpec
  std::uint32_t attempt = 1;
};

// How a runner ended that gave no result. The numbers are the wire's.
enum class FailureKind : int {
  kCrashed = 1,      // own fault: SIGSEGV, SIGABRT, an exception, an exit
  kHung = 2,         // own fault: more CPU time than allowed
  kOutOfMemory = 3,  // own fault: more memory than allowed
  kExternal = 4,     // not the run's fault: killed from outside, dropped by a drain
};

struct RunnerFailure {
  FailureKind kind = FailureKind::kExternal;
  int signal = 0;           // 0 when it exited
  int exit_code = 0;        // 0 when a signal ended it
  std::string stderr_tail;  // at most kStderrTailBytes, valid UTF-8
  bool operator==(const RunnerFailure&) const = default;
};

struct LeaseResult {
  Fence fence = 0;
  std::uint64_t run_id = 0;
  std::string result;  // serialized gauntlet.v1.RunResult; empty when `failure` is set
  std::optional<RunnerFailure> failure;
  double cpu_seconds = 0.0;
  bool operator==(const LeaseResult&) const = default;
};

struct Acknowledge {
  std::vector<Fence> fences;
};

struct Heartbeat {
  std::uint64_t sequence = 0;
  std::vector<Fence> held_leases;  // only a worker fills it
};

struct Cancel {
  Fence fence = 0;
};

struct Drain {
  std::string reason;
  bool finish_current = true;
};

struct Goodbye {
  std::string reason;
};

using MasterMessage = std::variant<Welcome, Refused, Lease, Acknowledge, Heartbeat, Cancel, Drain>;
using WorkerMessage = std::variant<Hello, LeaseResult, Heartbeat, Drain, Goodbye>;

}  // namespace gauntlet::worker
