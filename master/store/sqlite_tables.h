// The rows of a campaign's database: writing and reading every kind of record.
#pragma once

#include <optional>
#include <string_view>
#include <utility>
#include <vector>

#include "base/result.h"
#include "master/store/line_table.h"
#include "master/store/packing.h"
#include "master/store/result_store.h"
#include "master/store/sqlite_connection.h"
#include "master/store/totals_table.h"

namespace gauntlet {

// Individuals of one search that were born together.
struct Newborns {
  SearchId search = 0;
  std::vector<Individual> individuals;
};
// A search that has come to its end.
struct Finished {
  SearchId search = 0;
  RunId last_run = 0;
};

// Inserting is idempotent where a resumed master repeats itself (individuals, states, finished): the very
// same record again is no change, another one under the same key is kCorrupt. A run or a search is stored
// once; a second time is kInternal. Not thread-safe; must not outlive its connection.
class SqliteTables {
 public:
  // `connection` must outlive the tables.
  static Result<SqliteTables> Open(SqliteConnection& connection);

  Status Begin() { return connection_->Execute("BEGIN IMMEDIATE"); }
  Status Commit() { return connection_->Execute("COMMIT"); }
  // Undoes what was inserted since Begin; without a transaction it does nothing.
  void Rollback();

  Status Insert(const StoredSearch& search);
  Status Insert(const Newborns& newborns);
  Status Insert(const StoredLine& line) { return lines_.Insert(line); }
  Status Insert(const StoredRun& run);
  Status Insert(const SavedState& state);
  Status Insert(const StoredEvent& event);
  Status Insert(const Finished& finished);
  // What the insertions since Begin have added, into the table totals; before Commit.
  Status StoreTotals() { return totals_.Store(); }

  // Error: kCorrupt, naming a table that has lost rows.
  Status CheckTotals(Checked what) const { return totals_.Check(what); }

  Result<std::vector<StoredSearch>> LoadSearches();
  Result<std::vector<SearchTotals>> LoadTotals();
  Result<std::vector<Individual>> LoadIndividuals(SearchId search, IndividualId after);
  LineTable& lines() { return lines_; }
  Result<std::optional<SavedState>> LoadNewestState(SearchId search);
  Status ForEachRun(SearchId search, RunId after, const RunVisitor& visit);
  Status ForEachRow(SearchId search, RunId after, const RunVisitor& visit);
  Result<std::optional<StoredRun>> LoadRun(RunId run);
  Result<std::vector<StoredEvent>> LoadEvents();

 private:
  SqliteTables(SqliteConnection& connection, TotalsTable totals)
      : connection_(&connection), totals_(std::move(totals)), lines_(connection) {}
  Status LoadExamples();
  // The first of its kind becomes what later ones are packed with.
  Status Learn(Packing& packing, const char* kind, std::string_view example);
  Result<StoredRun> ReadRun(const SqliteStatement& row, bool whole);
  Status ForEach(SearchId search, RunId after, bool whole, const RunVisitor& visit);

  Status Insert(SearchId search, const Individual& individual);
  // The newest state of `search` with last_run <= `until`.
  Result<std::optional<SavedState>> LoadState(SearchId search, RunId until);

  SqliteConnection* connection_;
  TotalsTable totals_;
  LineTable lines_;
  Packing specs_;
  Packing results_;
  SqliteStatement insert_search_;
  SqliteStatement insert_individual_;
  SqliteStatement insert_run_;
  SqliteStatement insert_record_;
  SqliteStatement insert_example_;
  SqliteStatement insert_state_;
  SqliteStatement insert_event_;
  SqliteStatement insert_finished_;
  SqliteStatement select_individual_;
};

}  // namespace gauntlet
