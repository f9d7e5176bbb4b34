#include "master/directory/commands.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <filesystem>
#include <map>
#include <utility>

#include "base/nearest_name.h"
#include "base/printable.h"
#include "base/system/atomic_file.h"
#include "base/system/regular_file.h"
#include "base/system/sha256.h"
#include "base/system/trusted_path.h"
#include "base/system/unique_fd.h"
#include "controllers/command/command_rows.h"
#include "controllers/command/placeholders.h"
#include "controllers/command/requirements.h"
#include "master/directory/plugins.h"
#include "search/experiment/command_table.h"

namespace gauntlet {
namespace {

namespace fs = std::filesystem;
using controllers::command::Definition;
using controllers::command::File;

constexpr std::size_t kMostFiles = 10'000;
constexpr std::size_t kMostDefinitionBytes = std::size_t{16} << 20;

// A folder that goes with this process; workers remove what a killed one leaves, by its name and lock.
class TemporaryFolder {
 public:
  static Result<std::string> Path() {
    static TemporaryFolder folder;
    if (!folder.path_.empty()) return folder.path_;
    std::error_code failed;
    const fs::path place = fs::temp_directory_path(failed);
    std::string made = place / "gauntlet-new-XXXXXX";
    if (mkdtemp(made.data()) == nullptr)
      return SystemError("cannot make a folder for temporary files", errno);
    folder.lock_.Reset(open(made.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
    flock(folder.lock_.get(), LOCK_EX | LOCK_NB);
    // Its last name only now: one of this name without a lock is removed.
    const fs::path named = place / ("gauntlet-run-" + made.substr(made.size() - 6));
    if (rename(made.c_str(), named.c_str()) != 0)
      return SystemError("cannot make a folder for temporary files", errno);
    return folder.path_ = named;
  }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;

 private:
  TemporaryFolder() = default;
  ~TemporaryFolder() {
    std::error_code ignored;
    if (!path_.empty()) fs::remove_all(path_, ignored);
  }

  std::string path_;
  UniqueFd lock_;
};

struct Source {
  std::string name;  // in a run's folder
  fs::path path;
};

// The files that a name stands for: of a folder all in it.
Status AddSources(const fs::path& folder, const std::string& name, std::vector<Source>& sources) {
  const fs::path path = folder / name;
  std::error_code failed;
  const fs::file_status status = fs::symlink_status(path, failed);
  if (failed || !fs::exists(status))
    return InvalidInput(fmt::format("[command] files: there is no {}", Printable(path.string())));
  if (!fs::is_directory(status)) {
    sources.push_back({name, path});
    return Ok{};
  }
  std::vector<std::string> inside;
  for (fs::directory_iterator entry(path, failed), end; !failed && entry != end; entry.increment(failed))
    inside.push_back(entry->path().filename());
  if (failed) return SystemError(fmt::format("cannot read {}", path.string()), failed.value());
  std::ranges::sort(inside);
  for (const std::string& one : inside) {
    TRY(AddSources(folder, (fs::path(name) / one).string(), sources));
    if (sources.size() > kMostFiles)
      return InvalidInput(fmt::format("[command] files: more than {} in {}", kMostFiles, path.string()));
  }
  return Ok{};
}

// No part of the path but the last leads anywhere else; the last is a regular file.
Result<std::string> ReadSource(const fs::path& folder, const Source& source) {
  std::error_code failed;
  const fs::path real = fs::canonical(source.path.parent_path(), failed);
  const fs::path base = fs::canonical(folder, failed);
  const auto [end, rest] = std::mismatch(base.begin(), base.end(), real.begin(), real.end());
  if (failed || end != base.end())
    return InvalidInput(fmt::format("[command] files: {} leads out of {}; name it by --allow-file",
                                    Printable(source.name), Printable(folder.string())));
  return ReadRegularFile(source.path, controllers::command::kMostFileBytes);
}

Status KeepFile(const std::string& folder, const std::string& name, const std::string& bytes) {
  TRY(MakeDirectory(folder));
  return WriteFileAtomically(fmt::format("{}/{}", folder, name), bytes, kReadableByAll);
}

Result<controllers::PluginInfo> InfoOf(const Definition& definition, std::string hash, std::string file) {
  const controllers::PluginRows rows = controllers::command::RowsOf(definition);
  return controllers::PluginInfo{.hash = std::move(hash),
                                 .file = std::move(file),
                                 .description = controllers::WriteRows(rows),
                                 .controllers = rows.controllers,
                                 .scenarios = rows.scenarios,
                                 .begin = BeginCommand};
}

// Makes it known by the copy in the folder.
Result<std::string> Keep(const Definition& definition, const std::map<std::string, std::string>& files) {
  const std::string text = controllers::command::CanonicalText(definition);
  std::string hash = Sha256(text);
  if (controllers::FindPlugin(hash) != nullptr) return hash;
  TRY(const std::string folder, TemporaryFolder::Path());
  for (const auto& [name, bytes] : files) {
    TRY(KeepFile(fmt::format("{}/{}", folder, kCommandFiles), name, bytes));
  }
  TRY(KeepFile(folder, hash + kCommandEnding, text));
  TRY(AddCommandFile(fmt::format("{}/{}{}", folder, hash, kCommandEnding)));
  return hash;
}

}  // namespace

Result<std::optional<std::string>> AddCommandOf(const ExperimentText& experiment,
                                                const std::vector<std::string>& sets,
                                                const std::vector<std::string>& allowed) {
  TRY(std::optional<Definition> definition, ReadCommand(experiment, sets));
  if (!definition) return std::optional<std::string>();
  if (IsForeign(experiment.file_name))
    return InvalidInput(
        fmt::format("{}: its program would run in your name, and another user owns the file; a "
                    "copy of it and of what lies beside it is yours (cp -r)",
                    experiment.file_name));
  const fs::path parent = fs::path(experiment.file_name).parent_path();
  const fs::path folder = parent.empty() ? fs::path(".") : parent;
  std::vector<Source> sources;
  for (const std::string& name : definition->names) {
    TRY(AddSources(folder, name, sources));
  }
  std::map<std::string, std::string> files;  // by SHA-256
  const auto add = [&](const std::string& name, const fs::path& path, std::string bytes) -> Status {
    if (FindByName(definition->files, name) != nullptr)
      return InvalidInput(fmt::format("[command] files: two are called {}", Printable(name)));
    if (name == definition->case_template) {
      const Status right = controllers::command::CheckTemplate(*definition, bytes);
      if (!right) return InvalidInput(fmt::format("{}: {}", Printable(path.string()), right.error().message));
    }
    struct stat status {};
    const bool executable = stat(path.c_str(), &status) == 0 && (status.st_mode & S_IXUSR) != 0;
    std::string hash = Sha256(bytes);
    definition->files.push_back({name, hash, executable});
    files.insert_or_assign(std::move(hash), std::move(bytes));
    return Ok{};
  };
  for (const Source& source : sources) {
    TRY(std::string bytes, ReadSource(folder, source));
    TRY(add(source.name, source.path, std::move(bytes)));
  }
  for (const std::string& path : allowed) {
    TRY(std::string bytes, ReadSmallFile(path, controllers::command::kMostFileBytes));
    TRY(add(fs::path(path).filename(), path, std::move(bytes)));
  }
  if (!definition->case_template.empty() &&
      FindByName(definition->files, definition->case_template) == nullptr)
    return InvalidInput(fmt::format("{}: template = \"{}\" is none of `files`", experiment.file_name,
                                    Printable(definition->case_template)));
  std::ranges::sort(definition->files, {}, &File::name);
  TRY(std::string hash, Keep(*definition, files));
  return std::optional(std::move(hash));
}

Result<std::string> AddCommandFile(const std::string& file) {
  TRY(const std::string text, ReadRegularFile(file, kMostDefinitionBytes));
  std::string hash = Sha256(text);
  const Result<Definition> definition = controllers::command::Parse(text);
  if (!definition) return InvalidInput(fmt::format("{}: {}", file, definition.error().message));
  TRY(controllers::PluginInfo plugin, InfoOf(*definition, hash, file));
  TRY(controllers::AddPlugin(std::move(plugin)));
  return hash;
}

Result<Definition> CommandOf(const std::string& hash) {
  const controllers::PluginInfo* plugin = controllers::FindPlugin(hash);
  if (plugin == nullptr) return InvalidInput("the command " + hash + " is not known");
  TRY(const std::string text, ReadRegularFile(plugin->file, kMostDefinitionBytes));
  if (Sha256(text) != hash)
    return InvalidInput(
        fmt::format("{} is another command now: its SHA-256 is {}", plugin->file, Sha256(text)));
  return controllers::command::Parse(text);
}

Status CopyCommandFiles(const std::string& file, const std::string& folder) {
  TRY(const std::string text, ReadRegularFile(file, kMostDefinitionBytes));
  TRY(const Definition definition, controllers::command::Parse(text));
  for (const File& one : definition.files) {
    const std::string name = fmt::format("{}/{}", kCommandFiles, one.hash);
    TRY(const std::string bytes,
        ReadRegularFile(fs::path(file).parent_path() / name, controllers::command::kMostFileBytes));
    if (Sha256(bytes) != one.hash)
      return InvalidInput(fmt::format("{} has changed: it is no longer {}", name, one.name));
    TRY(KeepFile(fmt::format("{}/{}", folder, kCommandFiles), one.hash, bytes));
  }
  return Ok{};
}

Result<sim::RunBeginning> BeginCommand(const sim::RunSpec& spec) {
  TRY(const Definition definition, CommandOf(spec.scenario_plugin));
  return sim::RunBeginning{controllers::command::RequirementsOf(definition), sim::RunStart{}};
}

}  // namespace gauntlet
