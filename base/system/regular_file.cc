#include "base/system/regular_file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>

#include <cerrno>
#include <utility>

#include "base/system/atomic_file.h"

namespace gauntlet {
namespace {

constexpr mode_t kWritableByUsAlone = 0755;

const char* KindOf(mode_t mode) {
  if (S_ISREG(mode)) return "a file";
  if (S_ISLNK(mode)) return "a symbolic link";
  if (S_ISDIR(mode)) return "a directory";
  if (S_ISFIFO(mode)) return "a named pipe";
  if (S_ISSOCK(mode)) return "a socket";
  return "a device";
}

Error NoRegularFile(const std::string& path, mode_t mode) {
  return InvalidInput(fmt::format("{} is {}; here belongs a regular file, or none", path, KindOf(mode)));
}

}  // namespace

Result<UniqueFd> OpenRegularFile(const std::string& path, int flags, mode_t mode) {
  // O_NONBLOCK: opening a named pipe would wait for its other end.
  UniqueFd file(open(path.c_str(), flags | O_NOFOLLOW | O_NONBLOCK | O_NOCTTY | O_CLOEXEC, mode));
  const int error = file.valid() ? 0 : errno;
  struct stat status {};
  const int looked = file.valid() ? fstat(file.get(), &status) : lstat(path.c_str(), &status);
  if (looked == 0 && !S_ISREG(status.st_mode)) return NoRegularFile(path, status.st_mode);
  if (error != 0 || looked != 0)
    return SystemError(fmt::format("cannot open {}", path), error != 0 ? error : errno);
  return file;
}

Result<std::string> ReadRegularFile(const std::string& path, std::size_t limit) {
  const Result<UniqueFd> file = OpenRegularFile(path, O_RDONLY);
  return file ? ReadAll(file->get(), path, limit) : file.error();
}

Status CheckRegularFile(const std::string& path) {
  struct stat status {};
  if (lstat(path.c_str(), &status) == 0 && !S_ISREG(status.st_mode))
    return NoRegularFile(path, status.st_mode);
  return Ok{};
}

Status MakeDirectory(const std::string& path) {
  if (mkdir(path.c_str(), kWritableByUsAlone) == 0) return Ok{};
  const int error = errno;
  struct stat status {};
  if (error != EEXIST || lstat(path.c_str(), &status) != 0)
    return SystemError(fmt::format("cannot make the directory {}", path), error);
  if (S_ISDIR(status.st_mode)) return Ok{};
  return InvalidInput(
      fmt::format("{} is {}; here belongs a directory, or nothing", path, KindOf(status.st_mode)));
}

Result<std::optional<FileId>> IdentifyFile(const std::string& path) {
  struct stat status {};
  if (lstat(path.c_str(), &status) == 0) return std::optional(FileId{status.st_dev, status.st_ino});
  if (errno == ENOENT || errno == ENOTDIR) return std::optional<FileId>();
  return SystemError(fmt::format("cannot look at {}", path), errno);
}

}  // namespace gauntlet
