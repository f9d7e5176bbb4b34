// How much is stored: the table totals, renewed with every commit. What a lost page takes with it is missed
// by its count, and status reads the counts instead of the runs.
#pragma once

#include <cstdint>
#include <map>
#include <set>

#include "base/result.h"
#include "master/store/result_store.h"
#include "master/store/sqlite_connection.h"

namespace gauntlet {

// Rows of every table that belong to a search; of search 0 those that belong to none.
struct Totals : SearchTotals {
  std::uint64_t states = 0;
  std::uint64_t events = 0;    // of search 0
  std::uint64_t examples = 0;  // of search 0
};

// Not thread-safe; must not outlive its connection.
class TotalsTable {
 public:
  static constexpr SearchId kNoSearch = 0;

  // Reads the totals. Error: kCorrupt when a row's checksum differs.
  static Result<TotalsTable> Open(SqliteConnection& connection);

  // To be counted up; Store writes what was changed since.
  Totals& Of(SearchId search) {
    changed_.insert(search);
    return totals_[search];
  }
  Status Store();
  const std::map<SearchId, Totals>& all() const { return totals_; }

  // Error: kCorrupt, naming a table that holds another number of rows than was stored.
  Status Check(Checked what) const;

 private:
  explicit TotalsTable(SqliteConnection& connection) : connection_(&connection) {}

  SqliteConnection* connection_;
  SqliteStatement replace_;
  std::map<SearchId, Totals> totals_;
  std::set<SearchId> changed_;
};

}  // namespace gauntlet
