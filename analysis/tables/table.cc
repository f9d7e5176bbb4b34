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

Column::Column(std::string over, std::string name)
    : title(std::move(over)), at_right(title.starts_with('>')), key(std::move(name)) {
  if (at_right) title.erase(0, 1);
}

Column OnTerminals(const char* title, std::string key) {
  Column column(title, std::move(key));
  column.on_pages = false;
  return column;
}

Column OnPages(const char* title, std::string key) {
  Column column(title, std::move(key));
  column.on_terminals = false;
  return column;
}

Column ForPrograms(std::string key) {
  Column column("", std::move(key));
  column.on_terminals = column.on_pages = false;
  return column;
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

bool Table::HasTitles() const {
  return std::ranges::any_of(columns_, [](const Column& column) { return !column.title.empty(); });
}

std::string Table::ToText(std::size_t indent) const {
  std::vector<std::vector<std::string>> lines(1);
  std::vector<std::size_t> widths;
  std::vector<bool> at_right;
  for (const Column& column : columns_) {
    if (!column.on_terminals) continue;
    lines[0].push_back(column.title);
    at_right.push_back(column.at_right);
  }
  for (const std::vector<Cell>& row : rows_) {
    std::vector<std::string>& line = lines.emplace_back();
    for (std::size_t i = 0; i < row.size(); ++i) {
      if (columns_[i].on_terminals) line.push_back(Printable(row[i].text));
    }
  }
  widths.resize(at_right.size());
  for (const std::vector<std::string>& line : lines) {
    for (std::size_t i = 0; i < line.size(); ++i) widths[i] = std::max(widths[i], DisplayWidth(line[i]));
  }
  std::string text;
  for (const std::vector<std::string>& cells : lines) {
    std::string line(indent, ' ');
    for (std::size_t i = 0; i < cells.size(); ++i) {
      if (i > 0) line += "  ";
      const std::string padding(widths[i] - DisplayWidth(cells[i]), ' ');
      line += at_right[i] ? padding + cells[i] : cells[i] + padding;
    }
    line.erase(line.find_last_not_of(' ') + 1);
    if (!line.empty()) text += line + '\n';
  }
  return text;
}

std::string Table::ToMarkdown() const {
  std::string names;
  std::string line;
  for (const Column& column : columns_) {
    if (!column.on_terminals) continue;
    names += fmt::format("| {} ", column.title);
    line += column.at_right ? "|---:" : "|---";
  }
  std::string text = names + "|\n" + line + "|\n";
  for (const std::vector<Cell>& row : rows_) {
    for (std::size_t i = 0; i < row.size(); ++i) {
      if (columns_[i].on_terminals) text += fmt::format("| {} ", WithoutPipes(row[i].text));
    }
    text += "|\n";
  }
  return text + "\n";
}

std::string Table::ToHtml() const {
  const bool facts = !HasTitles();
  std::string html = facts ? "<div class=\"scroll\"><table class=\"facts\"><tbody>\n"
                           : "<div class=\"scroll\"><table><thead><tr>";
  for (const Column& column : columns_) {
    if (!facts && column.on_pages) html += CellHtml("th", " scope=\"col\"", column, Html(column.title));
  }
  if (!facts) html += "</tr></thead><tbody>\n";
  for (const std::vector<Cell>& row : rows_) {
    if (facts && row.at(1).text.empty()) continue;
    html += "<tr>";
    for (std::size_t i = 0; i < row.size(); ++i) {
      if (!columns_[i].on_pages) continue;
      html += facts && i == 0 ? CellHtml("th", " scope=\"row\"", columns_[i], HtmlOf(row[i]))
                              : CellHtml("td", "", columns_[i], HtmlOf(row[i]));
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
