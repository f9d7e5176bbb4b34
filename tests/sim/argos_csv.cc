#include "tests/sim/argos_csv.h"
#include "tests/support/paths.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>
#include <sstream>

namespace gauntlet::sim {

CsvTable ReadArgosCsv(const std::string& path) {
  std::ifstream file(std::string(GAUNTLET_SOURCE_DIR) + "/tests/golden/argos/" + path);
  CsvTable table;
  std::string line;
  while (std::getline(file, line)) {
    std::istringstream cells(line);
    std::string cell;
    const bool header = table.columns.empty();
    if (!header) table.rows.emplace_back();
    while (std::getline(cells, cell, ',')) {
      if (header) {
        table.columns.emplace(cell, table.columns.size());
      } else {
        table.rows.back().push_back(std::strtod(cell.c_str(), nullptr));
      }
    }
  }
  EXPECT_FALSE(table.rows.empty()) << path << " is missing or empty";
  return table;
}

}  // namespace gauntlet::sim
