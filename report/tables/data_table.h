// Tables for other programs: rows of named columns, written one after the other as CSV or JSON.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "analysis/tables/cell.h"
#include "base/result.h"

namespace gauntlet {

struct DataColumn {
  std::string name;  // stable: scripts rely on it
  std::string unit;  // "m", "s", "yes/no" for 0/1, "" for counts, ratios and words
  std::string meaning;
};

enum class TableFormat { kCsv, kJson };

// Where bytes go; not called any more after its first error.
using Sink = std::function<Status(std::string_view)>;

class DataTable {
 public:
  // CSV: a line of names, then a line for each row; texts are quoted where they have to be, truth values are
  // TRUE and FALSE. JSON: the object `head` (its text), continued by "columns", a list of objects with
  // name, unit and meaning, and by `rows`, a list of objects with the columns' names, a line each. Whole
  // numbers above 2^53 are texts in JSON. `rows` is the name of the list.
  DataTable(TableFormat format, std::vector<DataColumn> columns, Sink sink, const std::string& head,
            const std::string& rows);

  // As many cells as there are columns. Error: the sink's; nothing may follow it.
  Status AddRow(const std::vector<Value>& cells);
  // The end of the text. Error: the sink's.
  Status Finish();

  std::uint64_t rows() const { return rows_; }

 private:
  Status Flush();

  const TableFormat format_;
  const std::vector<DataColumn> columns_;
  std::vector<std::string> keys_;  // of JSON: the names quoted, with a colon
  const Sink sink_;
  std::string waiting_;
  std::uint64_t rows_ = 0;
};

}  // namespace gauntlet
