// Files in directories that others may have filled: what is opened is a regular file of that very name, never
// what a link leads to, and never something that lets the opener wait (a named pipe) or acts (a device).
#pragma once

#include <sys/types.h>

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>

#include "base/result.h"
#include "base/system/unique_fd.h"

namespace gauntlet {

// open(2) without following a link in the path's last place; `mode` counts when O_CREAT makes the file.
// Errors: kInvalidInput names what stands there when it is no regular file; kNotFound, kIo, kNoSpace.
Result<UniqueFd> OpenRegularFile(const std::string& path, int flags, mode_t mode = 0);

// A whole file of at most `limit` bytes, opened so. Errors: those of OpenRegularFile; kCorrupt when it is
// longer.
Result<std::string> ReadRegularFile(const std::string& path, std::size_t limit = 1 << 20);

// kInvalidInput when something else than a regular file has this name; nothing having it is well.
Status CheckRegularFile(const std::string& path);

// Makes a directory in which neither the group nor others may write, unless there is one. kInvalidInput when
// something else has its name, a link to a directory too.
Status MakeDirectory(const std::string& path);

// Which file a name stands for.
struct FileId {
  std::uint64_t device = 0;
  std::uint64_t inode = 0;
  bool operator==(const FileId&) const = default;
};
// Of the file, the directory or the link that has this name; nothing when none has it. Errors: kIo.
Result<std::optional<FileId>> IdentifyFile(const std::string& path);

}  // namespace gauntlet
