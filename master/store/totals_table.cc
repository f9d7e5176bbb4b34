#include "master/store/totals_table.h"

#include <fmt/format.h>

#include <functional>
#include <utility>

#include "master/store/checksums.h"

namespace gauntlet {
namespace {

std::uint64_t ChecksumOf(SearchId search, const Totals& totals) {
  return RowChecksum(search, totals.runs, totals.runs_failed, totals.total_failures, totals.individuals,
                     totals.states, totals.finished, totals.events, totals.examples);
}

struct CountedTable {
  const char* name;
  Checked from;  // the least of Checked that looks at it
  std::uint64_t (*rows)(const std::pair<const SearchId, Totals>&);
};

using Entry = std::pair<const SearchId, Totals>;
constexpr CountedTable kCounted[] = {
    {"searches", Checked::kTotals, [](const Entry& e) -> std::uint64_t { return e.first > 0 ? 1 : 0; }},
    {"finished", Checked::kTotals, [](const Entry& e) { return e.second.finished; }},
    {"individuals", Checked::kRows, [](const Entry& e) { return e.second.individuals; }},
    {"runs", Checked::kRows, [](const Entry& e) { return e.second.runs; }},
    {"states", Checked::kRows, [](const Entry& e) { return e.second.states; }},
    {"events", Checked::kRows, [](const Entry& e) { return e.second.events; }},
    {"examples", Checked::kRows, [](const Entry& e) { return e.second.examples; }},
    {"records", Checked::kEverything, [](const Entry& e) { return e.second.runs; }},
};

}  // namespace

Result<TotalsTable> TotalsTable::Open(SqliteConnection& connection) {
  TotalsTable table(connection);
  TRY(SqliteStatement query, connection.Prepare("SELECT search, runs, runs_failed, total_failures, "
                                                "individuals, states, finished, events, examples, "
                                                "checksum FROM totals"));
  TRY(query.ForEachRow([&]() -> Status {
    Totals totals;
    std::uint64_t checksum = 0;
    query.Read(totals.search, totals.runs, totals.runs_failed, totals.total_failures, totals.individuals,
               totals.states, totals.finished, totals.events, totals.examples, checksum);
    if (checksum == ChecksumOf(totals.search, totals)) {
      table.totals_[totals.search] = totals;
      return Ok{};
    }
    return Error{ErrorKind::kCorrupt,
                 fmt::format("the totals of search {} were changed: their checksum differs", totals.search)};
  }));
  TRY(table.replace_,
      connection.Prepare(
          "INSERT INTO totals (search, runs, runs_failed, total_failures, individuals, states, finished, "
          "events, "
          "examples, checksum) VALUES (?, ?, ?, ?, ?, ?, ?, ?, ?, ?) ON CONFLICT DO UPDATE SET runs = "
          "excluded.runs, runs_failed = excluded.runs_failed, total_failures = excluded.total_failures, "
          "individuals = excluded.individuals, states = excluded.states, finished = excluded.finished, "
          "events = excluded.events, examples = excluded.examples, checksum = excluded.checksum"));
  return table;
}

Status TotalsTable::Store() {
  for (const SearchId search : std::exchange(changed_, {})) {
    const Totals& totals = totals_[search];
    TRY(replace_.Run(search, totals.runs, totals.runs_failed, totals.total_failures, totals.individuals,
                     totals.states, totals.finished, totals.events, totals.examples,
                     ChecksumOf(search, totals)));
  }
  return Ok{};
}

Status TotalsTable::Check(Checked what) const {
  for (const CountedTable& table : kCounted) {
    if (table.from > what) continue;
    std::uint64_t stored = 0;
    for (const Entry& entry : totals_) stored += table.rows(entry);
    TRY(const std::int64_t found, connection_->QueryInt(fmt::format("SELECT count(*) FROM {}", table.name)));
    if (static_cast<std::uint64_t>(found) == stored) continue;
    return Error{ErrorKind::kCorrupt,
                 fmt::format("the table {} holds {} rows instead of the {} that were stored", table.name,
                             found, stored)};
  }
  return Ok{};
}

}  // namespace gauntlet
