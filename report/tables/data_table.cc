#include "report/tables/data_table.h"

#include <cmath>
#include <iterator>
#include <type_traits>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "base/check.h"

namespace gauntlet {
namespace {

constexpr std::size_t kFlushBytes = std::size_t{1} << 16;
// Integers up to here are exact in every JSON reader.
constexpr std::uint64_t kExactInJson = 1ULL << 53;

// A byte that is not UTF-8 becomes U+FFFD.
std::string JsonString(const std::string& text) {
  return nlohmann::json(text).dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

void AppendCsvText(const std::string& text, std::string& out) {
  if (text.find_first_of(",\"\r\n") == std::string::npos) {
    out += text;
    return;
  }
  out += '"';
  for (const char c : text) {
    if (c == '"') out += '"';
    out += c;
  }
  out += '"';
}

void Append(TableFormat format, const Cell& cell, std::string& out) {
  const bool json = format == TableFormat::kJson;
  const auto append = [&](const auto& value) {
    using Value = std::decay_t<decltype(value)>;
    if constexpr (std::is_same_v<Value, std::monostate>) {
      if (json) out += "null";
    } else if constexpr (std::is_same_v<Value, std::string>) {
      json ? void(out += JsonString(value)) : AppendCsvText(value, out);
    } else if constexpr (std::is_same_v<Value, bool>) {
      // R takes no other words for truth values than these; pandas takes them too.
      out += json ? (value ? "true" : "false") : (value ? "TRUE" : "FALSE");
    } else if constexpr (std::is_same_v<Value, std::uint64_t>) {
      const char* quote = json && value > kExactInJson ? "\"" : "";
      fmt::format_to(std::back_inserter(out), "{0}{1}{0}", quote, value);
    } else {
      fmt::format_to(std::back_inserter(out), "{}", value);
    }
  };
  std::visit(append, cell);
}

// The text of an object without its last brace, to be continued.
std::string Opened(const std::string& head) {
  const std::size_t end = head.find_last_not_of(" \n", head.rfind('}') - 1);
  GAUNTLET_CHECK(end != std::string::npos && head[end] != '{', "the head of a table says nothing");
  return head.substr(0, end + 1) + ",\n";
}

}  // namespace

Cell NumberCell(double value) {
  return std::isfinite(value) ? Cell(value) : Cell();
}

Cell TextCell(std::string text) {
  return text.empty() ? Cell() : Cell(std::move(text));
}

DataTable::DataTable(TableFormat format, std::vector<Column> columns, Sink sink, const std::string& head,
                     const std::string& rows)
    : format_(format), columns_(std::move(columns)), sink_(std::move(sink)) {
  if (format_ == TableFormat::kCsv) {
    for (const Column& column : columns_) {
      if (!waiting_.empty()) waiting_ += ',';
      AppendCsvText(column.name, waiting_);
    }
    waiting_ += '\n';
    return;
  }
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  for (const Column& column : columns_) {
    list.push_back({{"name", column.name}, {"unit", column.unit}, {"meaning", column.meaning}});
    keys_.push_back(JsonString(column.name) + ": ");
  }
  waiting_ = fmt::format("{}  \"columns\": {},\n  {}: [", Opened(head), list.dump(), JsonString(rows));
}

Status DataTable::AddRow(const std::vector<Cell>& cells) {
  GAUNTLET_CHECK(cells.size() == columns_.size(),
                 fmt::format("{} cells, {} columns", cells.size(), columns_.size()));
  const bool json = format_ == TableFormat::kJson;
  if (json) waiting_ += rows_ == 0 ? "\n    {" : ",\n    {";
  for (std::size_t i = 0; i < cells.size(); ++i) {
    if (i > 0) waiting_ += json ? ", " : ",";
    if (json) waiting_ += keys_[i];
    Append(format_, cells[i], waiting_);
  }
  waiting_ += json ? "}" : "\n";
  ++rows_;
  return waiting_.size() < kFlushBytes ? Ok{} : Flush();
}

Status DataTable::Finish() {
  if (format_ == TableFormat::kJson) waiting_ += rows_ == 0 ? "]\n}\n" : "\n  ]\n}\n";
  return Flush();
}

Status DataTable::Flush() {
  const Status written = sink_(waiting_);
  waiting_.clear();
  return written;
}

std::string CsvText(const std::vector<std::string>& columns, const std::vector<std::vector<Cell>>& rows) {
  std::vector<Column> named;
  for (const std::string& column : columns) named.push_back({column, "", ""});
  std::string text;
  DataTable table(
      TableFormat::kCsv, named,
      [&](std::string_view bytes) -> Status {
        text += bytes;
        return Ok{};
      },
      "", "");
  // Appending to a text cannot fail.
  for (const std::vector<Cell>& row : rows) (void)table.AddRow(row);
  (void)table.Finish();
  return text;
}

}  // namespace gauntlet
