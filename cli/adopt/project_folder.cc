#include "cli/adopt/project_folder.h"

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <iterator>
#include <set>

#include <fmt/format.h>

#include "base/printable.h"
#include "base/shell_quoted.h"
#include "base/split.h"
#include "controllers/command/outcome.h"

namespace gauntlet {
namespace {

namespace fs = std::filesystem;

constexpr int kMostAbove = 6;  // folders above the file's
constexpr std::size_t kFewEntries = 20;
constexpr std::uintmax_t kSmallFile = std::uintmax_t{64} << 10;  // bytes
constexpr std::uint64_t kMostProjectBytes = std::uint64_t{1} << 30;

// Where ARGoS looks: as it is named, or with an ending.
bool IsThere(const fs::path& library) {
  std::error_code failed;
  for (const char* ending : {"", ".so"})
    if (fs::is_regular_file(library.string() + ending, failed)) return true;
  return false;
}

bool FoundElsewhere(const std::string& library) {
  if (library.starts_with('/')) return IsThere(library);
  const char* const path = std::getenv("ARGOS_PLUGIN_PATH");
  for (const std::string& folder : Split(path == nullptr ? "" : path, ':'))
    if (!folder.empty() && IsThere(fs::path(folder) / library)) return true;
  return false;
}

bool IsKeptByVersionControl(const fs::path& path) {
  return path.filename() == ".git" || path.filename() == ".hg" || path.filename() == ".svn";
}

// "a/b" and "a" of "a/b/c".
void AddParents(const std::string& path, std::set<std::string>& folders) {
  for (fs::path parent = fs::path(path).parent_path(); !parent.empty(); parent = parent.parent_path())
    folders.insert(parent.string());
}

// Leads to the same place, where that is outside of the project.
void CopyLink(const fs::path& link, const fs::path& copy, const std::string& project,
              std::error_code& failed) {
  const fs::path target = fs::weakly_canonical(link, failed);
  const bool inside = target.string().starts_with(project + "/");
  fs::create_symlink(inside ? fs::read_symlink(link, failed) : target, copy, failed);
}

// Whether a folder has so few entries, at any depth, that each run has one of its own.
bool HasFewEntries(const fs::path& folder) {
  std::error_code failed;
  std::size_t entries = 0;
  for (auto entry = fs::recursive_directory_iterator(folder, failed); !failed && entry != fs::end(entry);
       entry.increment(failed))
    if (++entries > kFewEntries) return false;
  return true;
}

// The commands that make it: folders of its own in which there are copies of small files and links to the
// rest.
class RunFolder {
 public:
  explicit RunFolder(const RunFolderPlan& plan) : plan_(plan) {
    for (const auto& [path, name] : plan.libraries) AddParents(path, folders_);
    for (const std::string& path : plan.written) AddParents(path, folders_);
  }

  std::string Commands() {
    Add("");
    std::string made;
    for (const std::string& folder : folders_) made += " " + ShellQuoted(folder);
    std::string commands = made.empty() ? "" : "mkdir -p" + made + "\n";
    for (const auto& [path, name] : plan_.libraries)
      commands += fmt::format("ln -s \"$own\"/lib/{} {}\n", ShellQuoted(name), ShellQuoted(path));
    return commands + commands_;
  }

 private:
  bool IsOwn(const std::string& path, const fs::directory_entry& entry) {
    if (folders_.contains(path)) return true;
    std::error_code failed;
    if (entry.is_symlink(failed) || !HasFewEntries(entry.path())) return false;
    return folders_.insert(path).second;
  }

  void Add(const std::string& folder) {
    std::string copied;
    std::string linked;
    std::set<std::string> own;
    std::error_code failed;
    for (const fs::directory_entry& entry :
         fs::directory_iterator(fs::path(plan_.project) / folder, failed)) {
      const std::string name = entry.path().filename();
      const std::string path = folder.empty() ? name : folder + "/" + name;
      if (IsKeptByVersionControl(entry.path()) || plan_.libraries.contains(path)) continue;
      const std::string quoted = " " + ShellQuoted(plan_.project + "/" + path);
      const bool is_file = entry.is_regular_file(failed);
      if (entry.is_directory(failed) && IsOwn(path, entry)) {
        own.insert(path);
      } else if (is_file &&
                 (entry.file_size(failed) <= kSmallFile || std::ranges::count(plan_.written, path) > 0)) {
        copied += quoted;
      } else {
        linked += quoted;
      }
    }
    const std::string into = " " + ShellQuoted(folder.empty() ? "." : folder) + "\n";
    if (!copied.empty()) commands_ += "cp -n" + copied + into;
    if (!linked.empty()) commands_ += "ln -s" + linked + into;
    for (const std::string& path : own) Add(path);
  }

  const RunFolderPlan& plan_;
  std::set<std::string> folders_;  // that are the run's own
  std::string commands_;
};

}  // namespace

Result<std::string> FindProjectFolder(const std::string& argos_file,
                                      const std::vector<std::string>& libraries,
                                      const std::vector<std::string>& paths) {
  std::error_code failed;
  std::vector<fs::path> folders = {fs::current_path(failed)};
  fs::path above = fs::canonical(argos_file, failed).parent_path();
  for (int i = 0; i < kMostAbove && above != above.root_path(); ++i, above = above.parent_path())
    folders.push_back(above);
  std::vector<std::string> missing = libraries;  // where most of them are
  std::string best;
  std::ptrdiff_t most = -1;
  for (const fs::path& folder : folders) {
    std::vector<std::string> lacking;
    std::ranges::copy_if(libraries, std::back_inserter(lacking), [&](const std::string& library) {
      return !IsThere(folder / library) && !FoundElsewhere(library);
    });
    const auto found = std::ranges::count_if(paths, [&](const std::string& path) {
      return path.front() != '/' && fs::exists(folder / path, failed);
    });
    if (lacking.empty() && found > most) {
      most = found;
      best = folder;
    }
    if (lacking.size() < missing.size()) missing = std::move(lacking);
  }
  if (!best.empty()) return best;
  return InvalidInput(
      fmt::format("{}: its library {} is neither in {} nor in the folder of the file or above it, nor "
                  "in ARGOS_PLUGIN_PATH: build the project first, and call adopt from the folder from "
                  "which you start argos3",
                  Printable(argos_file), Printable(missing.front()), Printable(folders.front().string())));
}

std::map<std::string, FileStamp> FilesIn(const std::string& folder) {
  std::map<std::string, FileStamp> files;
  std::error_code failed;
  for (auto entry = fs::recursive_directory_iterator(folder, failed); !failed && entry != fs::end(entry);
       entry.increment(failed)) {
    if (IsKeptByVersionControl(entry->path())) entry.disable_recursion_pending();
    if (!entry->is_regular_file(failed)) continue;
    const auto written = entry->last_write_time(failed).time_since_epoch();
    files[entry->path().lexically_relative(folder).string()] = {
        entry->file_size(failed), std::chrono::duration_cast<std::chrono::nanoseconds>(written).count()};
  }
  return files;
}

Status CopyProject(const std::string& project, const std::string& folder) {
  std::uint64_t bytes = 0;
  for (const auto& [name, stamp] : FilesIn(project)) bytes += stamp.size;
  if (bytes > kMostProjectBytes)
    return InvalidInput(
        fmt::format("{} holds {} MB, and is copied once to see what a run writes: at most {} MB are "
                    "possible. Give a folder with what the experiment needs",
                    Printable(project), bytes >> 20, kMostProjectBytes >> 20));
  std::error_code failed;
  for (auto entry = fs::recursive_directory_iterator(project, failed); !failed && entry != fs::end(entry);
       entry.increment(failed)) {
    const fs::path copy = folder / entry->path().lexically_relative(project);
    if (IsKeptByVersionControl(entry->path())) {
      entry.disable_recursion_pending();
    } else if (entry->is_symlink(failed)) {
      CopyLink(entry->path(), copy, project, failed);
    } else if (entry->is_directory(failed)) {
      fs::create_directory(copy, failed);
    } else if (entry->is_regular_file(failed)) {
      fs::copy_file(entry->path(), copy, failed);
    }
    if (failed) break;
  }
  if (failed)
    return InvalidInput(fmt::format("{} cannot be copied: {}", Printable(project), failed.message()));
  return Ok{};
}

std::string RunScript(const RunFolderPlan& plan) {
  std::string text = fmt::format(R"(#!/bin/sh
# Written by gauntlet adopt: makes this folder one in which the project's experiment runs, and runs it.
project={}
own="$PWD"/{}
if [ ! -d "$project" ]; then
  echo "gauntlet: the project's folder $project is not on this machine" >&2
  exit 1
fi
)",
                                 ShellQuoted(plan.project), ShellQuoted(plan.own));
  text += RunFolder(plan).Commands();
  text += fmt::format(R"(export ARGOS_PLUGIN_PATH="$own/plugins"
export LD_LIBRARY_PATH="$own/lib${{LD_LIBRARY_PATH:+:$LD_LIBRARY_PATH}}"
argos3 -n -c "$1"
code=$?
[ $code -eq 0 ] && [ -e gauntlet-trajectory.csv ] && exit 0
if [ ! -e gauntlet-trajectory.csv.draft ] && grep -q 'Error while trying to distribute entities' {0} &&
    grep -q -E 'Exceeded max trials|Impossible to place entity' {0}; then
  echo 'gauntlet: the robots find no room' >&2
fi
[ $code -ne 0 ] && exit $code
echo 'gauntlet: argos3 ended before the experiment did' >&2
exit 1
)",
                      controllers::command::kStderrFile);
  return text;
}

}  // namespace gauntlet
