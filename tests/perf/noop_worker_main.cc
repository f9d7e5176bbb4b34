// gauntlet-worker-noop: a worker whose runs do nothing, to measure everything around them. Its name and
// golden hashes keep its results apart from real ones.
//   GAUNTLET_NOOP_MS=20 lets every run use that much CPU time.
#include <cstdlib>
#include <ctime>

#include "tests/perf/noop_runs.h"
#include "worker/command_line.h"

namespace gauntlet::worker {
namespace {

// Of this thread, the runner's only one: while a limit on CPU time is set, Linux moves the process' clock on
// at scheduler ticks only, and a run of 50 ms took 51.3.
double CpuSeconds() {
  timespec time{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

sim::RunResult DoNothing(const sim::RunSpec& spec) {
  static const char* const milliseconds = std::getenv("GAUNTLET_NOOP_MS");
  static const double seconds = milliseconds == nullptr ? 0.0 : 1e-3 * std::strtod(milliseconds, nullptr);
  if (seconds > 0.0) {
    const double end = CpuSeconds() + seconds;
    while (CpuSeconds() < end) continue;
  }
  return perf::NoopResult(spec.seed);
}

}  // namespace
}  // namespace gauntlet::worker

int main(int argc, char** argv) {
  return gauntlet::worker::RunWorkerCommandLine(argc, argv, {gauntlet::worker::DoNothing, [](const auto&) {
                                                               return gauntlet::perf::kNoopGoldenHashes;
                                                             }});
}
