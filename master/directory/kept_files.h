// Files that a campaign cannot be opened without, and that a master writes again when somebody deletes them.
#pragma once

#include <cstdint>
#include <mutex>
#include <string>
#include <vector>

#include "base/result.h"

namespace gauntlet {

// Remembers each file as it is, a change by its owner included. Thread-safe.
class KeptFiles {
 public:
  // Those that do not exist yet are taken in once they do.
  explicit KeptFiles(const std::vector<std::string>& paths);

  // Writes again, as it last was, what has been deleted since. Errors: kNoSpace, kIo.
  Status Restore();

 private:
  struct File {
    std::string path;
    std::string text;
    std::uint64_t inode = 0;   // 0: never seen
    std::int64_t changed = 0;  // ns since 1970
  };
  static Status Look(File& file);

  std::mutex mutex_;
  std::vector<File> files_;
};

}  // namespace gauntlet
