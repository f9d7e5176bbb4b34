#include "worker/command_line.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "base/system/resource_limits.h"
#include "worker/command/probe.h"
#include "worker/worker_process.h"
#include "worker/worker_state.h"

namespace gauntlet::worker {
namespace {

constexpr const char* kDescription = R"(Simulates runs for a Gauntlet master.

A worker finds its master through the campaign's file access.json. It takes runs from the master, simulates each
of them in a child process under limits, and sends the results. When the master is gone, the worker keeps its
results and waits for a new master, which it finds through the same file. SIGTERM or Ctrl-C makes it finish its
current runs and leave; a second signal drops them.
)";

constexpr const char* kFooter = R"(
Exit codes: 0 done, or dismissed by the master; 2 wrong command line, or refused by the master; 3 no master within
the orphan timeout, or the machine has too little memory or too few processes or files; 4 internal error.

Examples:
  gauntlet-worker --dir campaigns/flocking-1            work for the campaign in that directory
  gauntlet-worker --access /shared/access.json --slots 8
  gauntlet-worker --run-spec spec.bin > result.bin      simulate one stored spec
  gauntlet-worker --describe-plugin libmine.so          print what a plug-in brings, as JSON
)";

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

struct CommandLine {
  WorkerOptions worker;
  SpecOptions spec;
  std::string directory;
  std::vector<std::string> golden;  // controllers
  std::string described_plugin;
  std::string begun_spec;
};

// Options of a worker that serves a master.
std::vector<CLI::Option*> AddServing(CLI::App& app, CommandLine& line) {
  WorkerOptions& worker = line.worker;
  auto* dir = app.add_option("--dir", line.directory,
                             "Directory of the campaign; its access.json may be written later")
                  ->type_name("DIR");
  auto* access = app.add_option("--access", worker.access_path, "Path of an access.json in another place")
                     ->type_name("FILE")
                     ->excludes(dir);
  auto* slots =
      app.add_option("--slots", worker.slots, "Number of runs that are simulated at the same time, 1 to 1024")
          ->type_name("N")
          ->capture_default_str()
          ->check(CLI::Range(1, 1024));
  auto* orphan = app.add_option("--orphan-timeout", worker.orphan_timeout_seconds,
                                "Leave after so many seconds without a master")
                     ->capture_default_str()
                     ->check(Seconds());
  auto* log =
      app.add_option("--log", worker.log_file, "Write the log to this file, and errors to standard error too")
          ->type_name("FILE");
  auto* allocation = app.add_option("--allocation", worker.allocation,
                                    "Batch job of this worker, which the master is told: JOB:RESTARTS:NODE")
                         ->type_name("TEXT");
  return {dir, access, slots, orphan, log, allocation};
}

// Options of one run without a master.
void AddRunSpec(CLI::App& app, SpecOptions& line) {
  auto* spec =
      app.add_option(
             "--run-spec", line.spec_file,
             "Simulate one serialized RunSpec (\"-\": from standard input) and write the binary RunResult to "
             "standard output")
          ->type_name("FILE");
  app.add_option("--cpu-limit", line.cpu_limit_seconds,
                 "With --run-spec: limit of CPU time in seconds, 0 = no limit")
      ->capture_default_str()
      ->check(Seconds())
      ->needs(spec);
  app.add_option("--memory-limit", line.memory_limit_bytes,
                 "With --run-spec: limit of address space in bytes, 0 = no limit")
      ->type_name("BYTES")
      ->capture_default_str()
      ->check(CLI::NonNegativeNumber)
      ->needs(spec);
  app.add_option("--plugin", line.plugins.files,
                 "With --run-spec and --describe-beginning: a plug-in that the spec names; repeatable. The "
                 "definition of a command is HASH.command, beside the folder `files`; also with --golden")
      ->type_name("FILE")
      ->allow_extra_args(false);
  const auto keep = [&line](const std::string& folder) {  // a run is made in a folder of its own
    line.plugins.scratch = folder.empty() ? "" : std::filesystem::absolute(folder).string();
  };
  app.add_option_function<std::string>(
         "--scratch", keep,
         "With --run-spec: working directory for the run of a plug-in or command; keeps what it writes")
      ->type_name("DIR")
      ->needs(spec);
}

void AddOptions(CLI::App& app, CommandLine& line) {
  const std::vector<CLI::Option*> serving = AddServing(app, line);
  auto* quiet = app.add_flag("--quiet", line.worker.quiet, "Log only warnings and errors");
  auto* die = app.add_option("--die-with-parent", line.worker.parent,
                             "End as soon as the thread of process PID that started this process ends")
                  ->type_name("PID")
                  ->check(CLI::Range(1, 1 << 22));  // Linux' largest
  auto* golden =
      app.add_option("--golden", line.golden,
                     "Print a line with the golden hash of each of these controllers (default: all). It is "
                     "equal for builds that compute the controller's runs equally; controllers that are not "
                     "built in are left out. command:HASH, with --plugin: that of a command's probe")
          ->type_name("[CONTROLLER...]")
          ->expected(0, -1)
          ->excludes(die);
  AddRunSpec(app, line.spec);
  auto* spec = app.get_option("--run-spec")->excludes(golden);
  auto* describe = app.add_option("--describe-plugin", line.described_plugin,
                                  "Load this plug-in in a separate process and print what it brings, as JSON")
                       ->type_name("FILE")
                       ->excludes(golden)
                       ->excludes(spec);
  auto* beginning =
      app.add_option("--describe-beginning", line.begun_spec,
                     "Load the plug-ins of one serialized RunSpec (\"-\": from standard input) in a separate "
                     "process, and print how its run begins and what it requires of the arena, as JSON")
          ->type_name("FILE")
          ->excludes(golden)
          ->excludes(spec)
          ->excludes(describe);
  quiet->excludes(golden);
  for (CLI::Option* option : serving)
    option->excludes(golden)->excludes(spec)->excludes(describe)->excludes(beginning);
}

int PrintGoldenHashes(const Result<proto::GoldenHashes>& hashes) {
  if (!hashes) {
    fmt::print(stderr, "gauntlet-worker: {}\n", hashes.error().message);
    return kExitRefused;
  }
  fmt::print("{}", proto::WriteGoldenHashes(*hashes));
  if (std::fflush(stdout) == 0) return 0;
  fmt::print(stderr, "gauntlet-worker: the golden hashes cannot be written to stdout\n");
  return 4;
}

int Obey(int argc, char** argv, const WorkerFunctions& functions) {
  CLI::App app(kDescription, "gauntlet-worker");
  app.footer(kFooter);
  app.set_version_flag("--version", functions.version);
  CommandLine line;
  AddOptions(app, line);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : 2;
  }
  std::erase(line.golden, "");  // what CLI11 puts there when no name follows
  if (app.count("--golden") > 0)
    return PrintGoldenHashes(GoldenHashesOf(line.golden, functions.golden_hashes, line.spec.plugins));
  if (app.count("--describe-plugin") > 0)
    return PrintDescription(line.described_plugin, functions.describe_plugin);
  line.spec.plugins.load = functions.load_plugin;
  if (app.count("--describe-beginning") > 0) {
    const Result<std::string> spec = ReadSpec(line.begun_spec);
    if (spec) return PrintBeginning(*spec, line.spec.plugins, functions.describe_beginning);
    fmt::print(stderr, "gauntlet-worker: {}\n", spec.error().message);
    return kExitRefused;
  }
  line.worker.plugins.load = functions.load_plugin;
  if (app.count("--plugin") > 0 && app.count("--run-spec") == 0) {
    fmt::print(stderr, "gauntlet-worker: --plugin is for --run-spec, --describe-beginning and --golden\n");
    return kExitRefused;
  }
  if (app.count("--run-spec") > 0) {
    line.spec.parent = line.worker.parent;
    line.spec.quiet = line.worker.quiet;
    return RunOneSpec(line.spec, functions.run);
  }
  const bool by_directory = app.count("--dir") > 0;
  if (!by_directory && app.count("--access") == 0) {
    fmt::print(stderr, "gauntlet-worker: --dir DIR or --access FILE is needed: where to find the master\n");
    return 2;
  }
  if ((by_directory ? line.directory : line.worker.access_path).empty()) {
    fmt::print(stderr, "gauntlet-worker: {} is empty: a path is needed\n",
               by_directory ? "--dir" : "--access");
    return 2;
  }
  if (by_directory) line.worker.access_path = line.directory + "/access.json";
  line.worker.plugins.folder = std::filesystem::path(line.worker.access_path).parent_path() / "plugins";
  line.worker.software_version = GAUNTLET_VERSION;
  line.worker.golden_hashes = functions.golden_hashes;
  return RunWorker(line.worker, functions.run);
}

}  // namespace

int RunWorkerCommandLine(int argc, char** argv, const WorkerFunctions& functions) {
  OccupyStandardStreams();
  if (const Status prepared = PrepareProgram(); !prepared) {
    fmt::print(stderr, "gauntlet-worker: {}\n", prepared.error().message);
    return kExitRefused;
  }
  try {
    return Obey(argc, argv, functions);
  } catch (const std::exception& exception) {
    const std::optional<Error> resources = ErrorOfResources(exception);
    fmt::print(stderr, "gauntlet-worker: {}\n",
               resources ? resources->message : fmt::format("internal error: {}", exception.what()));
    return resources ? kExitWithoutResources : kExitInternal;
  }
}

}  // namespace gauntlet::worker
