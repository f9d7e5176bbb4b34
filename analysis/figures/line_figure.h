// Lines over a common horizontal axis, in panels one above the other.
#pragma once

#include <string>
#include <vector>

namespace gauntlet::analysis {

struct FigureLine {
  std::string name;              // stands beside the line's end
  std::vector<double> x = {};    // ascending
  std::vector<double> y = {};    // as many; NaN leaves a gap
  std::vector<double> low = {};  // of a band around it, as many again; empty = no band
  std::vector<double> high = {};
};

struct LinePanel {
  std::string axis_name;  // with its unit
  std::vector<FigureLine> lines;
  // The axis at least covers this range; equal = what the lines need.
  double least = 0.0;
  double most = 0.0;
};

struct LineFigure {
  std::string title;
  std::string outcome;  // one line below it
  std::string x_name;   // with its unit
  std::vector<LinePanel> panels;
};

// An SVG document. Lines without a single finite value are left out.
std::string DrawLines(const LineFigure& figure);

}  // namespace gauntlet::analysis
