// Random conversations on a master's port: damaged greetings, commands, frames and messages.
#pragma once

#include <cstdint>
#include <functional>

namespace gauntlet::testing_support {

struct ZmtpFuzzReport {
  std::uint64_t connections = 0;  // that the master took
  std::uint64_t bytes = 0;        // that were sent on them
};

// Talks to a port of this machine until `go_on` says no. Half of the conversations are those of a worker,
// whole up to some place and damaged there; the others are damaged at several places. `encrypted`: they begin
// as a CURVE client's would. The sequence depends on the seed alone.
ZmtpFuzzReport FuzzPort(int port, bool encrypted, std::uint64_t seed, const std::function<bool()>& go_on);

}  // namespace gauntlet::testing_support
