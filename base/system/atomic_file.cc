#include "base/system/atomic_file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <utility>

#include "base/system/resource_limits.h"

namespace gauntlet {
namespace {

// Its number is the errno, 0 = none.
int WriteAll(int fd, std::string_view bytes) {
  while (!bytes.empty()) {
    const ssize_t written = write(fd, bytes.data(), bytes.size());
    if (written < 0) {
      if (errno == EINTR) continue;
      return errno;
    }
    bytes.remove_prefix(static_cast<std::size_t>(written));
  }
  return 0;
}

std::string DirectoryOf(const std::string& path) {
  const std::size_t slash = path.rfind('/');
  return slash == std::string::npos ? "./" : path.substr(0, slash + 1);
}

Status Replace(const std::string& path, std::string_view bytes, mode_t mode, bool durable) {
  TRY(FileReplacement file, FileReplacement::Begin(path, mode));
  TRY(file.Write(bytes));
  return file.Finish(durable);
}

}  // namespace

std::string ErrnoText(int error_number) {
  std::string text = std::strerror(error_number);
  if (error_number == EFBIG) text += " for this process (ulimit -f)";
  if (error_number == EMFILE || error_number == EAGAIN || error_number == ENOMEM)
    text += "; limits here: " + DescribeLimits();
  return text;
}

Error SystemError(const std::string& what, int error_number) {
  ErrorKind kind = ErrorKind::kIo;
  if (error_number == ENOSPC || error_number == EDQUOT) kind = ErrorKind::kNoSpace;
  if (error_number == ENOENT) kind = ErrorKind::kNotFound;
  const char* hint = kind == ErrorKind::kNoSpace ? "the disk is full: " : "";
  if (error_number == EMFILE || error_number == ENFILE || error_number == EAGAIN || error_number == ENOMEM)
    kind = ErrorKind::kNoSpace;
  return {kind, fmt::format("{}{}: {}", hint, what, ErrnoText(error_number))};
}

Result<FileReplacement> FileReplacement::Begin(const std::string& path, mode_t mode) {
  std::string temporary = path + ".XXXXXX";
  const int fd = mkostemp(temporary.data(), O_CLOEXEC);
  if (fd < 0) return SystemError(fmt::format("cannot create a file in {}", DirectoryOf(path)), errno);
  FileReplacement file(path, std::move(temporary), fd);
  if (fchmod(fd, mode) != 0) return SystemError(fmt::format("cannot write {}", path), errno);
  return file;
}

FileReplacement::FileReplacement(std::string path, std::string temporary, int fd)
    : path_(std::move(path)), temporary_(std::move(temporary)), fd_(fd) {}

FileReplacement::FileReplacement(FileReplacement&& other) noexcept
    : path_(std::move(other.path_)),
      temporary_(std::exchange(other.temporary_, {})),
      fd_(std::move(other.fd_)) {}

FileReplacement::~FileReplacement() {
  if (!temporary_.empty()) unlink(temporary_.c_str());
}

Status FileReplacement::Write(std::string_view bytes) {
  const int error = WriteAll(fd_.get(), bytes);
  if (error != 0) return SystemError(fmt::format("cannot write {}", path_), error);
  return Ok{};
}

Status FileReplacement::Finish(bool durable) {
  int error = 0;
  if (durable && fsync(fd_.get()) != 0) error = errno;
  if (close(fd_.Release()) != 0 && error == 0) error = errno;
  if (error == 0 && std::rename(temporary_.c_str(), path_.c_str()) != 0) error = errno;
  if (error != 0) return SystemError(fmt::format("cannot write {}", path_), error);
  temporary_.clear();
  return durable ? SyncDirectory(DirectoryOf(path_)) : Ok{};
}

Status SyncDirectory(const std::string& directory) {
  const UniqueFd fd(open(directory.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
  if (fd.valid() && fsync(fd.get()) == 0) return Ok{};
  return SystemError(fmt::format("cannot synchronise {}", directory), errno);
}

Status WriteFileAtomically(const std::string& path, std::string_view bytes, mode_t mode) {
  return Replace(path, bytes, mode, /*durable=*/true);
}

Status ReplaceFile(const std::string& path, std::string_view bytes, mode_t mode) {
  return Replace(path, bytes, mode, /*durable=*/false);
}

Result<std::string> ReadSmallFile(const std::string& path, std::size_t limit) {
  const UniqueFd fd(open(path.c_str(), O_RDONLY | O_CLOEXEC));
  if (!fd.valid()) return SystemError(fmt::format("cannot open {}", path), errno);
  return ReadAll(fd.get(), path, limit);
}

Result<std::string> ReadAll(int fd, const std::string& path, std::size_t limit) {
  std::string bytes;
  std::array<char, 16 * 1024> buffer;
  while (bytes.size() <= limit) {
    const ssize_t size = read(fd, buffer.data(), buffer.size());
    if (size < 0 && errno == EINTR) continue;
    if (size < 0) return SystemError(fmt::format("cannot read {}", path), errno);
    if (size == 0) return bytes;
    bytes.append(buffer.data(), static_cast<std::size_t>(size));
  }
  return Error{ErrorKind::kCorrupt, fmt::format("{} is longer than the {} bytes it may have", path, limit)};
}

}  // namespace gauntlet
