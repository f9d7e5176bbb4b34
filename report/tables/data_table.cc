#include "report/tables/data_table.h"

#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "base/check.h"

namespace gauntlet {
namespace {

constexpr std::size_t kFlushBytes = std::size_t{1} << 16;

std::string JsonString(const std::string& text) {
  std::string json;
  AppendJson(text, json);
  return json;
}

// The text of an object without its last brace, to be continued.
std::string Opened(const std::string& head) {
  const std::size_t end = head.find_last_not_of(" \n", head.rfind('}') - 1);
  GAUNTLET_CHECK(end != std::string::npos && head[end] != '{', "the head of a table says nothing");
  return head.substr(0, end + 1) + ",\n";
}

}  // namespace

DataTable::DataTable(TableFormat format, std::vector<DataColumn> columns, Sink sink, const std::string& head,
                     const std::string& rows)
    : format_(format), columns_(std::move(columns)), sink_(std::move(sink)) {
  if (format_ == TableFormat::kCsv) {
    for (const DataColumn& column : columns_) {
      if (!waiting_.empty()) waiting_ += ',';
      AppendCsv(column.name, waiting_);
    }
    waiting_ += '\n';
    return;
  }
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  for (const DataColumn& column : columns_) {
    list.push_back({{"name", column.name}, {"unit", column.unit}, {"meaning", column.meaning}});
    keys_.push_back(JsonString(column.name) + ": ");
  }
  waiting_ = fmt::format("{}  \"columns\": {},\n  {}: [", Opened(head), list.dump(), JsonString(rows));
}

Status DataTable::AddRow(const std::vector<Value>& cells) {
  GAUNTLET_CHECK(cells.size() == columns_.size(),
                 fmt::format("{} cells, {} columns", cells.size(), columns_.size()));
  const bool json = format_ == TableFormat::kJson;
  if (json) waiting_ += rows_ == 0 ? "\n    {" : ",\n    {";
  for (std::size_t i = 0; i < cells.size(); ++i) {
    if (i > 0) waiting_ += json ? ", " : ",";
    if (json) waiting_ += keys_[i];
    json ? AppendJson(cells[i], waiting_) : AppendCsv(cells[i], waiting_);
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

}  // namespace gauntlet
