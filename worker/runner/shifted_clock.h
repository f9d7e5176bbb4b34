// The time of day as a plug-in sees it.
#pragma once

#include <chrono>

namespace gauntlet::worker {

// From now on `time`, `gettimeofday` and `clock_gettime` of CLOCK_REALTIME are so much ahead in this process
// and in those it forks: for whatever calls these functions through the dynamic linker, which looks for them
// in this program first. Two runs whose clocks differ by whole seconds also differ when they are simulated in
// one and the same second, so that comparing them finds a controller that is seeded by the time. Not
// thread-safe.
void ShiftTimeOfDay(std::chrono::seconds ahead);

}  // namespace gauntlet::worker
