// The floor under every figure of the service: a ROUTER and DEALERs in processes of their own that exchange
// messages of a lease's and a result's size, and do nothing else.
#pragma once

#include <cstddef>
#include <string>

namespace gauntlet::perf {

struct BareLoop {
  std::size_t exchanges = 50'000;
  int workers = 2;
  std::size_t ahead = 2;  // messages that wait at each worker
  std::string lease;      // what is sent to a worker
  std::string result;     // what comes back
  bool curve = false;     // encrypted by CurveZMQ
};

// Exchanges per second; 0 when a process or socket could not be made. Must be called before this process has
// threads: it forks.
double RunBareLoop(const BareLoop& loop);

}  // namespace gauntlet::perf
