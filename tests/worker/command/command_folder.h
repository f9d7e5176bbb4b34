// A folder of definitions of commands with their files, as runners find them.
#pragma once

#include <sys/stat.h>

#include <fstream>
#include <string>
#include <vector>

#include "base/system/sha256.h"
#include "controllers/command/definition.h"
#include "tests/support/process.h"
#include "worker/plugin/plugin_files.h"

namespace gauntlet::worker {

inline std::string ContentsOf(const std::string& path) {
  std::ifstream in(path);
  return {std::istreambuf_iterator<char>(in), {}};
}

class CommandFolder {
 public:
  CommandFolder() { mkdir((folder_ / "files").c_str(), 0755); }

  const std::string& path() const { return folder_.path(); }
  PluginSettings settings() const { return {.folder = path()}; }
  std::string PathOf(const std::string& hash) const { return folder_ / (hash + ".command"); }
  std::string PathOfFile(const std::string& hash) const { return folder_ / ("files/" + hash); }

  controllers::command::File AddFile(const std::string& name, const std::string& content,
                                     bool executable) const {
    const std::string hash = Sha256(content);
    std::ofstream(PathOfFile(hash)) << content;
    return {.name = name, .hash = hash, .executable = executable};
  }
  // The hash.
  std::string Add(const controllers::command::Definition& definition) const {
    const std::string text = CanonicalText(definition);
    const std::string hash = Sha256(text);
    std::ofstream(PathOf(hash)) << text;
    return hash;
  }

 private:
  testing_support::TemporaryDirectory folder_;
};

// Of a shell's commands, which report a score.
inline controllers::command::Definition ShellDefinition(const std::string& script) {
  controllers::command::Definition definition;
  // A brace is written twice there.
  std::string doubled;
  for (const char letter : script) doubled.append(letter == '{' || letter == '}' ? 2 : 1, letter);
  definition.run = {"sh", "-c", doubled, "{case}", "{out}", "{seed}"};
  definition.metrics = {{.name = "score", .from = "", .formula = "", .unit = ""}};
  definition.fitness = "score";
  definition.failure = "score < 1";
  return definition;
}

}  // namespace gauntlet::worker
