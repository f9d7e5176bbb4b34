// Definitions of simulators that are programs, and their files, as a runner has them.
#pragma once

#include <cstdint>
#include <map>
#include <string>

#include "base/result.h"
#include "controllers/command/definition.h"
#include "worker/plugin/plugin_files.h"

namespace gauntlet::worker {

// Not for sharing between threads. A definition HASH stands in HASH.command of the settings' folder, or in
// one of their files, and its files are in `files` beside it, each named by its SHA-256. Only this user may
// write all these. What was hashed is hashed again when it has changed.
class CommandFiles {
 public:
  explicit CommandFiles(const PluginSettings& settings) : settings_(settings) {}

  const PluginSettings& settings() const { return settings_; }
  // Stays valid. Error: there is none, others may write it, or its hash is another one.
  Result<const controllers::command::Definition*> Open(const std::string& hash);
  // Copies the files of an opened definition into a folder. Error: as Open.
  Status LayInto(const std::string& folder, const std::string& hash);

 private:
  struct Opened {
    controllers::command::Definition definition;
    std::string folder;  // of its files
  };
  // Which bytes a path stood for: a change of them changes one of these.
  struct Version {
    std::uint64_t device = 0;
    std::uint64_t inode = 0;
    std::int64_t size = 0;
    std::int64_t changed = 0;  // ns
    bool operator==(const Version&) const = default;
  };

  // Error: what is open has another hash.
  Status Verify(int file, const std::string& path, const std::string& hash);

  PluginSettings settings_;
  std::map<std::string, Opened> opened_;     // by hash
  std::map<std::string, Version> verified_;  // by path
};

}  // namespace gauntlet::worker
