// What master and worker say to each other, as plain structs. The wire form and the meaning of every message
// stand in proto/README.md; proto/message_codec.h translates.
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "base/system/process_identity.h"
#include "proto/golden_hashes.h"

namespace gauntlet::proto {

// What both sides speak; a master refuses workers that speak another.
inline constexpr std::uint32_t kProtocolVersion = 1;
// No message is larger, in either direction.
inline constexpr std::size_t kMaxMessageBytes = 16u << 20;
// What a result may take of it: the rest is the envelope's.
inline constexpr std::size_t kMaxResultBytes = kMaxMessageBytes - 64u * 1024u;
// How much of what a failed run printed is kept: the end.
inline constexpr std::size_t kMaxStderrTail = 4096;

using RunId = std::uint64_t;       // 1, 2, 3, ... in logical order within a search; see proto/run_text.h
using InstanceId = std::uint64_t;  // random, not 0, one per worker process
using Fence = std::uint64_t;  // fencing number: names a lease, grows within a campaign, is never used twice

// A serialized gauntlet.v1.RunSpec and RunResult (proto/run_codec.h encodes and decodes them). Between who
// makes one and who reads it, it is passed on and stored as it is.
using EncodedSpec = std::string;
using EncodedResult = std::string;

struct Hello {
  std::uint32_t protocol_version = kProtocolVersion;
  std::string campaign_id;
  InstanceId instance_id = 0;
  std::string software_version;
  std::uint32_t slots = 1;  // runs simulated at the same time
  // Who the worker is, for a master on the same machine. `host` is for people; what is not known is "" or 0.
  ProcessIdentity process;
  std::vector<Fence> held_leases = {};  // that the worker works on, or holds results for
  std::string allocation;           // the batch job that holds the worker, as its script says; "" for none
  GoldenHashes golden_hashes = {};  // of the controllers that it was built with
  bool operator==(const Hello&) const = default;
};

struct Welcome {
  std::chrono::milliseconds heartbeat{1000};
  std::uint64_t epoch = 0;               // number of the master's start
  double cpu_limit_seconds = 0.0;        // CPU time of one run; 0 = no limit
  std::uint64_t memory_limit_bytes = 0;  // address space of one runner; 0 = no limit
  bool without_ways = false;             // results may be those of EncodeWithoutWays (run_codec.h)
};

struct Refused {
  std::string reason;
};

struct Lease {
  Fence fence = 0;
  RunId run_id = 0;
  EncodedSpec spec;
  std::uint32_t attempt = 1;  // 1 = the run's first lease
  // So long the result may wait at the worker for others, while more leases wait there than results do.
  std::chrono::milliseconds result_wait{0};
};

// How a runner ended that gave no result. The numbers are the wire's.
enum class FailureKind : int {
  kCrashed = 1,      // own fault: SIGSEGV, SIGABRT, an exception, an exit
  kHung = 2,         // own fault: more CPU time than allowed
  kOutOfMemory = 3,  // own fault: more memory than allowed
  // Ended from outside: with a signal, which counts as an attempt when its worker lives on, or given back.
  kExternal = 4,
};

struct RunnerFailure {
  FailureKind kind = FailureKind::kExternal;
  int signal = 0;                // 0 when it exited
  int exit_code = 0;             // 0 when a signal ended it
  std::string stderr_tail = {};  // at most kMaxStderrTail bytes
  bool operator==(const RunnerFailure&) const = default;
};

struct LeaseResult {
  Fence fence = 0;
  RunId run_id = 0;
  EncodedResult result = {};  // empty when `failure` is set
  std::optional<RunnerFailure> failure = {};
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

}  // namespace gauntlet::proto
