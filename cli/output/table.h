// Plain-text tables for the terminal, and numbers as a person reads them.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "base/number_text.h"

namespace gauntlet {

class Table {
 public:
  // The columns' headers; '>' in front, which is not printed, moves a column's cells to the right.
  explicit Table(const std::vector<std::string>& headers);

  // Missing cells are empty; there must not be more cells than columns.
  void AddRow(std::vector<std::string> cells);
  // Lines end with '\n', without trailing blanks; columns are two blanks apart. A line without text, such as
  // that of empty headers, is left out.
  std::string ToText(std::size_t indent = 2) const;

 private:
  std::vector<bool> at_right_;                  // one a column
  std::vector<std::vector<std::string>> rows_;  // the headers first
};

// Columns that the text takes on a terminal, counting code points (wide and combining characters count one).
std::size_t DisplayWidth(std::string_view text);

// Text broken at blanks into lines of at most `width` columns, each after the first indented.
std::string Wrapped(std::string_view text, std::size_t width, std::size_t indent);

// Three decimals; "-" for NaN and infinity.
std::string FormatFitness(double fitness);

}  // namespace gauntlet
