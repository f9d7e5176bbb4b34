// The libraries of plug-ins as a runner has them: each is read once and known by its SHA-256.
#pragma once

#include <functional>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include "base/result.h"
#include "base/system/unique_fd.h"
#include "sim/run_spec.h"

namespace gauntlet::worker {

// A library that was read.
struct PluginFile {
  std::string path;     // by which dlopen finds it
  std::string name;     // what messages call it
  std::string hash;     // 64 hexadecimal digits
  int descriptor = -1;  // what the path needs
};

// Those that the paths of `files` need.
std::set<int> DescriptorsOf(const std::vector<PluginFile>& files);

// Makes what a library brings known to the run function. Called in a process that is there for one
// run.
using LoadPluginFunction = std::function<Status(const PluginFile& file)>;

// Where a runner finds plug-ins, and what it does with them.
struct PluginSettings {
  std::string folder = "";              // holds HASH.so
  std::vector<std::string> files = {};  // these libraries instead, if one has the hash
  std::string scratch = "";  // working directory of a run, which stays; "": one that is removed after the run
  LoadPluginFunction load = nullptr;
  // A file in memory in which the processes of a worker keep what the setup of a command left
  // (worker/command/command_environment.h); null: each process asks for itself.
  std::shared_ptr<const UniqueFd> setups = nullptr;
};

// Not for sharing between threads.
class PluginFiles {
 public:
  explicit PluginFiles(PluginSettings settings) : settings_(std::move(settings)) {}

  const PluginSettings& settings() const { return settings_; }
  // What is loaded is what was hashed, whatever happens to the file later: it is copied into memory. Error:
  // there is no such file, it cannot be read, or its hash is another one.
  Result<PluginFile> Open(const std::string& hash);
  // Those that bring the spec's controller and its scenario; none of what is built in. Error: as Open.
  Result<std::vector<PluginFile>> Of(const sim::RunSpec& spec);

 private:
  struct Copy {
    std::string name;
    UniqueFd memory;
  };

  PluginSettings settings_;
  std::map<std::string, Copy> copies_;  // by hash
};

}  // namespace gauntlet::worker
