// Tables for other programs: rows of named columns, written one after the other as CSV or JSON.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "base/result.h"

namespace gauntlet {

struct Column {
  std::string name;  // stable: scripts rely on it
  std::string unit;  // "m", "s", "yes/no" for 0/1, "" for counts, ratios and words
  std::string meaning;
};

// What a row has in a column; the first: there is nothing to say, an empty field in CSV and null in JSON.
using Cell = std::variant<std::monostate, bool, std::uint64_t, std::int64_t, double, std::string>;
// A number, or nothing when it is not finite.
Cell NumberCell(double value);
// A text, or nothing when it is empty.
Cell TextCell(std::string text);

enum class TableFormat { kCsv, kJson };

// Where bytes go; not called any more after its first error.
using Sink = std::function<Status(std::string_view)>;

class DataTable {
 public:
  // CSV: a line of names, then a line for each row; texts are quoted where they have to be, truth values are
  // TRUE and FALSE. JSON: the object `head` (its text), continued by "columns", a list of objects with
  // name, unit and meaning, and by `rows`, a list of objects with the columns' names, a line each. Whole
  // numbers above 2^53 are texts in JSON. `rows` is the name of the list.
  DataTable(TableFormat format, std::vector<Column> columns, Sink sink, const std::string& head,
            const std::string& rows);

  // As many cells as there are columns. Error: the sink's; nothing may follow it.
  Status AddRow(const std::vector<Cell>& cells);
  // The end of the text. Error: the sink's.
  Status Finish();

  std::uint64_t rows() const { return rows_; }

 private:
  Status Flush();

  const TableFormat format_;
  const std::vector<Column> columns_;
  std::vector<std::string> keys_;  // of JSON: the names quoted, with a colon
  const Sink sink_;
  std::string waiting_;
  std::uint64_t rows_ = 0;
};

// A whole CSV of columns without units; a row has a cell for each of them.
std::string CsvText(const std::vector<std::string>& columns, const std::vector<std::vector<Cell>>& rows);

}  // namespace gauntlet
