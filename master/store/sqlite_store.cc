#include "master/store/sqlite_store.h"

#include <fmt/format.h>
#include <sys/eventfd.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

namespace gauntlet {

Result<std::unique_ptr<SqliteStore>> SqliteStore::Open(const std::string& path, Options options) {
  TRY(SqliteConnection connection, OpenCheckedForWriting(path, options.vfs, options.checkpoint_pages));
  TRY(std::unique_ptr<SqliteStore> store,
      Make(path, std::move(connection), std::move(options), Checked::kEverything));
  store->notifier_.Reset(eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK));
  if (!store->notifier_.valid()) {
    return Error{ErrorKind::kIo, fmt::format("{}: no eventfd: {}", path, std::strerror(errno))};
  }
  store->writer_ = std::thread([raw = store.get()] { raw->WriteLoop(); });
  return store;
}

Result<std::unique_ptr<SqliteStore>> SqliteStore::OpenReadOnly(const std::string& path, Checked what) {
  TRY(SqliteConnection connection, OpenCheckedForReading(path, what));
  return Make(path, std::move(connection), {}, what);
}

Result<std::unique_ptr<SqliteStore>> SqliteStore::OpenBesideMaster(const std::string& path, Checked what) {
  TRY(SqliteConnection connection, OpenCheckedBesideWriter(path, what));
  return Make(path, std::move(connection), {}, what);
}

Result<std::unique_ptr<SqliteStore>> SqliteStore::Make(const std::string& path, SqliteConnection connection,
                                                       Options options, Checked what) {
  std::unique_ptr<SqliteStore> store(new SqliteStore(path, std::move(connection), std::move(options)));
  Result<CampaignMeta> meta = ReadMeta(store->connection_);
  if (!meta) return store->WithPath(meta.error());
  store->meta_ = *std::move(meta);
  Result<SqliteTables> tables = SqliteTables::Open(store->connection_);
  if (!tables) return store->WithPath({ErrorKind::kCorrupt, tables.error().message});
  store->tables_.emplace(*std::move(tables));
  if (Status counted = store->tables_->CheckTotals(what); !counted) return store->WithPath(counted.error());
  return store;
}

SqliteStore::SqliteStore(std::string path, SqliteConnection connection, Options options)
    : path_(std::move(path)), options_(std::move(options)), connection_(std::move(connection)) {}

SqliteStore::~SqliteStore() {
  if (writer_.joinable()) {
    {
      const std::lock_guard lock(mutex_);
      closing_ = true;
    }
    records_waiting_.notify_one();
    writer_.join();
    // After a failure the files are left exactly as they are: they may belong to a newer master by now.
    const bool ours = !failure_ && (!options_.guard || options_.guard().ok());
    if (!ours) connection_.CheckpointOnClose(false);
  }
}

std::uint64_t SqliteStore::Commits() const {
  const std::lock_guard lock(mutex_);
  return commits_;
}

void SqliteStore::Add(Record record) {
  GAUNTLET_CHECK(writer_.joinable(), fmt::format("{} was opened for reading", path_));
  bool first = false;
  bool full = false;
  {
    std::unique_lock lock(mutex_);
    records_written_.wait(lock, [this] { return queued_records_ < kLargestQueue || failure_.has_value(); });
    if (failure_) return;  // never acknowledged; the caller learns of it from Committed()
    first = queue_.empty();
    if (first) due_ = std::chrono::steady_clock::now() + options_.longest_wait;
    if (first || queue_.back().runs == kLargestGroup) queue_.emplace_back();
    Group& last = queue_.back();
    if (std::holds_alternative<StoredRun>(record)) ++last.runs;
    last.records.push_back(std::move(record));
    full = ++queued_records_ == kLargestQueue || last.runs == kLargestGroup;
  }
  // The writer sleeps between: one wake-up for a group, not for every record.
  if (first || full) records_waiting_.notify_one();
}

void SqliteStore::WriteLoop() {
  Group group;
  while (TakeGroup(group)) {
    const Status written = WriteGroup(group);
    Report(group, written);
    Notify();
    if (!written) return;
  }
}

bool SqliteStore::TakeGroup(Group& group) {
  group = {};
  std::unique_lock lock(mutex_);
  records_waiting_.wait(lock, [this] { return !queue_.empty() || closing_; });
  if (queue_.empty()) return false;
  const auto ready = [this] {
    return queue_.front().runs == kLargestGroup || queued_records_ >= kLargestQueue || flushing_ || closing_;
  };
  while (!ready() && std::chrono::steady_clock::now() < due_) {
    const auto due = due_;  // CommitWithin may change it meanwhile
    records_waiting_.wait_until(lock, due);
  }
  group = std::move(queue_.front());
  queue_.pop_front();
  queued_records_ -= group.records.size();
  writing_ = true;
  return true;
}

Status SqliteStore::WriteGroup(const Group& group) {
  const LockedTables tables = Tables();
  Status status = tables->Begin();
  for (const Record& record : group.records) {
    if (!status) break;
    status = std::visit([&](const auto& concrete) { return tables->Insert(concrete); }, record);
  }
  if (status) status = tables->StoreTotals();
  if (status && options_.guard) {
    if (Status allowed = options_.guard(); !allowed) {
      tables->Rollback();
      return allowed;  // it speaks for itself; SQLite's errors need to be told where they come from
    }
  }
  if (status) status = tables->Commit();
  if (status) return status;
  tables->Rollback();
  return WithPath(status.error());
}

void SqliteStore::Report(const Group& group, const Status& written) {
  {
    const std::lock_guard lock(mutex_);
    writing_ = false;
    if (written) {
      ++commits_;
      for (const Record& record : group.records) {
        if (const auto* run = std::get_if<StoredRun>(&record)) committed_.push_back(run->id);
      }
    } else {
      failure_ = written.error();
      queue_.clear();
      queued_records_ = 0;
    }
  }
  records_written_.notify_all();
}

void SqliteStore::Notify() const {
  const std::uint64_t one = 1;
  // It can only fail when the counter is full, and then the descriptor is readable anyway.
  [[maybe_unused]] const ssize_t written = write(notifier_.get(), &one, sizeof one);
}

Result<std::vector<RunId>> SqliteStore::Committed() {
  if (notifier_.valid()) {
    std::uint64_t count = 0;
    [[maybe_unused]] const ssize_t size = read(notifier_.get(), &count, sizeof count);
  }
  std::vector<RunId> committed;
  {
    const std::lock_guard lock(mutex_);
    if (committed_.empty() && failure_) return *failure_;
    std::swap(committed, committed_);
    if (!failure_) return committed;
  }
  Notify();  // there is an error to fetch
  return committed;
}

Status SqliteStore::Flush() {
  std::unique_lock lock(mutex_);
  flushing_ = true;
  records_waiting_.notify_one();
  records_written_.wait(lock, [this] { return (queue_.empty() && !writing_) || failure_.has_value(); });
  flushing_ = false;
  if (failure_) return *failure_;
  return Ok{};
}

void SqliteStore::CommitWithin(std::chrono::milliseconds time) {
  {
    const std::lock_guard lock(mutex_);
    const auto due = std::chrono::steady_clock::now() + time;
    if (queue_.empty() || due >= due_) return;
    due_ = due;
  }
  records_waiting_.notify_one();
}

Error SqliteStore::WithPath(const Error& error) const {
  if (error.kind == ErrorKind::kNoSpace) {
    return {error.kind,
            fmt::format("the disk is full: {} cannot be written ({}); free some space and resume: "
                        "everything reported as done is stored",
                        path_, error.message)};
  }
  if (error.kind == ErrorKind::kCorrupt)
    return {error.kind, fmt::format("{} was changed or is damaged: {}", path_, error.message)};
  return {error.kind, fmt::format("{}: {}", path_, error.message)};
}

}  // namespace gauntlet
