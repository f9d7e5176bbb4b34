// A column of numbers out of a CSV file.
#pragma once

#include <string>
#include <vector>

#include "base/result.h"

namespace gauntlet::master {

// The file's first line names its columns; cells may be quoted. Of at most 256 MB. Error: it cannot be read,
// has no such column, a line has another number of cells, or a cell that is wanted is no finite number; named
// with its line.
Result<std::vector<double>> ReadCsvColumn(const std::string& path, const std::string& column);

}  // namespace gauntlet::master
