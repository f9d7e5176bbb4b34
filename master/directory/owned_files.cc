#include "master/directory/owned_files.h"

#include <fmt/format.h>

#include <cerrno>
#include <filesystem>
#include <system_error>
#include <utility>

#include "base/shell_quoted.h"
#include "base/system/atomic_file.h"

namespace gauntlet {
namespace {

// The directory itself, whatever link a user named it by.
std::string Resolved(const std::string& path) {
  std::error_code error;
  const std::filesystem::path resolved = std::filesystem::canonical(path, error);
  return error ? path : resolved.string();
}

}  // namespace

OwnedFiles::OwnedFiles(const CampaignDirectory& directory)
    : directory_(directory),
      kept_{{directory.experiment_path()}, {directory.searches_path()}, {directory.slurm_path()}} {
  (void)Check();
}

Status OwnedFiles::NoteOpened() {
  const std::string database = directory_.database_path();
  const std::string go_on = fmt::format("go on with `gauntlet resume {}`", PastedPath(directory_.path()));
  const std::lock_guard lock(mutex_);
  for (Opened& file : std::vector<Opened>{
           {Resolved(directory_.path()), "the directory " + directory_.path(),
            "If it was moved, all that was stored is there: go on with `gauntlet resume THERE`"},
           {database, database,
            "What was stored is lost, unless there is a copy: put it back and resume, or begin anew in "
            "another directory with the settings of experiment.toml"},
           {database + "-wal", database + "-wal",
            "The runs that were stored last are lost with it: " + go_on + ", which simulates them again"},
           {database + "-shm", database + "-shm", "Nothing is lost: " + go_on},
           {directory_.lock_path(), directory_.lock_path(),
            "Another master may have begun since. Nothing is lost: " + go_on}}) {
    TRY(const std::optional<FileId> id, IdentifyFile(file.path));
    if (!id) continue;
    file.id = *id;
    opened_.push_back(std::move(file));
  }
  return Ok{};
}

Status OwnedFiles::Check() {
  const std::lock_guard lock(mutex_);
  for (const Opened& file : opened_) {
    TRY(const std::optional<FileId> now, IdentifyFile(file.path));
    if (now == file.id) continue;
    return Error{
        ErrorKind::kNotFound,
        fmt::format("{} {} while this master served the campaign, so it stops. {}", file.name,
                    now ? "is gone, and another one has its name," : "is gone, deleted or moved away,",
                    file.loss)};
  }
  for (Kept& file : kept_) {
    TRY(Keep(file));
  }
  return Ok{};
}

Status OwnedFiles::Keep(Kept& file) {
  std::optional<FileVersion> now = VersionOf(file.path);
  if (!now && errno == ENOENT && file.seen) {
    TRY(WriteFileAtomically(file.path, file.text, kReadableByAll));
    now = VersionOf(file.path);
  }
  if (!now || now == file.seen) return Ok{};
  // What cannot be read (no descriptor is left) is looked at again the next time.
  Result<std::string> text = ReadRegularFile(file.path);
  if (!text) return Ok{};
  file.text = *std::move(text);
  file.seen = now;
  return Ok{};
}

}  // namespace gauntlet
