// The database file of a campaign: making one, and opening one without trusting it. The tables are described
// in master/store/README.md.
#pragma once

#include <cstdint>
#include <functional>
#include <string>

#include "base/result.h"
#include "master/store/result_store.h"
#include "master/store/sqlite_connection.h"

namespace gauntlet {

// What a campaign is told apart by; stored once, when it is made.
struct CampaignMeta {
  std::string campaign_id;       // 32 hex digits
  std::string software_version;  // of the gauntlet that made it
  std::string
      golden_hashes;  // of its controllers (proto/golden_hashes.h): what later builds are held against
  std::int64_t created_unix_ms = 0;

  bool operator==(const CampaignMeta&) const = default;
};

// The database's format. A file of another one is refused, never changed.
inline constexpr std::int64_t kStoreFormat = 3;
// "GNTL": tells a campaign.db from any other SQLite file.
inline constexpr std::int64_t kStoreApplicationId = 0x474E544C;

// Pages in the write-ahead log before they are moved into the database: 16 MB.
inline constexpr int kCheckpointPages = 2048;

// Makes a database with empty tables, or with what `fill` puts into the one that it is handed the path of. It
// appears under its name at once and whole, or not at all. kInUse when the file exists.
Status CreateDatabase(const std::string& path, const CampaignMeta& meta,
                      const std::function<Status(const std::string& draft)>& fill = nullptr);

// Opens a database for reading and checks it: kNotFound, kVersion (both formats are named) or kCorrupt.
// Neither the check nor the connection changes a byte of the campaign's directory. A write-ahead log left by
// a killed master is read. The caller sees to it that nobody writes meanwhile: no lock is taken.
Result<SqliteConnection> OpenCheckedForReading(const std::string& path, Checked what);

// Opens and checks a database that a process of this machine writes. What is read is what it had committed at
// this moment, as long as the connection lives; the writer does not wait for it. Errors: those of
// OpenCheckedForReading; kIo and kInUse also when the writer has just ended.
Result<SqliteConnection> OpenCheckedBesideWriter(const std::string& path, Checked what);

// Checks as OpenCheckedForReading does, then opens for writing: write-ahead log, every commit synchronised.
// Other processes of the machine may read meanwhile; only where the file system has no memory to share with
// them the database is locked against them. `vfs`: SqliteConnection::Open.
Result<SqliteConnection> OpenCheckedForWriting(const std::string& path, const std::string& vfs,
                                               int checkpoint_pages);

Result<CampaignMeta> ReadMeta(SqliteConnection& connection);

}  // namespace gauntlet
