#include "analysis/tables/table.h"

#include <algorithm>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "analysis/tables/html.h"
#include "base/check.h"
#include "base/printable.h"

namespace gauntlet {
namespace {

std::string WithoutPipes(const std::string& text) {
  std::string escaped;
  for (const char c : text) {
    if (c == '|') escaped += '\\';
    escaped += c;
  }
  return escaped;
}

// Names at the left, numbers at the right.
std::string CellHtml(std::string_view element, std::string_view scope, const Column& column,
                     const std::string& html) {
  return fmt::format("<{}{}{}>{}</{}>", element, scope, column.at_right ? " class=\"number\"" : "", html,
                     element);
}

std::string HtmlOf(const Cell& cell) {
  return cell.link.empty() ? Html(cell.text)
                           : fmt::format("<a href=\"{}\">{}</a>", Html(cell.link), Html(cell.text));
}

// Under the column's key or keys.
void AddField(const Column& column, const Cell& cell, nlohmann::ordered_json& row) {
  if (column.key.empty()) return;
  const nlohmann::ordered_json value = JsonValue(cell.value);
  const std::size_t blank = column.key.find(' ');
  if (blank != std::string::npos) {
    row[column.key.substr(0, blank)] = value.at(0);
    row[column.key.substr(blank + 1)] = value.at(1);
  } else if (!column.key.ends_with('?')) {
    row[column.key] = value;
  } else if (!value.is_null() || !cell.text.empty()) {
    row[column.key.substr(0, column.key.size() - 1)] = value;
  }
}

}  // namespace

Column::Column(std::string over, std::string name, Audience who)
    : title(std::move(over)), key(std::move(name)), audience(who), at_right(title.starts_with('>')) {
  if (at_right) title.erase(0, 1);
}

void Table::AddRow(std::vector<Cell> cells) {
  GAUNTLET_CHECK(cells.size() <= columns_.size(),
                 fmt::format("{} cells, {} columns", cells.size(), columns_.size()));
  cells.resize(columns_.size(), Cell(""));
  rows_.push_back(std::move(cells));
}

Table Table::First(std::size_t most) const {
  Table first = *this;
  if (first.rows_.size() > most) first.rows_.resize(most);
  return first;
}

Table Table::Thinned(std::size_t most) const {
  if (rows_.size() <= most) return *this;
  Table thinned(columns_);
  const std::size_t gaps = rows_.size() - 1;
  const std::size_t steps = most - 1;
  for (std::size_t i = 0; i <= steps; ++i) thinned.rows_.push_back(rows_[(i * gaps + steps / 2) / steps]);
  return thinned;
}

std::vector<std::size_t> Table::ColumnsFor(Audience audience) const {
  std::vector<std::size_t> columns;
  for (std::size_t i = 0; i < columns_.size(); ++i) {
    if (columns_[i].audience == Audience::kAll || columns_[i].audience == audience) columns.push_back(i);
  }
  return columns;
}

std::string Table::ToText(std::size_t indent) const {
  std::vector<std::string> lines(rows_.size() + 1, std::string(indent, ' '));
  for (const std::size_t column : ColumnsFor(Audience::kTerminals)) {
    std::vector<std::string> texts = {columns_[column].title};
    for (const std::vector<Cell>& row : rows_) texts.push_back(Printable(row[column].text));
    std::size_t width = 0;
    for (const std::string& text : texts) width = std::max(width, DisplayWidth(text));
    for (std::size_t i = 0; i < texts.size(); ++i) {
      const std::string padding(width - DisplayWidth(texts[i]), ' ');
      lines[i] += (columns_[column].at_right ? padding + texts[i] : texts[i] + padding) + "  ";
    }
  }
  std::string text;
  for (std::string& line : lines) {
    line.erase(line.find_last_not_of(' ') + 1);
    if (!line.empty()) text += line + '\n';
  }
  return text;
}

std::string Table::ToMarkdown() const {
  const std::vector<std::size_t> shown = ColumnsFor(Audience::kTerminals);
  std::string titles;
  std::string line;
  for (const std::size_t i : shown) {
    titles += fmt::format("| {} ", columns_[i].title);
    line += columns_[i].at_right ? "|---:" : "|---";
  }
  std::string text = titles + "|\n" + line + "|\n";
  for (const std::vector<Cell>& row : rows_) {
    for (const std::size_t i : shown) text += fmt::format("| {} ", WithoutPipes(row[i].text));
    text += "|\n";
  }
  return text + "\n";
}

std::string Table::ToHtml() const {
  const std::vector<std::size_t> shown = ColumnsFor(Audience::kPages);
  const bool facts = std::ranges::all_of(columns_, [](const Column& one) { return one.title.empty(); });
  std::string html = facts ? "<div class=\"scroll\"><table class=\"facts\"><tbody>\n"
                           : "<div class=\"scroll\"><table><thead><tr>";
  for (const std::size_t i : shown) {
    if (!facts) html += CellHtml("th", " scope=\"col\"", columns_[i], Html(columns_[i].title));
  }
  if (!facts) html += "</tr></thead><tbody>\n";
  for (const std::vector<Cell>& row : rows_) {
    if (facts && row.at(1).text.empty()) continue;
    html += "<tr>";
    for (const std::size_t i : shown) {
      const bool name = facts && i == 0;
      html += CellHtml(name ? "th" : "td", name ? " scope=\"row\"" : "", columns_[i], HtmlOf(row[i]));
    }
    html += "</tr>\n";
  }
  return html + "</tbody></table></div>\n";
}

std::string Table::ToCsv() const {
  std::string csv;
  const auto append = [&](std::size_t i, const Value& value) {
    if (i > 0) csv += ',';
    AppendCsv(value, csv);
    if (i + 1 == columns_.size()) csv += '\n';
  };
  for (std::size_t i = 0; i < columns_.size(); ++i) append(i, columns_[i].title);
  for (const std::vector<Cell>& row : rows_) {
    for (std::size_t i = 0; i < row.size(); ++i) append(i, row[i].value);
  }
  return csv;
}

nlohmann::ordered_json Table::ToJson() const {
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  for (const std::vector<Cell>& row : rows_) {
    nlohmann::ordered_json object = nlohmann::ordered_json::object();
    for (std::size_t i = 0; i < row.size(); ++i) AddField(columns_[i], row[i], object);
    list.push_back(std::move(object));
  }
  return list;
}

nlohmann::ordered_json Table::ToJsonRows() const {
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  for (const std::vector<Cell>& row : rows_) {
    nlohmann::ordered_json values = nlohmann::ordered_json::array();
    for (const Cell& cell : row) values.push_back(JsonValue(cell.value));
    list.push_back(std::move(values));
  }
  return list;
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

}  // namespace gauntlet
