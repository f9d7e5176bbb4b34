#include "master/store/sqlite_schema.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <string_view>
#include <utility>
#include <vector>

#include "base/system/atomic_file.h"
#include "base/system/regular_file.h"

namespace gauntlet {
namespace {

constexpr int kPageSize = 8192;
// What a connection waits for another process's lock, which none holds for longer than a moment.
constexpr int kBusyMilliseconds = 10000;
// Of the write-ahead log, between readers that make it longer.
constexpr int kLogBytes = 64 << 20;

constexpr std::string_view kMagic("SQLite format 3\0", 16);
constexpr std::size_t kHeaderSize = 100;
// What SQLite opens or makes beside a database of this name.
constexpr std::array kBesideTheDatabase = {"-wal", "-shm", "-journal"};

constexpr const char* kTables = R"sql(
CREATE TABLE meta (
  key   TEXT PRIMARY KEY,
  value TEXT NOT NULL
) STRICT;
CREATE TABLE searches (
  id        INTEGER PRIMARY KEY,
  name      TEXT NOT NULL,
  algorithm TEXT NOT NULL,
  seed      INTEGER NOT NULL
) STRICT;
CREATE TABLE finished (
  search   INTEGER NOT NULL REFERENCES searches (id),
  last_run INTEGER NOT NULL,
  PRIMARY KEY (search, last_run)
) STRICT, WITHOUT ROWID;
CREATE TABLE individuals (
  search           INTEGER NOT NULL REFERENCES searches (id),
  id               INTEGER NOT NULL,
  birth_generation INTEGER NOT NULL,
  parents          BLOB NOT NULL,
  test_case        BLOB NOT NULL,
  checksum         INTEGER NOT NULL,
  PRIMARY KEY (search, id)
) STRICT, WITHOUT ROWID;
CREATE TABLE lines (
  search     INTEGER NOT NULL REFERENCES searches (id),
  individual INTEGER NOT NULL,
  name       TEXT,
  content    TEXT NOT NULL,
  first_run  INTEGER NOT NULL,
  runs       INTEGER NOT NULL,
  checksum   INTEGER NOT NULL,
  PRIMARY KEY (search, individual),
  UNIQUE (search, name)
) STRICT, WITHOUT ROWID;
CREATE TABLE runs (
  id            INTEGER PRIMARY KEY,
  search        INTEGER NOT NULL REFERENCES searches (id),
  individual    INTEGER NOT NULL,
  evaluation    INTEGER NOT NULL,
  replicate     INTEGER NOT NULL,
  generation    INTEGER NOT NULL,
  seed          INTEGER NOT NULL,
  verdict       INTEGER NOT NULL,
  fitness       REAL,
  fitness_bits  INTEGER NOT NULL,
  total_failure INTEGER NOT NULL,
  failure_type  INTEGER NOT NULL,
  message       TEXT NOT NULL,
  hash          INTEGER NOT NULL,
  spec_hash     INTEGER NOT NULL,
  worker        TEXT NOT NULL,
  attempt       INTEGER NOT NULL,
  record_hash   INTEGER NOT NULL,
  checksum      INTEGER NOT NULL
) STRICT;
CREATE TABLE records (
  run    INTEGER PRIMARY KEY,
  spec   BLOB NOT NULL,
  result BLOB NOT NULL
) STRICT;
CREATE TABLE examples (
  kind     TEXT PRIMARY KEY,
  bytes    BLOB NOT NULL,
  checksum INTEGER NOT NULL
) STRICT, WITHOUT ROWID;
CREATE TABLE states (
  search         INTEGER NOT NULL REFERENCES searches (id),
  last_run       INTEGER NOT NULL,
  generation     INTEGER NOT NULL,
  state          BLOB NOT NULL,
  results_digest BLOB NOT NULL,
  checksum       INTEGER NOT NULL,
  UNIQUE (search, last_run)
) STRICT;
CREATE TABLE events (
  id      INTEGER PRIMARY KEY,
  unix_ms INTEGER NOT NULL,
  kind    TEXT NOT NULL,
  text    TEXT NOT NULL
) STRICT;
CREATE TABLE totals (
  search         INTEGER PRIMARY KEY,
  runs           INTEGER NOT NULL,
  runs_failed    INTEGER NOT NULL,
  total_failures INTEGER NOT NULL,
  individuals    INTEGER NOT NULL,
  states         INTEGER NOT NULL,
  finished       INTEGER NOT NULL,
  events         INTEGER NOT NULL,
  examples       INTEGER NOT NULL,
  checksum       INTEGER NOT NULL
) STRICT;
)sql";

constexpr std::array kTableNames = {"meta", "searches", "finished", "individuals", "lines",
                                    "runs", "records",  "examples", "states",      "events"};

// What was stored is never rewritten, not even by a defect of ours. (The totals are, with every commit.)
std::string InsertOnlyTriggers() {
  std::string sql;
  for (const char* table : kTableNames) {
    for (const char* action : {"UPDATE", "DELETE"}) {
      sql += fmt::format(
          "CREATE TRIGGER {0}_no_{1} BEFORE {1} ON {0} BEGIN SELECT RAISE(ABORT, '{0}: stored rows are never "
          "changed'); END;\n",
          table, action);
    }
  }
  return sql;
}

Error WithPath(const std::string& path, const Error& error) {
  if (error.kind == ErrorKind::kCorrupt) {
    return {error.kind, fmt::format("{} is damaged ({}); it was left as it is", path, error.message)};
  }
  if (error.kind == ErrorKind::kInUse) {
    return {error.kind, fmt::format("{} is held open by another process ({})", path, error.message)};
  }
  return {error.kind, fmt::format("{}: {}", path, error.message)};
}

template <typename T>
Result<T> WithPath(const std::string& path, Result<T> result) {
  if (!result) return WithPath(path, result.error());
  return result;
}

// SQLite takes an empty or missing file for a new database, and would wait for the other end of a named pipe;
// here neither is a database.
Status CheckHeader(const std::string& path) {
  TRY(const UniqueFd file, OpenRegularFile(path, O_RDONLY));
  for (const char* beside : kBesideTheDatabase) {
    TRY(CheckRegularFile(path + beside));
  }
  std::array<char, kHeaderSize> header{};
  const ssize_t size = pread(file.get(), header.data(), header.size(), 0);
  if (size != static_cast<ssize_t>(header.size()) ||
      std::string_view(header.data(), kMagic.size()) != kMagic) {
    return Error{
        ErrorKind::kCorrupt,
        fmt::format("{} is damaged (it does not begin like a database); it was left as it is", path)};
  }
  return Ok{};
}

// Formats in one sentence: kVersion for a newer one.
Status CheckFormat(SqliteConnection& connection, const std::string& path) {
  TRY(const std::int64_t application, WithPath(path, connection.QueryInt("PRAGMA application_id")));
  if (application != kStoreApplicationId) {
    return Error{ErrorKind::kInvalidInput,
                 fmt::format("{} is a database, but not a campaign's (application id {:#x} instead of {:#x})",
                             path, application, kStoreApplicationId)};
  }
  TRY(const std::int64_t format, WithPath(path, connection.QueryInt("PRAGMA user_version")));
  if (format > kStoreFormat) {
    return Error{
        ErrorKind::kVersion,
        fmt::format("{} has format {}, made by a newer gauntlet; this one reads format {}: use the newer "
                    "version (nothing was changed)",
                    path, format, kStoreFormat)};
  }
  if (format < 1) {
    return Error{ErrorKind::kCorrupt,
                 fmt::format("{} is damaged (format {} never existed); it was left as it is", path, format)};
  }
  if (format < kStoreFormat) {
    return Error{ErrorKind::kVersion,
                 fmt::format("{} has format {}, made by an older gauntlet; this one reads format {}: use the "
                             "older version (nothing was changed)",
                             path, format, kStoreFormat)};
  }
  return Ok{};
}

Status CheckIntegrity(SqliteConnection& connection, const std::string& of) {
  TRY(SqliteStatement check, connection.Prepare(fmt::format("PRAGMA integrity_check({})", of)));
  TRY(bool row, check.Step());
  std::string answer = "no answer";
  if (row) check.Read(answer);
  if (answer != "ok") return Error{ErrorKind::kCorrupt, answer};
  return Ok{};
}

// Pages, the order of rows, types, and that every index holds every row.
Status CheckPages(SqliteConnection& connection, const std::string& path, Checked what) {
  if (what == Checked::kEverything) return WithPath(path, CheckIntegrity(connection, "1"));
  std::vector<std::string> tables = {"meta", "searches", "finished", "totals"};
  if (what == Checked::kRows)
    tables.insert(tables.end(), {"individuals", "runs", "states", "events", "examples"});
  for (const std::string& table : tables) {
    TRY(WithPath(path, CheckIntegrity(connection, table)));
  }
  return Ok{};
}

// The rows of the table meta.
template <typename Meta, typename Text>
std::array<std::pair<std::string_view, Text*>, 4> FieldsOf(Meta& meta, Text& created_unix_ms) {
  return {{{"campaign_id", &meta.campaign_id},
           {"software_version", &meta.software_version},
           {"golden_hashes", &meta.golden_hashes},
           {"created_unix_ms", &created_unix_ms}}};
}

Status FillDatabase(const std::string& path, const CampaignMeta& meta) {
  TRY(SqliteConnection connection,
      SqliteConnection::Open(SqliteUri(path, ""), SqliteConnection::Mode::kCreate));
  const std::string sql = fmt::format(
      "PRAGMA page_size = {}; PRAGMA locking_mode = EXCLUSIVE; PRAGMA synchronous = FULL; PRAGMA "
      "journal_mode = WAL;"
      "BEGIN; PRAGMA application_id = {}; PRAGMA user_version = {};\n{}{}",
      kPageSize, kStoreApplicationId, kStoreFormat, kTables, InsertOnlyTriggers());
  TRY(connection.Execute(sql));
  TRY(SqliteStatement insert, connection.Prepare("INSERT INTO meta (key, value) VALUES (?, ?)"));
  const std::string created = std::to_string(meta.created_unix_ms);
  for (const auto& [key, value] : FieldsOf(meta, created)) {
    TRY(insert.Run(key, *value));
  }
  // The checkpoint, unlike the one that closing would do, reports its errors; it ends with a synchronised
  // database.
  TRY(connection.Execute("COMMIT"));
  TRY(connection.QueryInt("PRAGMA wal_checkpoint(TRUNCATE)"));
  return Ok{};
}

void RemoveDatabase(const std::string& path) {
  unlink(path.c_str());
  for (const char* beside : kBesideTheDatabase) unlink((path + beside).c_str());
}

}  // namespace

Status CreateDatabase(const std::string& path, const CampaignMeta& meta,
                      const std::function<Status(const std::string& draft)>& fill) {
  if (access(path.c_str(), F_OK) == 0)
    return Error{ErrorKind::kInUse, fmt::format("{} exists already", path)};
  const std::string draft = path + ".new";
  RemoveDatabase(draft);  // of a master that was killed here
  Status filled = WithPath(draft, FillDatabase(draft, meta));
  if (filled && fill) filled = fill(draft);
  // What is still in the log would be left behind.
  struct stat log {};
  if (filled && stat((draft + "-wal").c_str(), &log) == 0 && log.st_size > 0)
    filled = Error{ErrorKind::kIo, fmt::format("{} could not be written as a whole", draft)};
  if (!filled) {
    RemoveDatabase(draft);
    return filled;
  }
  if (std::rename(draft.c_str(), path.c_str()) != 0) {
    const Error error = SystemError(fmt::format("cannot create {}", path), errno);
    RemoveDatabase(draft);
    return error;
  }
  return SyncDirectory(std::filesystem::absolute(path).parent_path());
}

Result<SqliteConnection> OpenCheckedForReading(const std::string& path, Checked what) {
  TRY(CheckHeader(path));
  // Without a log the file alone is the database, and "immutable" keeps SQLite from creating one. With a log,
  // exclusive mode keeps the log's index in memory; the VFS without locks allows it on a file that is only
  // read.
  struct stat log {};
  const bool has_log = stat((path + "-wal").c_str(), &log) == 0 && log.st_size > 0;
  TRY(SqliteConnection opened,
      WithPath(path, SqliteConnection::Open(SqliteUri(path, has_log ? "" : "immutable=1"),
                                            SqliteConnection::Mode::kReadOnly, has_log ? "unix-none" : "")));
  opened.CheckpointOnClose(false);
  TRY(WithPath(path, opened.Execute("PRAGMA locking_mode = EXCLUSIVE; PRAGMA query_only = ON")));
  TRY(CheckFormat(opened, path));
  TRY(CheckPages(opened, path, what));
  return opened;
}

Result<SqliteConnection> OpenCheckedBesideWriter(const std::string& path, Checked what) {
  TRY(SqliteConnection opened,
      WithPath(path, SqliteConnection::Open(SqliteUri(path, ""), SqliteConnection::Mode::kReadOnly)));
  opened.CheckpointOnClose(false);
  const std::string sql =
      fmt::format("PRAGMA busy_timeout = {}; PRAGMA query_only = ON; BEGIN", kBusyMilliseconds);
  TRY(WithPath(path, opened.Execute(sql)));
  TRY(CheckFormat(opened, path));
  TRY(CheckPages(opened, path, what));
  return opened;
}

Result<SqliteConnection> OpenCheckedForWriting(const std::string& path, const std::string& vfs,
                                               int checkpoint_pages) {
  {
    // Ends with these braces: nobody writes while it holds the file.
    TRY(OpenCheckedForReading(path, Checked::kEverything));
  }
  TRY(SqliteConnection opened,
      WithPath(path, SqliteConnection::Open(SqliteUri(path, ""), SqliteConnection::Mode::kReadWrite, vfs)));
  // cache_spill: before a commit nothing reaches the file, so that a commit that is refused leaves no trace.
  // recursive_triggers: without it INSERT OR REPLACE would delete a row behind the triggers' back.
  // journal_size_limit: a reader that took long lets the log grow; afterwards it shrinks again.
  const auto begin = [&](const char* locking_mode) {
    return opened.Execute(fmt::format(
        "PRAGMA locking_mode = {}; PRAGMA busy_timeout = {}; PRAGMA journal_mode = WAL; PRAGMA synchronous = "
        "FULL;"
        "PRAGMA foreign_keys = ON; PRAGMA recursive_triggers = ON; PRAGMA cache_spill = OFF;"
        "PRAGMA temp_store = MEMORY; PRAGMA wal_autocheckpoint = {}; PRAGMA journal_size_limit = {};"
        "BEGIN IMMEDIATE; COMMIT",
        locking_mode, kBusyMilliseconds, checkpoint_pages, kLogBytes));
  };
  Status set = begin("NORMAL");
  if (!set && set.error().kind == ErrorKind::kIo) set = begin("EXCLUSIVE");  // there is no memory to share
  TRY(WithPath(path, std::move(set)));
  TRY(CheckFormat(opened, path));
  return opened;
}

Result<CampaignMeta> ReadMeta(SqliteConnection& connection) {
  TRY(SqliteStatement query, connection.Prepare("SELECT value FROM meta WHERE key = ?"));
  CampaignMeta meta;
  std::string created;
  for (const auto& [key, field] : FieldsOf(meta, created)) {
    query.Bind(key);
    TRY(bool row, query.Step());
    if (!row) return Error{ErrorKind::kCorrupt, fmt::format("the table meta has no {}", key)};
    query.Read(*field);
    query.Reset();
  }
  meta.created_unix_ms = std::strtoll(created.c_str(), nullptr, 10);
  return meta;
}

}  // namespace gauntlet
