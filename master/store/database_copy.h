// A copy of a database that this process writes, while it writes it.
#pragma once

#include <mutex>
#include <optional>
#include <string>

#include "base/result.h"
#include "master/store/sqlite_connection.h"

namespace gauntlet {

// Thread-safety: Make on one thread at a time, Cancel on any.
class DatabaseCopy {
 public:
  // `to` is replaced at once and whole, or not at all; `to`.new is the draft. What the writer had committed
  // when this began is in it. The writer does not wait, but its log grows meanwhile. Errors: kNoSpace, kIo,
  // kInUse when the writer lets nobody read; kInternal when it was cancelled.
  Status Make(const std::string& from, const std::string& to);
  // Makes a Make that is under way end soon, and later ones at once.
  void Cancel();

 private:
  Status CopyInto(const std::string& from, const std::string& draft);

  std::mutex mutex_;  // guards the two below
  bool cancelled_ = false;
  std::optional<SqliteConnection> connection_;
};

}  // namespace gauntlet
