// gauntlet-worker-slow: gauntlet-worker whose runs take longer, and no more CPU time, so that what happens to
// a cluster happens during an evolution. GAUNTLET_TEST_RUN_MILLISECONDS: added to each run. For tests only.
#include <poll.h>

#include <cstdlib>

#include "worker/command_line.h"
#include "worker/golden_hash.h"
#include "worker/run_executor.h"

namespace {

gauntlet::sim::RunResult SlowRun(const gauntlet::sim::RunSpec& spec) {
  const char* text = std::getenv("GAUNTLET_TEST_RUN_MILLISECONDS");
  poll(nullptr, 0, text == nullptr ? 0 : std::atoi(text));
  return gauntlet::worker::Run(spec);
}

}  // namespace

int main(int argc, char** argv) {
  return gauntlet::worker::RunWorkerCommandLine(argc, argv, {SlowRun, gauntlet::worker::GoldenHash});
}
