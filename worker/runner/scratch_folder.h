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
  // Removes those of the second kind whose process ended without doing so.
  static void RemoveAbandoned();
  ScratchFolder(ScratchFolder&& other) noexcept;
  ScratchFolder& operator=(ScratchFolder&&) = delete;
  ~ScratchFolder();

  const std::string& path() const { return path_; }
  // Whether it holds nothing but an empty file of this name, and is where it was made: as good as new.
  bool HoldsOnlyEmpty(const std::string& file) const;
  // In a process that was forked meanwhile: the folder is its parent's to use and to remove.
  void LeaveToParent() { lock_.Reset(); }

 private:
  ScratchFolder(std::string path, UniqueFd lock) : path_(std::move(path)), lock_(std::move(lock)) {}

  std::string path_;
  UniqueFd lock_;  // of a temporary one: held as long as somebody uses it
};

}  // namespace gauntlet::worker
