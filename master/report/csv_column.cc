#include "master/report/csv_column.h"

#include <algorithm>
#include <cmath>
#include <string_view>

#include <fmt/format.h>

#include "base/nearest_name.h"
#include "base/parse_number.h"
#include "base/printable.h"
#include "base/system/regular_file.h"

namespace gauntlet::master {
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

struct Column {
  std::string name;
};

}  // namespace

Result<std::vector<double>> ReadCsvColumn(const std::string& path, const std::string& column) {
  const Result<std::string> text = ReadRegularFile(path, kLargestFile);
  if (!text) return text.error();
  std::string_view rest = *text;
  constexpr std::string_view kByteOrderMark = "\xef\xbb\xbf";
  if (rest.starts_with(kByteOrderMark)) rest.remove_prefix(kByteOrderMark.size());

  std::vector<double> values;
  std::vector<Column> columns;
  std::size_t wanted = 0;
  for (std::size_t number = 1; !rest.empty(); ++number) {
    std::string_view line = rest.substr(0, rest.find('\n'));
    rest.remove_prefix(std::min(rest.size(), line.size() + 1));
    if (line.ends_with('\r')) line.remove_suffix(1);
    if (line.empty()) continue;
    const std::vector<std::string> cells = CellsOf(line);
    if (columns.empty()) {
      for (const std::string& cell : cells) columns.push_back({Printable(cell)});
      while (wanted < cells.size() && cells[wanted] != column) ++wanted;
      if (wanted < cells.size()) continue;
      return InvalidInput(fmt::format("{}: {}", path, UnknownName("column", Printable(column), columns)));
    }
    if (cells.size() != columns.size()) {
      return InvalidInput(fmt::format("{}:{}: {} cells, but {} columns have a name", path, number,
                                      cells.size(), columns.size()));
    }
    const auto value = ParseNumber<double>(cells[wanted]);
    if (!value || !std::isfinite(*value)) {
      return InvalidInput(fmt::format("{}:{}: {} is '{}', not a finite number", path, number, column,
                                      Printable(cells[wanted])));
    }
    values.push_back(*value);
  }
  if (columns.empty()) return InvalidInput(path + " is empty: its first line has to name the columns");
  return values;
}

}  // namespace gauntlet::master
