// Counts in a table whose cells are the darker the more there is in them.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace gauntlet::analysis {

struct HeatCell {
  std::uint64_t count = 0;
  std::string meaning = "";  // in words
};

struct HeatMap {
  std::string title = "";
  std::string outcome = "";      // one line below it
  std::string across_name = "";  // of the columns
  std::string down_name = "";    // of the rows
  std::vector<std::string> columns = {};
  std::vector<std::string> rows = {};
  std::vector<std::vector<HeatCell>> cells = {};  // [row][column]

  std::uint64_t Largest() const;
};

// How a cell of this count looks beside one of the largest, colours as "#rrggbb".
struct HeatColors {
  std::string fill;
  std::string text;  // readable on it
};
HeatColors HeatColorsOf(std::uint64_t count, std::uint64_t largest);

// An SVG document; a cell without any is empty.
std::string DrawHeatMap(const HeatMap& map);

}  // namespace gauntlet::analysis
