#include "study/study_file.h"

#include <algorithm>
#include <limits>

#include <fmt/format.h>

#include "base/nearest_name.h"
#include "base/split.h"
#include "search/experiment/key_assignment.h"

namespace gauntlet {
namespace {

// A kind of table, "[part.NAME]", and its keys.
struct TableKind {
  std::string_view name;
  std::vector<std::string_view> needed;
  std::vector<std::string_view> optional;
  std::vector<std::string_view> nested;  // of all these: those that stand for many, "set.KEY"
};

const std::vector<TableKind>& TableKinds() {
  static const std::vector<TableKind> kinds = {
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

// What is more than a text: a key of all tables, or "KIND.KEY".
std::vector<KeyInfo> MakeTypedKeys() {
  std::vector<KeyInfo> keys;
  for (const char* number : {"at_least", "at_most", "above", "below", "effect", "seconds"}) {
    KeyInfo& key = keys.emplace_back();
    key.path = number;
    key.max = std::numeric_limits<double>::infinity();
    key.min = -key.max;
  }
  const auto add_choice = [&](const char* path, const std::vector<std::string>& choices) {
    KeyInfo& key = keys.emplace_back();
    key.path = path;
    key.type = KeyType::kChoice;
    key.choices = choices;
  };
  add_choice("part.kind", {"evolve", "random", "empty", "evaluate"});
  add_choice("types.expect", {"less", "greater", "subset"});
  add_choice("expect", {"less", "greater"});
  return keys;
}

// A number may be quoted.
Status CheckType(const Assignment& assignment, const std::string& kind, const std::string& key,
                 const std::string& value) {
  static const std::vector<KeyInfo> keys = MakeTypedKeys();
  const KeyInfo* typed = FindByName(keys, kind + "." + key);
  if (typed == nullptr) typed = FindByName(keys, key);
  if (typed == nullptr || (value.empty() && key == "expect")) return Ok{};
  TRY(const Assignment read, ReadSet(key + "=" + value));
  TRY(ValueFor(*typed, {key, read.value, "", assignment.where}));
  return Ok{};
}

Error UnknownKey(const Assignment& assignment, const std::string& key,
                 const std::vector<std::string_view>& known) {
  return InvalidInput(fmt::format("{}: {}", assignment.where, UnknownName("key", key, known)));
}

Status AddToTable(const Assignment& assignment, StudyFileContent& content) {
  const std::vector<std::string> path = Split(assignment.path, '.');
  const TableKind* kind = FindByName(TableKinds(), path[0]);
  if (kind == nullptr) {
    std::vector<std::string_view> known = kTopKeys;
    for (const TableKind& one : TableKinds()) known.push_back(one.name);
    return UnknownKey(assignment, path[0], known);
  }
  if (path.size() < 3) {
    return InvalidInput(
        fmt::format("{}: {} is a table of tables, [{}.NAME]", assignment.where, path[0], path[0]));
  }
  std::vector<std::string_view> known = kind->needed;
  known.insert(known.end(), kind->optional.begin(), kind->optional.end());
  const bool nested = std::ranges::count(kind->nested, path[2]) > 0;
  if (std::ranges::count(known, path[2]) == 0 || (path.size() > 3) != nested)
    return UnknownKey(assignment, path[2], known);
  const std::string value = TextOf(assignment.value);
  TRY(CheckType(assignment, path[0], path[2], value));
  auto table = std::ranges::find_if(
      content.tables, [&](const StudyFileTable& one) { return one.kind == path[0] && one.name == path[1]; });
  if (table == content.tables.end())
    table = content.tables.insert(table, {path[0], path[1], assignment.where, {}});
  const std::string key = assignment.path.substr(path[0].size() + path[1].size() + 2);
  table->entries.push_back({key, value, assignment.where});
  return Ok{};
}

}  // namespace

const StudyFileTable::Entry* StudyFileTable::Find(const std::string& key) const {
  const auto found = std::ranges::find(entries, key, &Entry::key);
  return found == entries.end() ? nullptr : &*found;
}

std::string StudyFileTable::Key(const std::string& key) const {
  const Entry* entry = Find(key);
  return entry == nullptr ? "" : entry->value;
}

std::string StudyFileTable::PlaceOf(const std::string& key) const {
  const Entry* entry = Find(key);
  return entry == nullptr ? where : entry->where;
}

std::vector<std::pair<std::string, std::string>> StudyFileTable::Nested(const std::string& key) const {
  std::vector<std::pair<std::string, std::string>> found;
  for (const Entry& entry : entries) {
    if (entry.key.starts_with(key + ".")) found.emplace_back(entry.key.substr(key.size() + 1), entry.value);
  }
  return found;
}

std::vector<std::string> StudyFileTable::Sets() const {
  std::vector<std::string> sets;
  for (const auto& [key, value] : Nested("set")) sets.push_back(fmt::format("{}={}", key, value));
  return sets;
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
    } else {
      TRY(AddToTable(assignment, content));
    }
  }
  for (const StudyFileTable& table : content.tables) {
    for (const std::string_view key : FindByName(TableKinds(), table.kind)->needed) {
      if (table.Has(std::string(key))) continue;
      return InvalidInput(
          fmt::format("{}: [{}.{}] needs the key {}", table.where, table.kind, table.name, key));
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
