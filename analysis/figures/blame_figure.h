// A test case with what its obstacles contribute to its failures, and where robots got stuck.
#pragma once

#include <string>
#include <vector>

#include "sim/arena/test_case.h"

namespace gauntlet::analysis {

struct BlameFigure {
  std::string title;
  std::vector<std::string> sentences;  // below it, a line each
  sim::TestCase test_case;
  std::vector<double> effects;     // of each obstacle, 1 = it alone makes the case fail; below 0 counts as 0
  std::vector<sim::Vec2> stuck;    // m: places, drawn as a heat map
  std::vector<std::string> lines;  // beside the arena
};

// An SVG document.
std::string DrawBlame(const BlameFigure& figure);

}  // namespace gauntlet::analysis
