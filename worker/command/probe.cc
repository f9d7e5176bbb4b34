#include "worker/command/probe.h"

#include <fmt/format.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <filesystem>
#include <optional>
#include <string_view>
#include <utility>

#include "base/hash.h"
#include "base/system/atomic_file.h"
#include "controllers/command/outcome.h"
#include "worker/command/command_environment.h"
#include "worker/command/watched_process.h"
#include "worker/runner/confinement.h"
#include "worker/runner/fork_server.h"
#include "worker/runner/pipe.h"
#include "worker/runner/scratch_folder.h"

namespace gauntlet::worker {
namespace {

namespace command = controllers::command;

constexpr double kProbeSeconds = 60.0;
constexpr std::size_t kMostPrinted = std::size_t{16} << 20;  // bytes
constexpr std::size_t kMostToldOfProbe = 2000;               // bytes
// What an answer of the separate process begins with.
constexpr char kProbed = '+';
constexpr char kNotProbed = '-';

std::string ProbeAll(const std::vector<std::string>& hashes, const PluginSettings& settings) {
  CommandFiles files(settings);
  proto::GoldenHashes golden;
  for (const std::string& hash : hashes) {
    const Result<std::uint64_t> probed = ProbeOf(files, hash);
    if (!probed) return kNotProbed + probed.error().message;
    golden[command::kGoldenPrefix + hash] = *probed;
  }
  return kProbed + proto::WriteGoldenHashes(golden);
}

// In a process of its own: nobody else's children end with what a probe has left.
Result<proto::GoldenHashes> AskSeparately(const std::vector<std::string>& hashes,
                                          const PluginSettings& settings) {
  TRY(SocketPair pipe, MakeSocketPair(SOCK_STREAM));
  const pid_t parent = getpid();
  const pid_t child = fork();
  if (child < 0) return SystemError("cannot start a process", errno);
  if (child == 0) {
    CloseAllBut({pipe.second.get(), settings.setups ? settings.setups->get() : -1});
    if (DieWithParent(parent)) WriteFrame(pipe.second.get(), ProbeAll(hashes, settings));
    _exit(0);
  }
  pipe.second.Reset();
  FrameBuffer answers;
  while (answers.ReadFrom(pipe.first.get(), FrameBuffer::Wait::kYes) == FrameBuffer::State::kOpen) continue;
  while (waitpid(child, nullptr, 0) < 0 && errno == EINTR) continue;
  const std::optional<std::string> answer = answers.Next();
  if (!answer) return Error{ErrorKind::kInternal, "the process that asks commands has ended"};
  if (answer->front() == kNotProbed) return InvalidInput(answer->substr(1));
  return proto::ReadGoldenHashes(answer->substr(1));
}

}  // namespace

Result<std::uint64_t> ProbeOf(CommandFiles& files, const std::string& hash) {
  TRY(const command::Definition* const definition, files.Open(hash));
  TRY(std::vector<std::string> environment, SharedEnvironment(files.settings(), hash, *definition));
  TRY(const ScratchFolder scratch, ScratchFolder::Make(""));
  const std::string folder = std::filesystem::absolute(scratch.path());
  TRY(files.LayInto(folder, hash));
  if (definition->probe.empty()) {
    TRY(FindProgram(definition->run.at(0), environment, folder));
    return Fnv1a64().value();
  }
  const WatchedOptions options{.arguments = definition->probe,
                               .environment = EnvironmentOfRun(std::move(environment), folder, *definition),
                               .folder = folder,
                               .stdout_file = command::kStdoutFile,
                               .stderr_file = command::kStderrFile,
                               .wall_limit = kProbeSeconds,
                               .memory_bytes = static_cast<std::uint64_t>(definition->memory) << 20,
                               .disk_bytes = static_cast<std::uint64_t>(definition->disk) << 20,
                               .confine = definition->confine};
  TRY(const WatchedOutcome outcome, RunWatched(options));
  if (outcome.wait_status != 0) {
    std::string said;
    for (const char* file : {command::kStdoutFile, command::kStderrFile})
      said += TailOf(folder + "/" + file, kMostToldOfProbe);
    return InvalidInput(fmt::format("the command's probe {}\n{}", HowItEnded(options, outcome), said));
  }
  TRY(const std::string printed, ReadSmallFile(folder + "/" + command::kStdoutFile, kMostPrinted));
  Fnv1a64 probed;
  probed.AddBytes(printed);
  return probed.value();
}

Result<proto::GoldenHashes> GoldenHashesOf(const std::vector<std::string>& names,
                                           const GoldenHashFunction& built_in,
                                           const PluginSettings& settings) {
  std::vector<std::string> others;
  std::vector<std::string> hashes;
  for (const std::string& name : names) {
    if (name.starts_with(command::kGoldenPrefix)) {
      hashes.push_back(name.substr(std::string_view(command::kGoldenPrefix).size()));
    } else {
      others.push_back(name);
    }
  }
  proto::GoldenHashes golden;
  if (hashes.empty() || !others.empty()) golden = built_in(others);
  if (hashes.empty()) return golden;
  TRY(proto::GoldenHashes of_commands, AskSeparately(hashes, settings));
  golden.merge(of_commands);
  return golden;
}

}  // namespace gauntlet::worker
