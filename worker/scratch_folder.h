// The working directory of one piece of work that may write what it likes.
#pragma once

#include <string>

#include "base/result.h"
#include "base/system/unique_fd.h"

namespace gauntlet::worker {

class ScratchFolder {
 public:
  // `named`: this folder, made when missing, which stays. "": a new one among the temporary files, which goes
  // with the object; what processes that were killed have left there goes too. Error: it cannot be made.
  static Result<ScratchFolder> Make(const std::string& named);
  ScratchFolder(ScratchFolder&& other) noexcept;
  ScratchFolder& operator=(ScratchFolder&&) = delete;
  ~ScratchFolder();

  const std::string& path() const { return path_; }

 private:
  ScratchFolder(std::string path, UniqueFd lock) : path_(std::move(path)), lock_(std::move(lock)) {}

  std::string path_;
  UniqueFd lock_;  // of a temporary one: held as long as somebody uses it
};

}  // namespace gauntlet::worker
