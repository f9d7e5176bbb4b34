#include "master/dispatch/pool/worker_program.h"

#include <fmt/format.h>

#include <array>
#include <csignal>
#include <filesystem>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "base/check.h"
#include "base/printable.h"
#include "base/shell_quoted.h"
#include "base/system/atomic_file.h"
#include "base/system/process_call.h"
#include "base/system/regular_file.h"
#include "base/system/sha256.h"
#include "base/system/trusted_path.h"
#include "controllers/command/definition.h"
#include "controllers/registry.h"
#include "controllers/rows/plugin_rows.h"
#include "master/dispatch/leases/run_limits.h"
#include "master/dispatch/pool/local_pool.h"
#include "proto/run_codec.h"

namespace gauntlet {
namespace {

// A kill comes from outside (a memory killer, an operator): the pure question may be asked again this often.
constexpr int kTries = 3;
// As gauntlet-worker ends when what it was given cannot be simulated on this machine, after saying why.
constexpr int kExitUnusable = 2;

// stdout of gauntlet-worker with these arguments; its stderr is ours.
Result<std::string> RunWorkerProgram(std::vector<std::string> arguments, std::string_view input) {
  // With every pose of every tick, a result may be large.
  const CallOptions options{.part_of_us = true, .most_output = std::size_t{1} << 30};
  const std::string program = WorkerProgramPath();
  arguments.insert(arguments.begin(), program);
  for (int attempt = 1;; ++attempt) {
    TRY(CallOutput output, CallProcess(arguments, input, options));
    if (output.exit_code == 0) return std::move(output.out);
    if (output.signal == SIGKILL && attempt < kTries) continue;
    if (output.exit_code == kExitUnusable) return InvalidInput("the run cannot be simulated here: see above");
    return Error{ErrorKind::kInternal,
                 fmt::format("{} ended {} {}", program, output.signal != 0 ? "by signal" : "with status",
                             output.signal != 0 ? output.signal : output.exit_code)};
  }
}

// The bytes of the file, if they are that plug-in.
Result<std::string> OfHash(const std::string& hash, const std::string& file, Result<std::string> bytes) {
  if (!bytes) return bytes;
  const std::string holds = Sha256(*bytes);
  if (holds == hash) return bytes;
  return InvalidInput(fmt::format(
      "{} is another plug-in now: its SHA-256 is {}, the searches were begun with {}", file, holds, hash));
}

// Said once, before a program is started that a directory has brought along: it is the user who begins it.
void AnnounceCommand(const std::string& hash, const std::string& text) {
  static std::set<std::string> announced;
  const auto definition = controllers::command::Parse(text);
  if (!definition || !announced.insert(hash).second) return;
  std::string line;
  for (const std::string& argument : definition->run) line += " " + ShellQuoted(argument);
  fmt::print(stderr, "gauntlet: its runs start{}\n", Printable(line));
}

// Names the libraries that the run needs.
Status AddPlugins(const sim::RunSpec& spec, std::vector<std::string>& arguments) {
  for (const std::string& hash : std::set{spec.plugin, spec.scenario_plugin}) {
    const auto* plugin = controllers::FindPlugin(hash);
    if (plugin == nullptr) continue;
    TRY(ReadPlugin(hash));
    arguments.insert(arguments.end(), {"--plugin", plugin->file});
  }
  return Ok{};
}

// What gauntlet-worker prints with these arguments, which ask something of the library.
Result<std::string> AskPlugin(std::vector<std::string> arguments, std::string_view input,
                              const std::string& library) {
  // The worker has limits of its own, a minute for a command's setup and its probe each; this one is for a
  // worker that is stuck.
  const CallOptions options{.deadline = std::chrono::seconds(150)};
  arguments.insert(arguments.begin(), WorkerProgramPath());
  TRY(const CallOutput output, CallProcess(arguments, input, options));
  if (output.exit_code == 0) return output.out;
  std::string_view why = output.err;
  constexpr std::string_view kWho = "gauntlet-worker: ";
  if (why.starts_with(kWho)) why.remove_prefix(kWho.size());
  while (why.ends_with('\n')) why.remove_suffix(1);
  return InvalidInput(why.empty() ? fmt::format("the plug-in {} gives no answer", library)
                                  : std::string(why));
}

}  // namespace

Result<sim::RunResult> SimulateInRunner(const sim::RunSpec& spec, const std::string& scratch) {
  const std::string cpu_limit = fmt::format("{}", CpuLimitSeconds(spec));
  std::vector<std::string> arguments = {"--run-spec", "-", "--cpu-limit", cpu_limit, "--quiet"};
  TRY(AddPlugins(spec, arguments));
  if (!scratch.empty()) arguments.insert(arguments.end(), {"--scratch", scratch});
  TRY(std::string output, RunWorkerProgram(std::move(arguments), proto::EncodeRunSpec(spec)));
  return proto::DecodeRunResult(output);
}

Status CheckCopyIsOurs(const std::string& file) {
  const std::filesystem::path path = std::filesystem::absolute(file);
  const std::string name = path.filename();
  const std::string folder = path.parent_path().filename();
  Status ours = CheckOnlyWeWrite(path.parent_path().parent_path(), std::array<std::string_view, 1>{folder});
  if (ours) ours = CheckOnlyWeWrite(path.parent_path(), std::array<std::string_view, 1>{name});
  if (ours) return ours;
  return Error{ours.error().kind, fmt::format("the plug-in {} would be run: {}", file, ours.error().message)};
}

Result<std::string> ReadPlugin(const std::string& hash) {
  const controllers::PluginInfo* plugin = controllers::FindPlugin(hash);
  GAUNTLET_CHECK(plugin != nullptr, hash);
  if (plugin->brought_along) return ReadCopy(plugin->file, hash);
  return OfHash(hash, plugin->file, ReadSmallFile(plugin->file, controllers::kMaxPluginBytes));
}

Result<std::string> ReadCopy(const std::string& file, const std::string& hash) {
  TRY(CheckCopyIsOurs(file));
  TRY(std::string bytes, OfHash(hash, file, ReadRegularFile(file, controllers::kMaxPluginBytes)));
  AnnounceCommand(hash, bytes);
  return bytes;
}

Result<std::string> DescribePlugin(const std::string& file) {
  return AskPlugin({"--describe-plugin", file}, {}, file);
}

Result<std::string> DescribeBeginning(const sim::RunSpec& spec) {
  std::vector<std::string> arguments = {"--describe-beginning", "-"};
  TRY(AddPlugins(spec, arguments));
  return AskPlugin(std::move(arguments), proto::EncodeRunSpec(spec),
                   controllers::FindPlugin(spec.scenario_plugin)->file);
}

Result<proto::GoldenHashes> GoldenHashesOfThisMachine(const std::vector<std::string>& names) {
  std::vector<std::string> arguments = {"--golden"};
  arguments.insert(arguments.end(), names.begin(), names.end());
  std::string command;
  for (const std::string& name : names) {
    constexpr std::string_view kPrefix = controllers::command::kGoldenPrefix;
    if (!name.starts_with(kPrefix)) continue;
    const std::string hash = name.substr(kPrefix.size());
    TRY(ReadPlugin(hash));
    command = controllers::FindPlugin(hash)->file;
    arguments.insert(arguments.end(), {"--plugin", command});
  }
  TRY(const std::string output, command.empty() ? RunWorkerProgram(std::move(arguments), {})
                                                : AskPlugin(std::move(arguments), {}, command));
  if (output.empty()) return proto::GoldenHashes();
  Result<proto::GoldenHashes> hashes = proto::ReadGoldenHashes(output);
  if (hashes) return hashes;
  return Error{ErrorKind::kInternal, "gauntlet-worker --golden: " + hashes.error().message};
}

}  // namespace gauntlet
