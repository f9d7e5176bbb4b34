// Who a process is, well enough to tell later, from another process, whether it still lives.
#pragma once

#include <sys/types.h>

#include <cstdint>
#include <optional>
#include <string>

namespace gauntlet {

struct ProcessIdentity {
  std::string host;
  std::string boot_id;        // of this start of the kernel; /proc/sys/kernel/random/boot_id
  std::string pid_namespace;  // pids of another namespace mean other processes; /proc/self/ns/pid
  pid_t pid = 0;
  std::uint64_t start_time = 0;  // clock ticks since boot: a reused pid has another one (field 22 of
                                 // /proc/PID/stat)

  bool operator==(const ProcessIdentity&) const = default;
};

ProcessIdentity IdentifyThisProcess();

// Start time of a process of this machine; empty when there is none, or only its zombie.
std::optional<std::uint64_t> StartTimeOf(pid_t pid);

// The fields of a stat file of /proc from the third, the state, on; empty when there is none.
std::string StatFromState(const std::string& path);

// Who started a process or thread of this machine, or took it over as an orphan; 0 when there is none.
pid_t ParentOf(pid_t pid);

// Is a thread of this process of this machine running or ready to run? Not when all sleep or are stopped.
bool AnyThreadIsRunnable(pid_t pid);

enum class Liveness { kAlive, kDead, kUnknown };  // kUnknown: of another host, boot or pid namespace

// Judges `process` from `observer`'s point of view, which is this process.
Liveness LivenessOf(const ProcessIdentity& process, const ProcessIdentity& observer);

}  // namespace gauntlet
