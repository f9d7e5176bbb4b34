#include "master/directory/opened_files.h"

#include <fmt/format.h>

#include <filesystem>
#include <optional>
#include <system_error>
#include <utility>

#include "base/shell_quoted.h"

namespace gauntlet {
namespace {

// The directory itself, whatever link a user named it by.
std::string Resolved(const std::string& path) {
  std::error_code error;
  const std::filesystem::path resolved = std::filesystem::canonical(path, error);
  return error ? path : resolved.string();
}

}  // namespace

Result<OpenedFiles> OpenedFiles::Of(const CampaignDirectory& directory) {
  const std::string& database = directory.database_path();
  const std::string go_on = fmt::format("go on with `gauntlet resume {}`", PastedPath(directory.path()));
  OpenedFiles opened;
  for (File& file : std::vector<File>{
           {Resolved(directory.path()), "the directory " + directory.path(),
            "If it was moved, all that was stored is there: go on with `gauntlet resume THERE`"},
           {database, database,
            "What was stored is lost, unless there is a copy: put it back and resume, or begin anew in "
            "another "
            "directory with the settings of experiment.toml"},
           {database + "-wal", database + "-wal",
            "The runs that were stored last are lost with it: " + go_on + ", which simulates them again"},
           {database + "-shm", database + "-shm", "Nothing is lost: " + go_on},
           {directory.lock_path(), directory.lock_path(),
            "Another master may have begun since. Nothing is lost: " + go_on}}) {
    TRY(const std::optional<FileId> id, IdentifyFile(file.path));
    if (!id) continue;
    file.id = *id;
    opened.files_.push_back(std::move(file));
  }
  return opened;
}

Status OpenedFiles::Check() const {
  for (const File& file : files_) {
    TRY(const std::optional<FileId> now, IdentifyFile(file.path));
    if (now == file.id) continue;
    return Error{
        ErrorKind::kNotFound,
        fmt::format("{} {} while this master served the campaign, so it stops. {}", file.name,
                    now ? "is gone, and another one has its name," : "is gone, deleted or moved away,",
                    file.loss)};
  }
  return Ok{};
}

}  // namespace gauntlet
