// Small files that other processes read while we write them.
#pragma once

#include <sys/types.h>

#include <cstddef>
#include <string>
#include <string_view>

#include "base/result.h"
#include "base/system/unique_fd.h"

namespace gauntlet {

// Permissions of the files of a campaign.
inline constexpr mode_t kReadableByAll = 0644;
inline constexpr mode_t kOwnerOnly = 0600;

// Readers see the old content or the new one, also after a loss of power: temporary file in the same
// directory, fsync, rename, fsync of the directory. `mode`: permissions of the new file. Errors: kNoSpace,
// kIo; the old content then stands (only when nothing but the last fsync failed, the new one may).
Status WriteFileAtomically(const std::string& path, std::string_view bytes, mode_t mode);
// The same without fsync, for what is worthless after a loss of power: readers see the old or the new
// content.
Status ReplaceFile(const std::string& path, std::string_view bytes, mode_t mode);

// ReplaceFile for what is written piece by piece: readers see the old content until Finish.
class FileReplacement {
 public:
  static Result<FileReplacement> Begin(const std::string& path, mode_t mode);
  FileReplacement(FileReplacement&& other) noexcept;
  FileReplacement& operator=(FileReplacement&&) = delete;
  ~FileReplacement();  // the old content stands, unless Finish was called

  Status Write(std::string_view bytes);
  // Nothing but the destructor may be called afterwards, nor after an error.
  Status Finish(bool durable = false);

 private:
  FileReplacement(std::string path, std::string temporary, int fd);

  std::string path_;
  std::string temporary_;  // "" when nothing is left to remove
  UniqueFd fd_;
};

// The names in a directory survive a loss of power from now on.
Status SyncDirectory(const std::string& directory);

// A whole file of at most `limit` bytes, for what a user names: it may be a link or a pipe (for files of a
// campaign there is regular_file.h). Errors: kNotFound, kIo, kCorrupt when it is longer.
Result<std::string> ReadSmallFile(const std::string& path, std::size_t limit = 1 << 20);

// The same of a file or pipe that is open, from where it stands. `path` is for messages.
Result<std::string> ReadAll(int fd, const std::string& path, std::size_t limit);

// What an errno means, with the limit to raise where one was met.
std::string ErrnoText(int error_number);

// The error of a failed system call, by errno: kNoSpace when there was no room on the disk, in memory, in the
// table of processes or in that of open files; kNotFound; else kIo.
Error SystemError(const std::string& what, int error_number);

}  // namespace gauntlet
