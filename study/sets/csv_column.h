// CSV files: a column of numbers, or everything.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "base/result.h"

namespace gauntlet {

struct CsvColumn {
  std::vector<double> values;
  std::size_t empty_cells = 0;  // left out: `export` writes such where there was nothing to measure
};
// The file's first line names its columns; cells may be quoted. Of at most 256 MB. Error: it cannot be read,
// has no such column, a line has another number of cells, or a cell that is wanted is neither empty nor a
// finite number; named with its line.
Result<CsvColumn> ReadCsvColumn(const std::string& path, const std::string& column);

struct CsvLine {
  std::size_t number = 0;  // in the file, from 1
  std::vector<std::string> cells;
};
// All lines but the empty ones of a text that stands in the file `path`. Error: as above, but for numbers.
Result<std::vector<CsvLine>> ReadCsvLines(std::string_view text, const std::string& path);

}  // namespace gauntlet
