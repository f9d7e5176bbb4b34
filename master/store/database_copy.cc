#include "master/store/database_copy.h"

#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <utility>

#include "base/system/atomic_file.h"

namespace gauntlet {

Status DatabaseCopy::Make(const std::string& from, const std::string& to) {
  const std::string draft = to + ".new";
  const auto remove_draft = [&draft] {
    for (const char* suffix : {"", "-journal"}) unlink((draft + suffix).c_str());
  };
  remove_draft();  // of a master that was killed here
  Status copied = CopyInto(from, draft);
  if (copied && std::rename(draft.c_str(), to.c_str()) != 0)
    copied = SystemError(fmt::format("cannot replace {}", to), errno);
  if (!copied) remove_draft();
  return copied;
}

Status DatabaseCopy::CopyInto(const std::string& from, const std::string& draft) {
  {
    const std::lock_guard lock(mutex_);
    if (cancelled_) return Error{ErrorKind::kInternal, "the copy was cancelled"};
    TRY(SqliteConnection opened,
        SqliteConnection::Open(SqliteUri(from, ""), SqliteConnection::Mode::kReadOnly));
    connection_.emplace(std::move(opened));
  }
  connection_->CheckpointOnClose(false);
  const auto copy = [&]() -> Status {
    TRY(SqliteStatement vacuum, connection_->Prepare("VACUUM INTO ?"));
    return vacuum.Run(draft);
  };
  const Status copied = copy();
  const std::lock_guard lock(mutex_);
  connection_.reset();
  return copied;
}

void DatabaseCopy::Cancel() {
  const std::lock_guard lock(mutex_);
  cancelled_ = true;
  if (connection_) connection_->Interrupt();
}

}  // namespace gauntlet
