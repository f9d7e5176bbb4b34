#include "cli/output/table.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "base/check.h"
#include "base/printable.h"

namespace gauntlet {

Table::Table(const std::vector<std::string>& headers) : rows_(1) {
  for (const std::string& header : headers) {
    at_right_.push_back(header.starts_with('>'));
    rows_[0].push_back(header.substr(at_right_.back() ? 1 : 0));
  }
}

void Table::AddRow(std::vector<std::string> cells) {
  GAUNTLET_CHECK(cells.size() <= at_right_.size(),
                 fmt::format("{} cells, {} columns", cells.size(), at_right_.size()));
  cells.resize(at_right_.size());
  for (std::string& cell : cells) cell = Printable(cell);
  rows_.push_back(std::move(cells));
}

std::string Table::ToText(std::size_t indent) const {
  std::vector<std::size_t> widths(at_right_.size());
  for (const auto& row : rows_) {
    for (std::size_t i = 0; i < row.size(); ++i) widths[i] = std::max(widths[i], DisplayWidth(row[i]));
  }
  std::string text;
  for (const auto& row : rows_) {
    std::string line(indent, ' ');
    for (std::size_t i = 0; i < row.size(); ++i) {
      if (i > 0) line += "  ";
      const std::string padding(widths[i] - DisplayWidth(row[i]), ' ');
      line += at_right_[i] ? padding + row[i] : row[i] + padding;
    }
    line.erase(line.find_last_not_of(' ') + 1);
    if (!line.empty()) text += line + '\n';
  }
  return text;
}

std::size_t DisplayWidth(std::string_view text) {
  return static_cast<std::size_t>(std::count_if(
      text.begin(), text.end(), [](char c) { return (static_cast<unsigned char>(c) & 0xC0) != 0x80; }));
}

std::string Wrapped(std::string_view text, std::size_t width, std::size_t indent) {
  std::string out;
  std::size_t column = 0;
  while (!text.empty()) {
    const std::size_t end = std::min(text.find(' '), text.size());
    const std::string_view word = text.substr(0, end);
    const std::size_t length = DisplayWidth(word);
    if (column > 0 && column + 1 + length > width) {
      out += '\n' + std::string(indent, ' ');
      column = indent;
    } else if (column > 0) {
      out += ' ';
      ++column;
    }
    out += word;
    column += length;
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  return out;
}

std::string FormatFitness(double fitness) {
  return std::isfinite(fitness) ? fmt::format("{:.3f}", fitness) : "-";
}

}  // namespace gauntlet
