// gauntlet-worker-noop: a worker whose runs do nothing, to measure everything around them. Its name and
// golden hash keep its results apart from real ones.
//   GAUNTLET_NOOP_MS=20 lets every run use that much CPU time.
#include <cstdlib>
#include <ctime>

#include "worker/command_line.h"

namespace gauntlet::worker {
namespace {

constexpr std::uint64_t kGoldenHash = 0x6e6f6f70;  // "noop"

double CpuSeconds() {
  timespec time{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

sim::RunResult DoNothing(const sim::RunSpec& spec) {
  static const char* const milliseconds = std::getenv("GAUNTLET_NOOP_MS");
  if (milliseconds != nullptr) {
    const double end = CpuSeconds() + 1e-3 * std::strtod(milliseconds, nullptr);
    while (CpuSeconds() < end) continue;
  }
  sim::RunResult result;
  result.fitness = static_cast<double>(spec.seed % 1000) / 1000.0;
  result.hash = sim::HashOf(result);
  return result;
}

}  // namespace
}  // namespace gauntlet::worker

int main(int argc, char** argv) {
  return gauntlet::worker::RunWorkerCommandLine(
      argc, argv, {gauntlet::worker::DoNothing, [] { return gauntlet::worker::kGoldenHash; }});
}
