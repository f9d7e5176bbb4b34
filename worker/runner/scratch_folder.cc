#include "worker/runner/scratch_folder.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <filesystem>
#include <system_error>
#include <utility>

#include "base/system/atomic_file.h"

namespace gauntlet::worker {
namespace {

namespace fs = std::filesystem;

// A folder of the second kind is locked by who uses it. It has the first name until it is.
constexpr const char* kUnlocked = "gauntlet-new-";
constexpr const char* kLocked = "gauntlet-run-";

// Nothing when somebody holds the lock, or the folder is not ours.
UniqueFd Lock(const fs::path& folder) {
  UniqueFd opened(open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_NOFOLLOW | O_CLOEXEC));
  if (opened.valid() && flock(opened.get(), LOCK_EX | LOCK_NB) != 0) opened.Reset();
  return opened;
}

// Folders whose owner may not write are made writable first.
void RemoveWhole(const fs::path& folder) {
  std::error_code failed;
  fs::remove_all(folder, failed);
  if (!failed) return;
  fs::permissions(folder, fs::perms::owner_all, fs::perm_options::add, failed);
  fs::recursive_directory_iterator entry(folder, failed);
  for (const fs::recursive_directory_iterator end; !failed && entry != end; entry.increment(failed)) {
    std::error_code ignored;
    if (entry->symlink_status(ignored).type() == fs::file_type::directory)
      fs::permissions(entry->path(), fs::perms::owner_all, fs::perm_options::add, ignored);
  }
  fs::remove_all(folder, failed);
}

}  // namespace

void ScratchFolder::RemoveAbandoned() {
  std::error_code ignored;
  const fs::path place = fs::temp_directory_path(ignored);
  for (fs::directory_iterator entry(place, ignored), end; !ignored && entry != end;
       entry.increment(ignored)) {
    if (!entry->path().filename().string().starts_with(kLocked)) continue;
    if (Lock(entry->path()).valid()) RemoveWhole(entry->path());
  }
}

Result<ScratchFolder> ScratchFolder::Make(const std::string& named) {
  std::error_code failed;
  if (!named.empty()) {
    fs::create_directories(named, failed);
    if (failed) return SystemError(fmt::format("cannot make {}", named), failed.value());
    return ScratchFolder(named, UniqueFd());
  }
  const fs::path place = fs::temp_directory_path(failed);
  if (failed) return SystemError("there is no folder for temporary files (TMPDIR)", failed.value());
  static const bool cleaned = (RemoveAbandoned(), true);  // once in the life of a process
  static_cast<void>(cleaned);
  std::string made = place / (std::string(kUnlocked) + "XXXXXX");
  if (mkdtemp(made.data()) == nullptr) return SystemError(fmt::format("cannot make {}", made), errno);
  UniqueFd lock = Lock(made);
  const std::string path =
      place / (kLocked + fs::path(made).filename().string().substr(std::string_view(kUnlocked).size()));
  if (!lock.valid() || rename(made.c_str(), path.c_str()) != 0)
    return SystemError(fmt::format("cannot make {}", path), errno);
  return ScratchFolder(path, std::move(lock));
}

bool ScratchFolder::HoldsOnlyEmpty(const std::string& file) const {
  struct stat made {};
  struct stat there {};
  if (fstat(lock_.get(), &made) != 0 || lstat(path_.c_str(), &there) != 0) return false;
  if (made.st_dev != there.st_dev || made.st_ino != there.st_ino || (there.st_mode & S_IRWXU) != S_IRWXU)
    return false;
  std::error_code failed;
  for (fs::directory_iterator entry(path_, failed), end; !failed && entry != end; entry.increment(failed)) {
    if (entry->path().filename() != file || lstat(entry->path().c_str(), &there) != 0) return false;
    if (!S_ISREG(there.st_mode) || there.st_size != 0 || there.st_nlink != 1) return false;
  }
  return !failed;
}

ScratchFolder::ScratchFolder(ScratchFolder&& other) noexcept
    : path_(std::exchange(other.path_, "")), lock_(std::move(other.lock_)) {}

ScratchFolder::~ScratchFolder() {
  if (!lock_.valid()) return;
  std::error_code ignored;
  // A run may have moved it, and put something else in its place.
  const fs::path now = fs::read_symlink(fmt::format("/proc/self/fd/{}", lock_.get()), ignored);
  if (!ignored) RemoveWhole(now);
  RemoveWhole(path_);
}

}  // namespace gauntlet::worker
