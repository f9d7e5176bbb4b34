#include "worker/command/command_environment.h"

#include <fmt/format.h>
#include <unistd.h>

#include <cstddef>
#include <filesystem>
#include <map>
#include <sstream>

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

}  // namespace

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
  std::vector<std::string> environment;
  std::istringstream entries(variables);
  for (std::string entry; std::getline(entries, entry, '\0');) environment.push_back(entry);
  return environment;
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
