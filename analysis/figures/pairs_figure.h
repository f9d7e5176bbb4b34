// Several quantities against each other: how each of them is spread, and every two of them as points.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace gauntlet::analysis {

struct PairsAxis {
  std::string name;
  std::string low;   // what stands at its beginning
  std::string high;  // and at its end
};

struct PairsFigure {
  std::string title;
  std::string outcome;  // one line below it
  std::vector<PairsAxis> axes;
  // Each with a number from 0 (its beginning) to 1 (its end) for every axis.
  std::vector<std::vector<double>> points;
  std::vector<double> chosen;  // a point that is marked; empty = none
};

// An SVG document: a square for every two axes, histograms where an axis meets itself.
std::string DrawPairs(const PairsFigure& figure);

}  // namespace gauntlet::analysis
