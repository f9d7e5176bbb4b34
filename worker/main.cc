// gauntlet-worker: simulates runs for a master.
#include "worker/command_line.h"
#include "worker/golden_hash.h"
#include "worker/run_executor.h"

int main(int argc, char** argv) {
  return gauntlet::worker::RunWorkerCommandLine(argc, argv,
                                                {gauntlet::worker::Run, gauntlet::worker::GoldenHash});
}
