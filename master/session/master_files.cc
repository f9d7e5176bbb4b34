#include "master/session/master_files.h"

#include <spdlog/spdlog.h>

#include <filesystem>
#include <system_error>

#include "base/system/atomic_file.h"
#include "proto/access_file.h"

namespace gauntlet::master {

MasterFiles::~MasterFiles() {
  if (Status removed = proto::RemoveAccess(directory_.access_path(), epoch_); !removed)
    spdlog::warn("{}", removed.error().message);
  if (!CheckNewest()) return;
  std::error_code ignored;
  std::filesystem::remove(directory_.status_path(), ignored);
  std::filesystem::remove(directory_.stop_path(), ignored);
}

bool MasterFiles::StopRequested() const {
  std::error_code ignored;
  return std::filesystem::exists(directory_.stop_path(), ignored);
}

Status MasterFiles::PublishStatus(std::string_view json) const {
  return ReplaceFile(directory_.status_path(), json, kReadableByAll);
}

}  // namespace gauntlet::master
