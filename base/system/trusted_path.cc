#include "base/system/trusted_path.h"

#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>

#include "base/shell_quoted.h"
#include "base/system/atomic_file.h"

namespace gauntlet {
namespace {

bool IsForeign(const struct stat& status) {
  return status.st_uid != geteuid() && status.st_uid != 0;
}

Status Check(const std::string& path, const std::string& directory, const struct stat& status) {
  if (IsForeign(status)) {
    return InvalidInput(fmt::format(
        "{} belongs to user {}, not to you (user {}), who so would decide what this command does in your "
        "name. Look at what it holds, its programs too, before you make it yours, which `cp -r {} COPY` does",
        path, status.st_uid, geteuid(), PastedPath(directory)));
  }
  if (!S_ISLNK(status.st_mode) && (status.st_mode & (S_IWGRP | S_IWOTH)) != 0) {
    return InvalidInput(fmt::format(
        "{} has mode {:03o}: other users may write it, who so would decide what this command does in your "
        "name. If it holds what you left there: `chmod go-w {}`",
        path, status.st_mode & 0777, PastedPath(path)));
  }
  return Ok{};
}

}  // namespace

Status CheckOnlyWeWrite(const std::string& directory, std::span<const std::string_view> files) {
  struct stat status {};
  if (stat(directory.c_str(), &status) != 0)
    return SystemError(fmt::format("cannot look at {}", directory), errno);
  TRY(Check(directory, directory, status));
  for (const std::string_view file : files) {
    const std::string path = fmt::format("{}/{}", directory, file);
    if (lstat(path.c_str(), &status) != 0) {
      if (errno == ENOENT || errno == ENOTDIR) continue;
      return SystemError(fmt::format("cannot look at {}", path), errno);
    }
    TRY(Check(path, directory, status));
  }
  return Ok{};
}

bool IsForeign(const std::string& path) {
  struct stat status {};
  return stat(path.c_str(), &status) == 0 && IsForeign(status);
}

}  // namespace gauntlet
