#include "study/sets/csv_column.h"

#include <algorithm>
#include <cmath>
#include <string_view>

#include <fmt/format.h>

#include "base/nearest_name.h"
#include "base/parse_number.h"
#include "base/printable.h"
#include "base/system/regular_file.h"

namespace gauntlet {
namespace {

constexpr std::size_t kLargestFile = 256U << 20;

// A quote inside a quoted cell is written twice (RFC 4180).
std::vector<std::string> CellsOf(std::string_view line) {
  std::vector<std::string> cells(1);
  bool quoted = false;
  for (std::size_t i = 0; i < line.size(); ++i) {
    if (line[i] == '"' && quoted && i + 1 < line.size() && line[i + 1] == '"') {
      cells.back() += line[i++];
    } else if (line[i] == '"') {
      quoted = !quoted;
    } else if (line[i] == ',' && !quoted) {
      cells.emplace_back();
    } else {
      cells.back() += line[i];
    }
  }
  return cells;
}

}  // namespace

Result<std::vector<CsvLine>> ReadCsvLines(std::string_view text, const std::string& path) {
  constexpr std::string_view kByteOrderMark = "\xef\xbb\xbf";
  if (text.starts_with(kByteOrderMark)) text.remove_prefix(kByteOrderMark.size());
  std::vector<CsvLine> lines;
  for (std::size_t number = 1; !text.empty(); ++number) {
    std::string_view line = text.substr(0, text.find('\n'));
    text.remove_prefix(std::min(text.size(), line.size() + 1));
    if (line.ends_with('\r')) line.remove_suffix(1);
    if (line.empty()) continue;
    lines.push_back({number, CellsOf(line)});
    const std::size_t columns = lines.front().cells.size();
    if (lines.back().cells.size() == columns) continue;
    return InvalidInput(fmt::format("{}:{}: {} cells, but {} columns have a name", path, number,
                                    lines.back().cells.size(), columns));
  }
  if (lines.empty()) return InvalidInput(path + " is empty: its first line has to name the columns");
  return lines;
}

Result<CsvColumn> ReadCsvColumn(const std::string& path, const std::string& column) {
  TRY(const auto text, ReadRegularFile(path, kLargestFile));
  TRY(const auto lines, ReadCsvLines(text, path));
  std::vector<std::string> columns;
  for (const std::string& cell : lines.front().cells) columns.push_back(Printable(cell));
  const auto found = std::ranges::find(lines.front().cells, column);
  if (found == lines.front().cells.end()) {
    return InvalidInput(fmt::format("{}: {}", path, UnknownName("column", Printable(column), columns)));
  }
  if (std::ranges::count(lines.front().cells, column) > 1)
    return InvalidInput(fmt::format("{}: column {} is there more than once", path, Printable(column)));
  const auto wanted = static_cast<std::size_t>(found - lines.front().cells.begin());
  CsvColumn read;
  for (std::size_t i = 1; i < lines.size(); ++i) {
    const CsvLine& line = lines[i];
    if (line.cells[wanted].empty()) {
      ++read.empty_cells;
      continue;
    }
    const auto value = ParseNumber<double>(line.cells[wanted]);
    if (!value || !std::isfinite(*value)) {
      return InvalidInput(fmt::format("{}:{}: {} is '{}', not a finite number", path, line.number, column,
                                      Printable(line.cells[wanted])));
    }
    read.values.push_back(*value);
  }
  return read;
}

}  // namespace gauntlet
