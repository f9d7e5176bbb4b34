#include "master/directory/kept_files.h"

#include <sys/stat.h>

#include <cerrno>
#include <utility>

#include "base/system/atomic_file.h"
#include "base/system/regular_file.h"

namespace gauntlet {

KeptFiles::KeptFiles(const std::vector<std::string>& paths) {
  for (const std::string& path : paths) files_.push_back({.path = path, .text = ""});
  (void)Restore();
}

Status KeptFiles::Look(File& file) {
  struct stat info {};
  if (lstat(file.path.c_str(), &info) != 0) {
    if (errno != ENOENT || file.inode == 0) return Ok{};
    TRY(WriteFileAtomically(file.path, file.text, kReadableByAll));
    if (lstat(file.path.c_str(), &info) != 0) return Ok{};
  }
  const std::int64_t changed = std::int64_t{1'000'000'000} * info.st_mtim.tv_sec + info.st_mtim.tv_nsec;
  if (file.inode == info.st_ino && file.changed == changed) return Ok{};
  // What cannot be read (no descriptor is left) is looked at again the next time.
  Result<std::string> text = ReadRegularFile(file.path);
  if (!text) return Ok{};
  file.text = *std::move(text);
  file.inode = info.st_ino;
  file.changed = changed;
  return Ok{};
}

Status KeptFiles::Restore() {
  const std::lock_guard lock(mutex_);
  for (File& file : files_) {
    TRY(Look(file));
  }
  return Ok{};
}

}  // namespace gauntlet
