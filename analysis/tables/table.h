// Tables that are declared once and told as text, Markdown, HTML, JSON and CSV.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "analysis/tables/cell.h"

namespace gauntlet {

// Who is told a column.
enum class Audience { kAll, kTerminals, kPages, kPrograms };

// For people a column has a title, for programs a key, most have both.
struct Column {
  // '>' in front of a title, which is not shown, moves the column's cells to the right. Keys are those of
  // JSON, "" = not in JSON. '?' behind one leaves it out of rows whose cell says nothing to people either
  // (TextCell("")), and with a blank between two ("k n") the cell's list is told under both.
  Column(const char* over, std::string name = "",
         Audience who = Audience::kAll)  // NOLINT(google-explicit-constructor)
      : Column(std::string(over), std::move(name), who) {}
  Column(std::string over, std::string name = "",
         Audience who = Audience::kAll);  // NOLINT(google-explicit-constructor)

  std::string title;
  std::string key;
  Audience audience;
  bool at_right;
};
inline Column OnTerminals(const char* title, std::string key = "") {
  return {title, std::move(key), Audience::kTerminals};
}
inline Column OnPages(const char* title, std::string key = "") {
  return {title, std::move(key), Audience::kPages};
}
inline Column ForPrograms(std::string key) {
  return {"", std::move(key), Audience::kPrograms};
}

class Table {
 public:
  // Without columns: a table that says nothing.
  Table() = default;
  Table(std::vector<Column> columns) : columns_(std::move(columns)) {}  // NOLINT(google-explicit-constructor)

  // Missing cells are empty texts; there must not be more cells than columns.
  void AddRow(std::vector<Cell> cells);
  // The first `most` rows.
  Table First(std::size_t most) const;
  // The first row, the last one and others at even distances between them, `most` in all.
  Table Thinned(std::size_t most) const;
  const std::vector<Column>& columns() const { return columns_; }
  std::size_t size() const { return rows_.size(); }
  bool empty() const { return rows_.empty(); }

  // Lines end with '\n', without trailing blanks; columns are two blanks apart. A line without text, such as
  // that of empty titles, is left out. What a terminal would obey is written as escapes of C.
  std::string ToText(std::size_t indent = 2) const;
  std::string ToMarkdown() const;
  // Texts stay texts, whatever they hold. Without any title it is a table of facts: the first cell names the
  // second, and rows that have nothing in the second are left out.
  std::string ToHtml() const;
  // A line of titles, and a line of values for each row.
  std::string ToCsv() const;
  // A list of objects; a list of lists, which has a value for each column.
  nlohmann::ordered_json ToJson() const;
  nlohmann::ordered_json ToJsonRows() const;

 private:
  // Numbers of the columns that this audience is told.
  std::vector<std::size_t> ColumnsFor(Audience audience) const;

  std::vector<Column> columns_;
  std::vector<std::vector<Cell>> rows_;
};

// Columns that the text takes on a terminal, counting code points (wide and combining characters count one).
std::size_t DisplayWidth(std::string_view text);

// Text broken at blanks into lines of at most `width` columns, each after the first indented.
std::string Wrapped(std::string_view text, std::size_t width, std::size_t indent);

}  // namespace gauntlet
