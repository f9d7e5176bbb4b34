// gauntlet-worker-faulty: a worker whose runs crash, hang, grow or wait as their seed says. For tests only.
//   gauntlet-worker-faulty ACCESS_FILE SLOTS ORPHAN_TIMEOUT_SECONDS [--die-with-parent]
//   gauntlet-worker-faulty --run-spec FILE CPU_SECONDS MEMORY_BYTES
#include <fcntl.h>
#include <sys/socket.h>
#include <unistd.h>

#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <memory>
#include <new>
#include <stdexcept>
#include <string>
#include <vector>

#include "tests/worker/faulty_runs.h"
#include "worker/worker_process.h"

namespace gauntlet::worker {
namespace {

void Nap() {
  const timespec pause{.tv_sec = 0, .tv_nsec = 2'000'000};
  nanosleep(&pause, nullptr);
}

void AllocateForEver() {
  // The limit is one of address space: pages that nobody touches count too, and cost no time.
  std::vector<std::unique_ptr<char[]>> hoard;
  while (true) hoard.emplace_back(new char[1 << 20]);
}

sim::RunResult FaultyRunFunction(const sim::RunSpec& spec) {
  volatile int* nowhere = nullptr;
  volatile std::uint64_t counter = 0;
  switch (spec.seed) {
    case kAbort:
      std::fputs("about to abort\n", stderr);
      std::abort();
    case kSegmentationFault:
      *nowhere = 1;
      break;
    case kSpin:
      while (true) counter = counter + 1;
    case kAllocate:
      AllocateForEver();
      break;
    case kAllocateHuge:
      operator delete(operator new (std::size_t{1} << 46));
      break;
    case kThrow:
      throw std::runtime_error("thrown on purpose");
    case kExitWithThree:
      _exit(3);
    case kPrintForEver:
      while (true) std::fputs("noise\n", stderr);
    case kWaitForFile:
      close(open((spec.scenario + kBegun).c_str(), O_CREAT | O_WRONLY | O_CLOEXEC, 0600));
      while (access(spec.scenario.c_str(), F_OK) != 0) Nap();
      break;
    case kClosePipe:
      for (int fd = 3; fd < 1024; ++fd) close(fd);
      while (true) pause();
    case kWriteGarbage:
      for (int fd = 3; fd < 1024; ++fd) send(fd, "\x02\0\0\0??", 6, MSG_NOSIGNAL);
      while (true) pause();
    case kSleep:
      while (true) pause();
    default:
      break;
  }
  sim::RunResult result;
  result.fitness = 0.5;
  sim::SetHashes(result);
  if (spec.record_trajectory) result.trajectory.assign(20'000, std::vector<sim::RobotState>(50));
  return result;
}

int Main(const std::vector<std::string>& arguments) {
  if (arguments.size() == 4 && arguments[0] == "--run-spec") {
    return RunOneSpec({.spec_file = arguments[1],
                       .cpu_limit_seconds = std::stod(arguments[2]),
                       .memory_limit_bytes = std::stoull(arguments[3]),
                       .parent = getppid()},
                      FaultyRunFunction);
  }
  if (arguments.size() < 3) return 2;
  return RunWorker({.access_path = arguments[0],
                    .slots = std::stoi(arguments[1]),
                    .parent = arguments.size() > 3 ? getppid() : 0,
                    .orphan_timeout_seconds = std::stod(arguments[2]),
                    .log_file = "",
                    .quiet = false,
                    .allocation = "",
                    .software_version = "test",
                    .golden_hashes =
                        [](const std::vector<std::string>&) {
                          return proto::GoldenHashes{{"faulty", 42}};
                        }},
                   FaultyRunFunction);
}

}  // namespace
}  // namespace gauntlet::worker

int main(int argc, char** argv) {
  return gauntlet::worker::Main({argv + 1, argv + argc});
}
