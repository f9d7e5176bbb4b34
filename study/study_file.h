// A study file as it is written: its tables and keys, without what they mean.
#pragma once

#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "base/result.h"

namespace gauntlet {

// A kind of table, "[part.NAME]", and its keys.
struct StudyTableKind {
  std::string_view name;
  std::vector<std::string_view> needed;
  std::vector<std::string_view> optional;
  std::vector<std::string_view> nested;  // of all these: those that stand for many, "set.KEY"
};

struct StudyFileTable {
  const StudyTableKind* kind = nullptr;
  std::string name;
  std::string where;                                      // "FILE:LINE:COLUMN", for messages
  std::vector<std::pair<std::string, std::string>> keys;  // in the order of the file; "set.KEY" is a key
  std::map<std::string, std::string> places;

  bool Has(const std::string& key) const { return places.contains(key); }
  std::string Key(const std::string& key) const;  // "" when it was not given
  std::string PlaceOf(const std::string& key) const;
  // What stands below "set" or the like: keys without it.
  std::vector<std::pair<std::string, std::string>> Nested(const std::string& key) const;
};

struct StudyFileContent {
  std::map<std::string, std::string> top;
  std::vector<StudyFileTable> tables;
};

// Error: malformed TOML, an unknown key with the nearest known one, a key that is missing.
Result<StudyFileContent> ReadStudyFile(const std::string& text, const std::string& file);

// "a, b" -> a and b.
std::vector<std::string> ListItems(const std::string& text);

}  // namespace gauntlet
