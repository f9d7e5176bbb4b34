#include "master/cli/output_file.h"

#include <sys/stat.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <system_error>

#include <fmt/format.h>

#include "base/system/atomic_file.h"

namespace gauntlet::master {

Status WriteOutputFile(const std::string& path, const std::string& content) {
  std::error_code error;
  const auto status = std::filesystem::symlink_status(path, error);
  if (!std::filesystem::exists(status) || std::filesystem::is_regular_file(status)) {
    const mode_t mask = umask(0);
    umask(mask);
    const Status written = ReplaceFile(path, content, 0666 & ~mask);
    if (written) return written;
    return Error{written.error().kind,
                 fmt::format("{}: cannot be written: {}", path, written.error().message)};
  }
  errno = 0;
  std::ofstream stream(path, std::ios::binary | std::ios::trunc);
  stream << content;
  stream.close();
  if (stream) return Ok{};
  return Error{ErrorKind::kIo, fmt::format("{}: cannot be written: {}", path, std::strerror(errno))};
}

}  // namespace gauntlet::master
