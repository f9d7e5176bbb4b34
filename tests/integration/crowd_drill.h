// Many more workers than cores, all at work: none may be taken for lost.
#pragma once

#include <chrono>
#include <string>

namespace gauntlet::testing_support {

struct CrowdReport {
  int joined = 0;        // workers that were connected at the end
  int lost = 0;          // workers that were taken for lost
  int leased_again = 0;  // runs that were given to somebody else
  int runs = 0;
  double load = 0.0;  // processes that wanted to run, on average over the last minute (/proc/loadavg)
};

// A campaign of flocking with so many workers on this machine: half of them its own, half started beside it.
// It goes on for `duration` after all have joined, and is then stopped.
CrowdReport WatchACrowd(const std::string& dir, int workers, std::chrono::seconds duration);

}  // namespace gauntlet::testing_support
