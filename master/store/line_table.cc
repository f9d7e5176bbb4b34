#include "master/store/line_table.h"

#include <fmt/format.h>

#include <utility>

#include "master/store/checksums.h"

namespace gauntlet {
namespace {

constexpr std::string_view kColumns =
    "search, individual, coalesce(name, ''), content, first_run, runs, checksum";

std::uint64_t ChecksumOf(const StoredLine& line) {
  return RowChecksum(line.search, line.individual, line.name, line.content, line.first_run, line.runs);
}

Result<StoredLine> ReadLine(const SqliteStatement& row) {
  StoredLine line;
  std::uint64_t checksum = 0;
  row.Read(line.search, line.individual, line.name, line.content, line.first_run, line.runs, checksum);
  if (checksum == ChecksumOf(line)) return line;
  return Error{ErrorKind::kCorrupt,
               fmt::format("the campaign's database was changed or is damaged: the line of individual {} of "
                           "search {} was changed: its checksum differs",
                           line.individual, line.search)};
}

}  // namespace

Status LineTable::Insert(const StoredLine& line) {
  if (!insert_) {
    TRY(insert_, connection_->Prepare(
                     "INSERT INTO lines (search, individual, name, content, first_run, runs, checksum) "
                     "VALUES (?, ?, nullif(?, ''), ?, ?, ?, ?)"));
  }
  return insert_->Run(line.search, line.individual, line.name, line.content, line.first_run, line.runs,
                      ChecksumOf(line));
}

Result<std::vector<StoredLine>> LineTable::Load(SearchId search, IndividualId after) {
  TRY(SqliteStatement query,
      connection_->Prepare(fmt::format(
          "SELECT {} FROM lines WHERE search = ? AND individual > ? ORDER BY individual", kColumns)));
  query.Bind(search, after);
  std::vector<StoredLine> lines;
  TRY(query.ForEachRow([&]() -> Status {
    TRY(StoredLine line, ReadLine(query));
    lines.push_back(std::move(line));
    return Ok{};
  }));
  return lines;
}

Result<std::optional<StoredLine>> LineTable::Find(SearchId search, const std::string& name) {
  if (!find_) {
    TRY(find_,
        connection_->Prepare(fmt::format("SELECT {} FROM lines WHERE search = ? AND name = ?", kColumns)));
  }
  find_->Bind(search, name);
  const Result<bool> row = find_->Step();
  std::optional<Result<StoredLine>> line;
  if (row && *row) line = ReadLine(*find_);
  find_->Reset();
  if (!row) return row.error();
  if (!line) return std::optional<StoredLine>();
  if (!*line) return line->error();
  return std::optional(**std::move(line));
}

}  // namespace gauntlet
