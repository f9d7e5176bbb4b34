// ResultStore on a SQLite database, campaign.db. A thread of its own commits in groups, so that leases and
// the search never wait for a disk.
#pragma once

#include <chrono>
#include <condition_variable>
#include <deque>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <utility>
#include <variant>
#include <vector>

#include "base/system/unique_fd.h"
#include "master/store/result_store.h"
#include "master/store/sqlite_connection.h"
#include "master/store/sqlite_schema.h"
#include "master/store/sqlite_tables.h"

namespace gauntlet {

// A commit begins kLongestWait after its first record was handed over, or earlier by Flush, CommitWithin or
// when kLargestGroup runs wait, which is as many as a group holds. One commit costs one fsync. When writing
// fails, or the guard answers with an error, nothing is committed any more, and every later Committed() and
// Flush() says so; what was durable stays durable and readable. Thread-safety: one calling thread, as for
// every ResultStore. The store must not be open twice.
class SqliteStore final : public ResultStore {
 public:
  static constexpr std::chrono::milliseconds kLongestWait{1000};
  static constexpr std::size_t kLargestGroup = 512;  // runs
  // Records that may wait for a commit; then adding blocks.
  static constexpr std::size_t kLargestQueue = 4096;

  struct Options {
    // Asked before every commit, on the store's thread; an error stops the store for good. The place of the
    // epoch check.
    std::function<Status()> guard;
    std::string vfs;  // SqliteConnection::Open
    int checkpoint_pages = kCheckpointPages;
    std::chrono::milliseconds longest_wait = kLongestWait;  // another one is for tests
  };

  // The file is made by CreateDatabase. Errors: those of OpenCheckedForWriting; the file is then left as it
  // was.
  static Result<std::unique_ptr<SqliteStore>> Open(const std::string& path, Options options);
  // For looking at a campaign that no master serves: no byte of it is changed, and adding anything is a
  // broken invariant. Errors: those of OpenCheckedForReading.
  static Result<std::unique_ptr<SqliteStore>> OpenReadOnly(const std::string& path,
                                                           Checked what = Checked::kEverything);

  // The same of a campaign that a master of this machine serves: what it had committed at this moment.
  // Errors: those of OpenCheckedBesideWriter.
  static Result<std::unique_ptr<SqliteStore>> OpenBesideMaster(const std::string& path, Checked what);

  SqliteStore(const SqliteStore&) = delete;
  SqliteStore& operator=(const SqliteStore&) = delete;
  // Commits what still waits, then closes.
  ~SqliteStore() override;

  const CampaignMeta& meta() const { return meta_; }
  // Transactions committed since it was opened.
  std::uint64_t Commits() const;

  void AddSearch(const StoredSearch& search) override { Add(search); }
  void AddIndividuals(SearchId search, const std::vector<Individual>& individuals) override {
    if (!individuals.empty()) Add(Newborns{search, individuals});
  }
  void AddLine(const StoredLine& line) override { Add(line); }
  void AddRun(StoredRun run) override { Add(std::move(run)); }
  void SaveState(const SavedState& state) override { Add(state); }
  void MarkFinished(SearchId search, RunId last_run) override { Add(Finished{search, last_run}); }
  void AddEvent(const StoredEvent& event) override { Add(event); }

  // After a failure, runs that became durable before it are still reported once; from then on the error.
  Result<std::vector<RunId>> Committed() override;
  Status Flush() override;
  void CommitWithin(std::chrono::milliseconds time) override;
  int CommitNotifier() const override { return notifier_.get(); }

  Result<std::vector<StoredSearch>> LoadSearches() override { return Tables()->LoadSearches(); }
  Result<std::vector<SearchTotals>> LoadTotals() override { return Tables()->LoadTotals(); }
  Result<std::vector<Individual>> LoadIndividuals(SearchId search, IndividualId after = 0) override {
    return Tables()->LoadIndividuals(search, after);
  }
  Result<std::vector<StoredLine>> LoadLines(SearchId search, IndividualId after) override {
    return Tables()->lines().Load(search, after);
  }
  Result<std::optional<StoredLine>> FindLine(SearchId search, const std::string& name) override {
    return Tables()->lines().Find(search, name);
  }
  Result<std::optional<SavedState>> LoadNewestState(SearchId search) override {
    return Tables()->LoadNewestState(search);
  }
  // `visit` must not call the store.
  Status ForEachRun(SearchId search, RunId after, const RunVisitor& visit) override {
    return Tables()->ForEachRun(search, after, visit);
  }
  Status ForEachRow(SearchId search, RunId after, const RunVisitor& visit) override {
    return Tables()->ForEachRow(search, after, visit);
  }
  Result<std::optional<StoredRun>> LoadRun(RunId run) override { return Tables()->LoadRun(run); }
  Result<std::vector<StoredEvent>> LoadEvents() override { return Tables()->LoadEvents(); }

 private:
  using Record =
      std::variant<StoredSearch, Newborns, StoredLine, StoredRun, SavedState, Finished, StoredEvent>;
  struct Group {
    std::vector<Record> records;
    std::size_t runs = 0;  // among them
  };

  // The tables and, as long as this lives, database_mutex_.
  struct LockedTables {
    std::unique_lock<std::mutex> lock;
    SqliteTables* tables;
    SqliteTables* operator->() const { return tables; }
  };

  SqliteStore(std::string path, SqliteConnection connection, Options options);
  static Result<std::unique_ptr<SqliteStore>> Make(const std::string& path, SqliteConnection connection,
                                                   Options options, Checked what);

  LockedTables Tables() { return {std::unique_lock(database_mutex_), &*tables_}; }
  void Add(Record record);
  void WriteLoop();
  // Waits for records; false when there are none and none will come.
  bool TakeGroup(Group& group);
  Status WriteGroup(const Group& group);
  void Report(const Group& group, const Status& written);
  void Notify() const;
  Error WithPath(const Error& error) const;

  const std::string path_;
  const Options options_;
  CampaignMeta meta_;

  // Guards connection_ and tables_; held for a whole transaction, so that readers see whole groups.
  std::mutex database_mutex_;
  SqliteConnection connection_;
  std::optional<SqliteTables> tables_;

  // Guards everything below.
  mutable std::mutex mutex_;
  std::condition_variable records_waiting_;
  std::condition_variable records_written_;
  std::deque<Group> queue_;  // each as large as a group may be, but for the last
  std::size_t queued_records_ = 0;
  bool writing_ = false;                            // a group has left the queue and is not committed yet
  bool flushing_ = false;                           // Flush waits
  std::chrono::steady_clock::time_point due_ = {};  // when what waits is committed at the latest
  bool closing_ = false;
  std::vector<RunId> committed_;
  std::optional<Error> failure_;
  std::uint64_t commits_ = 0;

  UniqueFd notifier_;  // eventfd
  std::thread writer_;
};

}  // namespace gauntlet
