// Layouts of one arena side by side: how a case lost its obstacles.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "sim/arena/test_case.h"

namespace gauntlet::analysis {

struct LayoutPicture {
  std::string heading;            // "without obstacle 3"
  std::string outcome;            // "fails in 10 of 10 runs"
  sim::Genome obstacles;          // that are there
  std::vector<std::size_t> kept;  // which of the case's they are, from 0
};

struct LayoutStrip {
  std::string title;
  sim::TestCase original;               // its obstacles stand faintly behind every picture
  std::vector<LayoutPicture> pictures;  // at least one
  std::vector<sim::Vec2> places;        // m, of failures, drawn in the last picture
};

// An SVG document, in rows of at most four pictures.
std::string DrawLayoutStrip(const LayoutStrip& strip);

}  // namespace gauntlet::analysis
