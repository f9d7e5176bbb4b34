// The table of the lines that a stream of cases was asked by.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "base/result.h"
#include "master/store/result_store.h"
#include "master/store/sqlite_connection.h"

namespace gauntlet {

// Statements are prepared when they are needed: a campaign of an earlier version has no such table, and needs
// none. Not thread-safe; must not outlive its connection.
class LineTable {
 public:
  explicit LineTable(SqliteConnection& connection) : connection_(&connection) {}

  Status Insert(const StoredLine& line);
  Result<std::vector<StoredLine>> Load(SearchId search, IndividualId after);
  Result<std::optional<StoredLine>> Find(SearchId search, const std::string& name);

 private:
  SqliteConnection* connection_;
  std::optional<SqliteStatement> insert_;
  std::optional<SqliteStatement> find_;
};

}  // namespace gauntlet
