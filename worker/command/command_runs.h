// Runs whose scenario is a program of the user's (controllers/command).
#pragma once

#include <map>
#include <string>
#include <vector>

#include "base/result.h"
#include "sim/run_spec.h"
#include "worker/command/command_files.h"
#include "worker/command/watched_process.h"
#include "worker/runner/runner.h"

namespace gauntlet::worker {

// A runner's. Each run has a folder of its own, with the definition's files and the case; the program is
// watched (watched_process.h), and what it leaves there is read.
class CommandRuns {
 public:
  explicit CommandRuns(const PluginSettings& settings) : settings_(settings), files_(settings) {}

  // The encoded RunnerReport. Without a result this process ends in a way of which ClassifyExit makes what
  // befell the program, after saying on stderr how that ended and what it printed last.
  std::string Execute(const RunnerJob& job, const sim::RunSpec& spec);

 private:
  struct Ended;

  // Error: the program cannot be started here.
  Result<Ended> RunIn(const std::string& folder, const sim::RunSpec& spec);
  Result<Ended> Run(const sim::RunSpec& spec);
  Result<WatchedOptions> OptionsOf(const std::string& folder, const sim::RunSpec& spec,
                                   const controllers::command::Definition& definition);

  PluginSettings settings_;
  CommandFiles files_;
  ControlGroup group_;
  std::map<std::string, std::vector<std::string>> environments_;  // after setup, by the definition's hash
};

}  // namespace gauntlet::worker
