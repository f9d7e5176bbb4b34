// gauntlet-worker-slow: gauntlet-worker whose runs take longer, and no more CPU time, so that what happens to
// a cluster happens during an evolution. For tests only.
//   GAUNTLET_TEST_RUN_MILLISECONDS  added to each run
//   GAUNTLET_TEST_RUN_LOG           file to which each run appends its seed when it begins
#include <fcntl.h>
#include <poll.h>
#include <unistd.h>

#include <cstdlib>
#include <string>

#include "worker/command_line.h"
#include "worker/golden_hash.h"
#include "worker/plugin/plugin_library.h"
#include "worker/run_executor.h"

namespace {

void LogRun(std::uint64_t seed) {
  const char* path = std::getenv("GAUNTLET_TEST_RUN_LOG");
  if (path == nullptr || *path == '\0') return;
  const std::string line = std::to_string(seed) + "\n";
  const int fd = open(path, O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC, 0644);
  // One write, so that lines of several runners do not mix; a kill after it makes no difference to it.
  if (fd < 0 || write(fd, line.data(), line.size()) != static_cast<ssize_t>(line.size())) std::abort();
  close(fd);
}

gauntlet::sim::RunResult SlowRun(const gauntlet::sim::RunSpec& spec) {
  LogRun(spec.seed);
  const char* text = std::getenv("GAUNTLET_TEST_RUN_MILLISECONDS");
  poll(nullptr, 0, text == nullptr ? 0 : std::atoi(text));
  return gauntlet::worker::Run(spec);
}

}  // namespace

int main(int argc, char** argv) {
  namespace worker = gauntlet::worker;
  return worker::RunWorkerCommandLine(argc, argv,
                                      {.run = SlowRun,
                                       .golden_hashes = worker::GoldenHashes,
                                       .load_plugin = worker::LoadPlugin,
                                       .describe_plugin = worker::DescribePlugin,
                                       .describe_beginning = worker::DescribeBeginning});
}
