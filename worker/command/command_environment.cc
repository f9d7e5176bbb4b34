#include "worker/command/command_environment.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <sstream>
#include <string_view>

#include "base/system/atomic_file.h"
#include "worker/command/watched_process.h"
#include "worker/runner/scratch_folder.h"

namespace gauntlet::worker {
namespace {

namespace command = controllers::command;

constexpr double kSetupSeconds = 60.0;
constexpr const char* kVariablesFile = "variables";
constexpr const char* kOutputFileOfSetup = "output";
constexpr std::size_t kMostVariables = std::size_t{16} << 20;  // bytes
constexpr std::size_t kMostToldOfSetup = 2000;                 // bytes

std::vector<std::string> OwnEnvironment() {
  std::vector<std::string> own;
  for (char** entry = environ; *entry != nullptr; ++entry) own.emplace_back(*entry);
  return own;
}

std::vector<std::string> EntriesOf(const std::string& variables) {
  std::vector<std::string> environment;
  std::istringstream entries(variables);
  for (std::string entry; std::getline(entries, entry, '\0');) environment.push_back(entry);
  return environment;
}

// A record of a file of setups, which the variables follow, each with a zero byte behind it.
struct Record {
  std::array<char, 64> hash{};
  std::uint64_t bytes = 0;
};

// The variables that a definition's record has. `end`: behind the last whole record.
std::optional<std::string> FindRecord(int file, const std::string& hash, off_t& end) {
  struct stat status {};
  if (fstat(file, &status) != 0) return std::nullopt;
  Record record;
  for (end = 0; pread(file, &record, sizeof record, end) == ssize_t{sizeof record};) {
    const off_t next = end + static_cast<off_t>(sizeof record + record.bytes);
    if (next > status.st_size) return std::nullopt;  // its writer was ended
    if (std::string_view(record.hash.data(), record.hash.size()) == hash) {
      std::string variables(record.bytes, '\0');
      if (pread(file, variables.data(), variables.size(), end + ssize_t{sizeof record}) ==
          static_cast<ssize_t>(record.bytes))
        return variables;
    }
    end = next;
  }
  return std::nullopt;
}

void AppendRecord(int file, const std::string& hash, const std::vector<std::string>& environment, off_t end) {
  std::string variables;
  for (const std::string& variable : environment) variables += variable + '\0';
  Record record;
  std::ranges::copy(hash.substr(0, record.hash.size()), record.hash.begin());
  record.bytes = variables.size();
  const std::string bytes = std::string(reinterpret_cast<const char*>(&record), sizeof record) + variables;
  // What is not whole is not read.
  if (ftruncate(file, end) == 0 && pwrite(file, bytes.data(), bytes.size(), end) < 0) return;
}

// As long as it lives, no other process has it; whoever is killed lets it go.
class SetupLock {
 public:
  explicit SetupLock(int file) : file_(file) { Ask(F_WRLCK); }
  SetupLock(const SetupLock&) = delete;
  SetupLock& operator=(const SetupLock&) = delete;
  ~SetupLock() { Ask(F_UNLCK); }

 private:
  void Ask(short type) const {
    struct flock lock {};
    lock.l_type = type;
    while (fcntl(file_, F_SETLKW, &lock) != 0 && errno == EINTR) continue;
  }
  int file_;
};

}  // namespace

std::shared_ptr<const UniqueFd> MakeSharedSetups() {
  auto file = std::make_shared<UniqueFd>(memfd_create("gauntlet-setups", MFD_CLOEXEC));
  return file->valid() ? file : nullptr;
}

Result<std::vector<std::string>> SharedEnvironment(const PluginSettings& settings, const std::string& hash,
                                                   const command::Definition& definition) {
  if (!settings.setups || definition.setup.empty()) return EnvironmentAfterSetup(definition);
  const int file = settings.setups->get();
  const SetupLock lock(file);
  off_t end = 0;
  if (const std::optional<std::string> variables = FindRecord(file, hash, end)) return EntriesOf(*variables);
  TRY(std::vector<std::string> environment, EnvironmentAfterSetup(definition));
  AppendRecord(file, hash, environment, end);
  return environment;
}

Result<std::vector<std::string>> EnvironmentAfterSetup(const command::Definition& definition) {
  if (definition.setup.empty()) return OwnEnvironment();
  TRY(const ScratchFolder scratch, ScratchFolder::Make(""));
  const std::string folder = std::filesystem::absolute(scratch.path());
  // It prints where its errors go, and the variables go to its stdout.
  const std::string script =
      fmt::format("exec 3>&1 1>&2\n{}\n(exit $?) && exec /usr/bin/env -0 >&3 3>&-\n", definition.setup);
  const WatchedOptions options{.arguments = {"bash", "-c", script},
                               .environment = OwnEnvironment(),
                               .folder = folder,
                               .stdout_file = kVariablesFile,
                               .stderr_file = kOutputFileOfSetup,
                               .wall_limit = kSetupSeconds,
                               .confine = definition.confine};
  Result<WatchedOutcome> outcome = RunWatched(options);
  if (!outcome) return Error{outcome.error().kind, "setup: " + outcome.error().message};
  if (outcome->wait_status != 0) {
    return InvalidInput(fmt::format("the command's setup {}\n{}", HowItEnded(options, *outcome),
                                    TailOf(folder + "/" + kOutputFileOfSetup, kMostToldOfSetup)));
  }
  TRY(const std::string variables, ReadSmallFile(folder + "/" + kVariablesFile, kMostVariables));
  return EntriesOf(variables);
}

std::vector<std::string> EnvironmentOfRun(std::vector<std::string> environment, const std::string& folder,
                                          const command::Definition& definition) {
  const std::string cores = std::to_string(definition.cores);
  const std::map<std::string, std::string, std::less<>> own = {{"HOME", folder},
                                                               {"TMPDIR", folder},
                                                               {"PWD", folder},
                                                               {"OMP_NUM_THREADS", cores},
                                                               {"OPENBLAS_NUM_THREADS", cores},
                                                               {"MKL_NUM_THREADS", cores},
                                                               {"NUMEXPR_NUM_THREADS", cores}};
  std::erase_if(environment, [&](const std::string& entry) {
    return own.contains(std::string_view(entry).substr(0, entry.find('=')));
  });
  for (const auto& [name, value] : own) environment.push_back(name + "=" + value);
  return environment;
}

}  // namespace gauntlet::worker
