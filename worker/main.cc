// gauntlet-worker: simulates runs for a master.
#include "base/version.h"
#include "worker/command_line.h"
#include "worker/golden_hash.h"
#include "worker/plugin/plugin_library.h"
#include "worker/run_executor.h"

int main(int argc, char** argv) {
  namespace worker = gauntlet::worker;
  return worker::RunWorkerCommandLine(argc, argv,
                                      {.run = worker::Run,
                                       .golden_hashes = worker::GoldenHashes,
                                       .load_plugin = worker::LoadPlugin,
                                       .describe_plugin = worker::DescribePlugin,
                                       .describe_beginning = worker::DescribeBeginning,
                                       .version = gauntlet::VersionText("gauntlet-worker")});
}
