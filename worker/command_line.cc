#include "worker/command_line.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <string>

#include "worker/worker_process.h"

namespace gauntlet::worker {
namespace {

constexpr const char* kDescription =
    "Simulates runs for a Gauntlet master.\n\n"
    "A worker looks for its master in the campaign's access.json, takes leases, simulates every run in a "
    "child\n"
    "process under limits, and hands the results in. When the master goes away the worker keeps what it has "
    "and\n"
    "looks for the master's successor in the same file. SIGTERM or Ctrl-C lets it finish the current runs "
    "and\n"
    "leave; a second one drops them.\n";

constexpr const char* kFooter =
    "\nExit codes: 0 done (drained, or let go by the master); 2 wrong command line, or refused by the "
    "master;\n"
    "3 no master within the orphan timeout; 4 internal error.\n\n"
    "Examples:\n"
    "  gauntlet-worker --dir campaigns/flocking-1            serve the campaign in that directory\n"
    "  gauntlet-worker --access /shared/access.json --slots 8\n"
    "  gauntlet-worker --run-spec spec.bin > result.bin      simulate one stored spec\n";

// CLI::Range lets "nan" through.
CLI::Validator Seconds() {
  return CLI::Validator(
      [](const std::string& text) {
        double seconds = 0.0;
        const bool number = CLI::detail::lexical_cast(text, seconds);
        return number && seconds >= 0.0 && seconds <= 1e9
                   ? std::string()
                   : fmt::format("'{}' is no number of seconds from 0 to 1e9", text);
      },
      "S");
}

// Whatever is opened next would become a standard stream that is closed, and take what is written there.
// Writing to a stand-in for stdout fails, as it should.
void OccupyStandardStreams() {
  for (const int fd : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) {
    if (fcntl(fd, F_GETFD) >= 0) continue;
    [[maybe_unused]] const int opened = open("/dev/null", fd == STDERR_FILENO ? O_WRONLY : O_RDONLY);
  }
}

}  // namespace

int RunWorkerCommandLine(int argc, char** argv, const WorkerFunctions& functions) {
  OccupyStandardStreams();
  CLI::App app(kDescription, "gauntlet-worker");
  app.footer(kFooter);
  app.set_version_flag("--version", "gauntlet-worker " GAUNTLET_VERSION);

  WorkerOptions worker;
  worker.software_version = GAUNTLET_VERSION;
  worker.golden_hash = functions.golden_hash;
  worker.controllers = functions.controllers;
  SpecOptions spec;
  std::string directory;
  bool golden = false;
  std::string run_spec;

  auto* dir_option =
      app.add_option("--dir", directory, "The campaign's directory; access.json in it may come later")
          ->type_name("DIR");
  auto* access_option =
      app.add_option("--access", worker.access_path, "An access.json elsewhere")->type_name("FILE");
  auto* slots_option = app.add_option("--slots", worker.slots, "Runs simulated at the same time, 1 to 1024")
                           ->type_name("N")
                           ->capture_default_str()
                           ->check(CLI::Range(1, 1024));
  auto* orphan_option = app.add_option("--orphan-timeout", worker.orphan_timeout_seconds,
                                       "Seconds without a master before giving up")
                            ->capture_default_str()
                            ->check(Seconds());
  auto* die_option =
      app.add_option(
             "--die-with-parent", worker.parent,
             "End at once when the process PID, which started this one, ends (its thread, to be exact)")
          ->type_name("PID")
          ->check(CLI::Range(1, 1 << 22));  // Linux' largest
  auto* log_option =
      app.add_option("--log", worker.log_file, "Log to this file, errors to stderr too")->type_name("FILE");
  auto* allocation_option =
      app.add_option("--allocation", worker.allocation,
                     "Batch job that holds this worker, told to the master: JOB:RESTARTS:NODE")
          ->type_name("TEXT");
  auto* quiet_option = app.add_flag("--quiet", worker.quiet, "Log warnings and errors only");

  auto* golden_option =
      app.add_flag("--golden", golden,
                   "Print the golden hash (16 hexadecimal digits): equal where runs are computed equally");
  auto* spec_option =
      app.add_option(
             "--run-spec", run_spec,
             "Simulate one serialized RunSpec (\"-\": from stdin) and write the RunResult to stdout, binary")
          ->type_name("FILE");
  auto* cpu_option =
      app.add_option("--cpu-limit", spec.cpu_limit_seconds, "With --run-spec: CPU seconds, 0 = no limit")
          ->capture_default_str()
          ->check(Seconds());
  auto* memory_option = app.add_option("--memory-limit", spec.memory_limit_bytes,
                                       "With --run-spec: bytes of address space, 0 = no limit")
                            ->type_name("BYTES")
                            ->capture_default_str()
                            ->check(CLI::NonNegativeNumber);
  dir_option->excludes(access_option);
  cpu_option->needs(spec_option);
  memory_option->needs(spec_option);
  for (CLI::Option* serving : {dir_option, access_option, slots_option, orphan_option, log_option,
                               quiet_option, allocation_option}) {
    serving->excludes(golden_option)->excludes(spec_option);
  }
  golden_option->excludes(spec_option)->excludes(die_option);

  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : 2;
  }
  if (golden) {
    fmt::print("{:016x}\n", functions.golden_hash());
    if (std::fflush(stdout) == 0) return 0;
    fmt::print(stderr, "gauntlet-worker: the golden hash cannot be written to stdout\n");
    return 4;
  }
  if (*spec_option) {
    spec.spec_file = run_spec;
    spec.parent = worker.parent;
    return RunOneSpec(spec, functions.run);
  }
  if (!*dir_option && !*access_option) {
    fmt::print(stderr, "gauntlet-worker: --dir DIR or --access FILE is needed: where to find the master\n");
    return 2;
  }
  if ((*dir_option ? directory : worker.access_path).empty()) {
    fmt::print(stderr, "gauntlet-worker: {} is empty: a path is needed\n",
               *dir_option ? "--dir" : "--access");
    return 2;
  }
  if (*dir_option) worker.access_path = directory + "/access.json";
  return RunWorker(worker, functions.run);
}

}  // namespace gauntlet::worker
