// Box plots side by side.
#pragma once

#include <string>
#include <vector>

#include "analysis/statistics/sample.h"

namespace gauntlet::analysis {

struct NamedBox {
  std::string name;
  BoxPlot box;
  double mean = 0.0;
  std::size_t n = 0;
};

struct BoxFigure {
  std::string title;
  std::string outcome;          // one line below it
  std::string axis_name;        // with its unit
  std::vector<NamedBox> boxes;  // at least one, all by the same rule
};

// An SVG document: boxes with median, mean (a ring) and outliers; the rule stands below.
std::string DrawBoxes(const BoxFigure& figure);

}  // namespace gauntlet::analysis
