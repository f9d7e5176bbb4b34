#include "worker/command/command_runs.h"

#include <fmt/format.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <cstdio>
#include <filesystem>
#include <optional>
#include <string_view>
#include <system_error>
#include <utility>

#include "base/printable.h"
#include "base/system/atomic_file.h"
#include "base/utf8.h"
#include "controllers/command/outcome.h"
#include "controllers/command/placeholders.h"
#include "proto/case_json.h"
#include "worker/command/command_environment.h"
#include "worker/runner/scratch_folder.h"
#include "worker/runner/separate_process.h"

namespace gauntlet::worker {
namespace {

namespace fs = std::filesystem;
namespace command = controllers::command;

constexpr std::size_t kMostRefusedCharacters = 200;
// Of what it printed, on each of stdout and stderr: with the line that says how it ended, a failure holds it.
constexpr std::size_t kToldOfStream = proto::kMaxStderrTail / 2 - 150;

std::uint64_t Megabytes(int number) {
  return static_cast<std::uint64_t>(number) << 20;
}

Status WriteCase(const std::string& folder, const sim::RunSpec& spec, const command::Definition& definition) {
  std::string text;
  if (definition.case_template.empty()) {
    text = proto::WriteCaseJson(spec.test_case);
  } else {
    TRY(const std::string form,
        ReadSmallFile(folder + "/" + definition.case_template, command::kMostFileBytes));
    text = command::FillTemplate(definition, form, spec);
  }
  return ReplaceFile(folder + "/" + command::CaseFileOf(definition), text, kReadableByAll);
}

// What a program says without the name of its folder, which differs from run to run.
std::string Message(std::string line, const std::string& folder) {
  for (const std::string& name : {folder + "/", folder}) {
    for (std::size_t at = line.find(name); at != std::string::npos; at = line.find(name, at))
      line.erase(at, name.size());
  }
  const std::string printable = Printable(line);
  std::size_t end = 0;
  for (std::size_t characters = 0; end < printable.size() && characters < kMostRefusedCharacters;
       ++characters)
    end += Utf8Length(printable, end);
  return "the program refuses this case: " + printable.substr(0, end);
}

sim::RunResult Refused(std::string message) {
  sim::RunResult refused;
  refused.verdict = sim::Verdict::kRefused;
  refused.message = std::move(message);
  sim::SetHashes(refused);
  return refused;
}

// Whether a runner says something of its own by this code.
bool IsOurs(int exit_code) {
  return exit_code >= kExitUnheard && exit_code <= kExitOverProcesses;
}

std::string WholeLines(std::string text) {
  if (!text.empty() && !text.ends_with('\n')) text += '\n';
  return text;
}

}  // namespace

// How a program's run ended.
struct CommandRuns::Ended {
  std::optional<sim::RunResult> result;
  double cpu_seconds = 0.0;
  // Without a result: what stderr is told, and how this process ends.
  std::string told;
  int signal = 0;  // 0: by the exit code
  int exit_code = 0;
};

Result<WatchedOptions> CommandRuns::OptionsOf(const std::string& folder, const sim::RunSpec& spec,
                                              const command::Definition& definition) {
  auto environment = environments_.find(spec.scenario_plugin);
  if (environment == environments_.end()) {
    TRY(std::vector<std::string> after_setup, SharedEnvironment(settings_, spec.scenario_plugin, definition));
    environment = environments_.emplace(spec.scenario_plugin, std::move(after_setup)).first;
  }
  const auto wall = spec.scenario_parameters.find(command::kWallLimit);
  std::vector<std::string> variables = EnvironmentOfRun(environment->second, folder, definition);
  if (spec.record_trajectory) variables.emplace_back(command::kReplayVariable);
  const double wall_limit = wall == spec.scenario_parameters.end() ? definition.wall_limit : wall->second;
  return WatchedOptions{
      .arguments = command::ArgumentsOf(definition, spec),
      .environment = std::move(variables),
      .folder = folder,
      .stdout_file = command::kStdoutFile,
      .stderr_file = command::kStderrFile,
      .wall_limit = wall_limit,
      .cpu_limit = definition.cpu_limit > 0.0 ? definition.cpu_limit : wall_limit * definition.cores,
      .memory_bytes = Megabytes(definition.memory),
      .disk_bytes = Megabytes(definition.disk),
      .confine = definition.confine,
      .group = &group_};
}

Result<CommandRuns::Ended> CommandRuns::RunIn(const std::string& folder, const sim::RunSpec& spec) {
  for (std::size_t i = 0; i < spec.test_case.obstacles.size(); ++i) {
    const sim::ObstacleGene& gene = spec.test_case.obstacles[i];
    if (gene.Plain()) continue;
    Ended refused;
    refused.result =
        Refused(fmt::format("limits: obstacle {} {}, of which a program of yours is told nothing", i + 1,
                            gene.Lit() ? "carries lights" : "moves"));
    return refused;
  }
  TRY(const command::Definition* const definition, files_.Open(spec.scenario_plugin));
  TRY(const WatchedOptions options, OptionsOf(folder, spec, *definition));
  TRY(files_.LayInto(folder, spec.scenario_plugin));
  TRY(WriteCase(folder, spec, *definition));
  TRY(const WatchedOutcome outcome, RunWatched(options));
  Ended ended;
  ended.cpu_seconds = outcome.cpu_seconds;
  if (std::optional<std::string> line = command::RefusedBy(*definition, folder)) {
    ended.result = Refused(Message(*std::move(line), folder));
    return ended;
  }
  std::string how = HowItEnded(options, outcome);
  if (outcome.exceeded == ExceededLimit::kWall || outcome.exceeded == ExceededLimit::kCpu) {
    ended.signal = SIGXCPU;
  } else if (outcome.exceeded == ExceededLimit::kMemory) {
    ended.exit_code = kExitOutOfMemory;
  } else if (outcome.exceeded == ExceededLimit::kDisk) {
    ended.exit_code = kExitOverDisk;
  } else if (outcome.exceeded == ExceededLimit::kProcesses) {
    ended.exit_code = kExitOverProcesses;
  } else if (WIFSIGNALED(outcome.wait_status)) {
    ended.signal = WTERMSIG(outcome.wait_status);
  } else if (outcome.wait_status != 0) {
    const int code = WEXITSTATUS(outcome.wait_status);
    ended.exit_code = IsOurs(code) ? kExitOfProgram : code;
  } else {
    Result<sim::RunResult> result = command::OutcomeOf(*definition, spec, folder);
    if (result) {
      ended.result = *std::move(result);
      return ended;
    }
    ended.exit_code = kExitWithoutMetrics;
    how = "ended with exit code 0, but " + result.error().message;
  }
  for (const char* file : {command::kStdoutFile, command::kStderrFile})
    ended.told += WholeLines(TailOf(folder + "/" + file, kToldOfStream));
  ended.told += ended.exit_code == kExitOfProgram ? ExitCodeLine(WEXITSTATUS(outcome.wait_status))
                                                  : fmt::format("the program {}\n", how);
  return ended;
}

Result<CommandRuns::Ended> CommandRuns::Run(const sim::RunSpec& spec) {
  TRY(const ScratchFolder scratch, ScratchFolder::Make(settings_.scratch));
  std::error_code failed;
  if (!fs::is_empty(scratch.path(), failed)) {
    return InvalidInput(fmt::format(
        "{} is not empty: what it holds could be taken for what the program writes. Give a new folder",
        settings_.scratch));
  }
  return RunIn(fs::absolute(scratch.path()), spec);
}

std::string CommandRuns::Execute(const RunnerJob& job, const sim::RunSpec& spec) {
  Result<Ended> run = Run(spec);
  Ended ended;
  if (run) {
    ended = *std::move(run);
  } else {
    ended.told = WholeLines(run.error().message);
    ended.exit_code = kExitWithoutPlugin;
  }
  if (!ended.result) {
    fmt::print(stderr, "{}", ended.told);
    std::fflush(stderr);
    if (ended.signal != 0) EndBySignal(ended.signal, "the program");
    _exit(ended.exit_code);
  }
  ended.result->cpu_seconds = ended.cpu_seconds;
  return EncodeReport({.result = EncodeResult(job, spec.record_trajectory, *ended.result),
                       .cpu_seconds = ended.cpu_seconds,
                       .process_cpu_seconds = SecondsWithChildren()});
}

}  // namespace gauntlet::worker
