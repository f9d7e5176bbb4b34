#include "study/study_file.h"

#include <algorithm>
#include <iterator>
#include <span>

#include <fmt/format.h>

#include "base/nearest_name.h"
#include "base/number_text.h"
#include "base/split.h"
#include "search/experiment/toml_text.h"

namespace gauntlet {
namespace {

const std::vector<StudyTableKind>& TableKinds() {
  static const std::vector<StudyTableKind> kinds = {
      {"part", {"kind"}, {"experiment", "seeds", "cases", "replicates", "from", "set"}, {"set"}},
      {"compare", {"title", "first", "second"}, {"metric", "expect", "effect", "claim"}, {}},
      {"count",
       {"title", "first", "what"},
       {"second", "metric", "at_least", "at_most", "above", "below", "expect", "claim"},
       {}},
      {"types", {"title", "first", "second"}, {"expect", "claim"}, {}},
      {"peak", {"title", "part"}, {}, {}},
      {"windows", {"title", "first", "prefix", "seconds"}, {}, {}},
      {"tune", {"title", "experiment", "repeats"}, {"sizes", "set", "candidates"}, {"set", "candidates"}},
      {"note", {"text"}, {"always"}, {}}};
  return kinds;
}

const std::vector<std::string_view> kTopKeys = {"name", "description", "include", "published"};

std::string UnknownKey(const std::string& where, const std::string& key,
                       std::span<const std::string_view> known) {
  return fmt::format("{}: {}", where, UnknownName("key", key, known));
}

std::string TextOf(const TomlValue& value) {
  if (const auto* text = std::get_if<std::string>(&value)) return *text;
  if (const auto* integer = std::get_if<std::int64_t>(&value)) return fmt::format("{}", *integer);
  if (const auto* number = std::get_if<double>(&value)) return NumberText(*number);
  return std::get<bool>(value) ? "true" : "false";
}

Status AddToTable(const Assignment& assignment, StudyFileContent& content) {
  const std::vector<std::string> path = Split(assignment.path, '.');
  const StudyTableKind* kind = FindByName(TableKinds(), path[0]);
  if (kind == nullptr) {
    std::vector<std::string_view> known = kTopKeys;
    for (const StudyTableKind& one : TableKinds()) known.push_back(one.name);
    return InvalidInput(UnknownKey(assignment.where, path[0], known));
  }
  if (path.size() < 3) {
    return InvalidInput(
        fmt::format("{}: {} is a table of tables, [{}.NAME]", assignment.where, path[0], path[0]));
  }
  std::vector<std::string_view> known = kind->needed;
  known.insert(known.end(), kind->optional.begin(), kind->optional.end());
  const bool nested = std::ranges::count(kind->nested, path[2]) > 0;
  if (std::ranges::count(known, path[2]) == 0 || (path.size() > 3) != nested) {
    return InvalidInput(UnknownKey(assignment.where, path[2], known));
  }
  auto table = std::ranges::find_if(
      content.tables, [&](const StudyFileTable& one) { return one.kind == kind && one.name == path[1]; });
  if (table == content.tables.end()) {
    content.tables.push_back({kind, path[1], assignment.where, {}, {}});
    table = std::prev(content.tables.end());
  }
  std::string key = path[2];
  for (std::size_t i = 3; i < path.size(); ++i) key += "." + path[i];
  table->keys.emplace_back(key, TextOf(assignment.value));
  table->places[key] = assignment.where;
  return Ok{};
}

}  // namespace

std::string StudyFileTable::Key(const std::string& key) const {
  const auto found = std::ranges::find(keys, key, &std::pair<std::string, std::string>::first);
  return found == keys.end() ? "" : found->second;
}

std::string StudyFileTable::PlaceOf(const std::string& key) const {
  const auto found = places.find(key);
  return found == places.end() ? where : found->second;
}

std::vector<std::pair<std::string, std::string>> StudyFileTable::Nested(const std::string& key) const {
  std::vector<std::pair<std::string, std::string>> found;
  for (const auto& [path, value] : keys) {
    if (path.starts_with(key + ".")) found.emplace_back(path.substr(key.size() + 1), value);
  }
  return found;
}

Result<StudyFileContent> ReadStudyFile(const std::string& text, const std::string& file) {
  TRY(const auto assignments, ReadToml(text, file));
  StudyFileContent content;
  for (const Assignment& assignment : assignments) {
    if (const auto* other = std::get_if<OtherToml>(&assignment.value)) {
      return InvalidInput(fmt::format("{}: {} is {}, expected a text or a number", assignment.where,
                                      assignment.path, other->kind));
    }
    if (std::ranges::count(kTopKeys, assignment.path) > 0) {
      content.top[assignment.path] = TextOf(assignment.value);
    } else if (Status added = AddToTable(assignment, content); !added) {
      return added.error();
    }
  }
  for (const StudyFileTable& table : content.tables) {
    for (const std::string_view key : table.kind->needed) {
      if (table.Has(std::string(key))) continue;
      return InvalidInput(
          fmt::format("{}: [{}.{}] needs the key {}", table.where, table.kind->name, table.name, key));
    }
  }
  return content;
}

std::vector<std::string> ListItems(const std::string& text) {
  std::vector<std::string> items = Split(text, ',');
  for (std::string& item : items) std::erase(item, ' ');
  std::erase(items, "");
  return items;
}

}  // namespace gauntlet
