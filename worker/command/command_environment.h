// The environment of simulators that are programs.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "base/result.h"
#include "base/system/unique_fd.h"
#include "controllers/command/definition.h"
#include "worker/plugin/plugin_files.h"

namespace gauntlet::worker {

// What is left of this process' environment ("NAME=value") by the definition's `setup`, which bash runs once;
// with none, this process' own. The exit code of the last command counts; `set -e` makes that of all of them
// count. Uses RunWatched, as it is described there. Error: it failed, or took more than a minute; with what
// it printed.
Result<std::vector<std::string>> EnvironmentAfterSetup(const controllers::command::Definition& definition);

// Where the processes of a worker keep that, for PluginSettings::setups: to be made before any of them is
// forked. Null when the kernel has no room.
std::shared_ptr<const UniqueFd> MakeSharedSetups();

// The same by the definition's hash: of the worker's processes the first runs the setup, the others wait for
// it. Error: as EnvironmentAfterSetup; the next one tries again.
Result<std::vector<std::string>> SharedEnvironment(const PluginSettings& settings, const std::string& hash,
                                                   const controllers::command::Definition& definition);

// Of a run in this folder, an absolute path: HOME and temporary files are there, and libraries that start
// threads start as many as the definition has cores.
std::vector<std::string> EnvironmentOfRun(std::vector<std::string> environment, const std::string& folder,
                                          const controllers::command::Definition& definition);

}  // namespace gauntlet::worker
