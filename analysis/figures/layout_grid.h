// Layouts of one arena in the cells of a grid over how a swarm breaks: what an archive search has found.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "sim/arena/test_case.h"

namespace gauntlet::analysis {

struct GridLayout {
  std::size_t column = 0;
  std::size_t row = 0;  // from the lowest
  std::string caption;  // "2 obstacles: 5 of 5"
  sim::Genome obstacles;
  std::optional<sim::Vec2> place;  // m, where it broke the swarm
};

struct LayoutGrid {
  std::string title;
  std::string outcome;               // what it comes to, in a sentence
  std::string across_name;           // metric of the columns
  std::string up_name;               // metric of the rows
  std::vector<std::string> columns;  // their ranges, ascending
  std::vector<std::string> rows;     // their ranges, ascending
  sim::TestCase arena;               // without obstacles
  std::vector<GridLayout> layouts;   // at most one a cell
};

// An SVG document; the second axis runs upwards.
std::string DrawLayoutGrid(const LayoutGrid& grid);

}  // namespace gauntlet::analysis
