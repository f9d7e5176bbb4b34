// Reads the CSV files of tests/golden/argos: a header line, then rows of numbers; a cell that is no number
// becomes 0.
#pragma once

#include <map>
#include <string>
#include <vector>

namespace gauntlet::sim {

struct CsvTable {
  std::map<std::string, std::size_t> columns;
  std::vector<std::vector<double>> rows;

  double At(std::size_t row, const std::string& column) const { return rows[row][columns.at(column)]; }
};

// `path` is relative to tests/golden/argos. Fails the test when the file is missing or empty.
CsvTable ReadArgosCsv(const std::string& path);

}  // namespace gauntlet::sim
