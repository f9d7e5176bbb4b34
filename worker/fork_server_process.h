// The fork server's own process and what it says to its supervisor over the control socket.
#pragma once

#include <sys/types.h>

#include <cstdint>

#include "worker/pipe.h"
#include "worker/runner.h"

namespace gauntlet::worker {

// One packet on the control socket; both ends are the same program.
struct ForkServerMessage {
  enum Type : std::int32_t {
    kStart = 1,   // supervisor: fork a runner
    kKill,        // supervisor: send signal `value` to runner `pid`
    kStarted,     // server: runner `pid` lives; two descriptors come along: pipe, output
    kNotStarted,  // server: it could not be forked, `value` = errno
    kExited,      // server: runner `pid` is reaped, `value` = its status, `cpu_seconds` = its whole CPU time
  };
  Type type = kStart;
  pid_t pid = 0;
  std::int32_t value = 0;
  double cpu_seconds = 0.0;
};

struct ReceivedMessage {
  ForkServerMessage message;
  UniqueFd first;
  UniqueFd second;
};
enum class ReceiveState { kNothing, kEnded, kMessage };

// `flags` as for recvmsg. kEnded also when the packet is damaged.
// Descriptors that did not come along, or found no room here, are invalid.
ReceiveState ReceiveMessage(int control, int flags, ReceivedMessage& received);

// The process' life; returns never. Ends, with all runners, when `control` ends or `supervisor` dies.
[[noreturn]] void ForkServerMain(UniqueFd control, pid_t supervisor, const RunFunction& run);

}  // namespace gauntlet::worker
