// Pictures of Spartan's two analyses (analysis/statistics/parameter_analysis.h).
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "analysis/statistics/parameter_analysis.h"

namespace gauntlet::analysis {

// One value of a parameter.
struct RobustnessPoint {
  std::string value;
  std::string remark;        // at its right, e.g. its median
  bool is_baseline = false;  // compared with nothing
  double a = 0.5;
  std::optional<Interval> interval;
  bool exceeds = false;
};
struct RobustnessGroup {
  std::string parameter;
  std::vector<RobustnessPoint> points;
};
struct RobustnessFigure {
  std::string title;
  std::string outcome;  // one line below it
  std::string low;      // what A towards 0 means, e.g. "easier than the baseline"
  std::string high;     // what A towards 1 means
  std::vector<RobustnessGroup> groups;
};

// An SVG document: A of every value with its interval, a row each, over the thresholds.
std::string DrawRobustness(const RobustnessFigure& figure);

struct ConsistencyFigure {
  std::string title;
  std::string outcome;
  std::vector<Consistency> sizes;  // at least one, ascending
};

// An SVG document: the largest and the median A by the size of the sets, over the thresholds.
std::string DrawConsistency(const ConsistencyFigure& figure);

}  // namespace gauntlet::analysis
