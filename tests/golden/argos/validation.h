// One line of the table that compares this simulator with what was measured in ARGoS.
#pragma once

#include <string>
#include <vector>

namespace gauntlet {

struct ValidationRow {
  std::string file;      // below tests/golden/argos
  std::string quantity;  // with its unit
  double tolerance = 0.0;
  double error = 0.0;  // the largest measured
  int values = 0;      // how many were compared
  int edges = 0;       // of them, how many were left out: within one step of the sweep of an edge
  bool ok() const { return values > 0 && error <= tolerance; }
};

}  // namespace gauntlet
