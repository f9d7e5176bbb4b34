// One side of the grid in whose cells a search collects failures.
#pragma once

#include <string>

namespace gauntlet {

// The range of a metric, cut into equal parts; what lies outside belongs to the outermost ones.
struct CellAxis {
  std::string metric;
  double min = 0.0;
  double max = 0.0;
  int parts = 1;

  bool operator==(const CellAxis&) const = default;
};

}  // namespace gauntlet
