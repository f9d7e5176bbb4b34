#include "search/experiment/key_assignment.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>

#include "base/nearest_name.h"
#include "base/parse_number.h"
#include "base/split.h"

namespace gauntlet {
namespace {

// What the value of an assignment to `key` is (KindOf), closer where the kind alone would puzzle.
std::string KindFor(const KeyInfo& key, const Assignment& assignment) {
  const std::string_view digits =
      std::string_view(assignment.text).substr(assignment.text.starts_with('-') ? 1 : 0);
  const bool is_text = std::holds_alternative<std::string>(assignment.value);
  if (is_text && !digits.empty() && digits.find_first_not_of("0123456789") == std::string_view::npos)
    return "a number beyond 64 bits";
  if (key.type == KeyType::kSeed && std::holds_alternative<std::int64_t>(assignment.value))
    return "a negative number";
  // What was typed behind --set is in its place.
  if (is_text && assignment.text.empty())
    return fmt::format("text ({})", QuoteToml(std::get<std::string>(assignment.value)));
  return KindOf(assignment.value);
}

std::optional<std::uint64_t> SeedOf(const TomlValue& value) {
  if (const auto* integer = std::get_if<std::int64_t>(&value); integer != nullptr && *integer >= 0) {
    return static_cast<std::uint64_t>(*integer);
  }
  const auto* text = std::get_if<std::string>(&value);
  return text == nullptr ? std::nullopt : ParseNumber<std::uint64_t>(*text);
}

// The assignment's value in the type of the key, or nothing when it is of another kind.
std::optional<KeyValue> Convert(const KeyInfo& key, const Assignment& assignment) {
  const TomlValue& value = assignment.value;
  const auto* integer = std::get_if<std::int64_t>(&value);
  switch (key.type) {
    case KeyType::kText:
    case KeyType::kChoice:
      if (const auto* text = std::get_if<std::string>(&value)) return *text;
      // --set name=123 means the text.
      if (!assignment.text.empty()) return assignment.text;
      return std::nullopt;
    case KeyType::kInteger:
      if (integer != nullptr) return *integer;
      return std::nullopt;
    case KeyType::kNumber:
      if (integer != nullptr) return static_cast<double>(*integer);
      if (const auto* number = std::get_if<double>(&value)) return *number;
      return std::nullopt;
    case KeyType::kFlag:
      if (const auto* flag = std::get_if<bool>(&value)) return *flag;
      if (integer != nullptr && (*integer == 0 || *integer == 1)) return *integer == 1;
      return std::nullopt;
    case KeyType::kSeed:
      break;
  }
  if (const std::optional<std::uint64_t> seed = SeedOf(value)) return *seed;
  return std::nullopt;
}

// Of the last part of a path ("noise.wheels.gaussian": "gaussian").
bool IsNamed(std::string_view path, std::string_view name) {
  return path.ends_with(name) && path.size() > name.size() && path[path.size() - name.size() - 1] == '.';
}

// The only key whose path has all words of the name in it; "" when there is none, or more.
std::string_view WithWordsOf(std::string_view name, const std::vector<std::string_view>& known) {
  const std::vector<std::string> words = Split(name, '_');
  std::string_view found;
  for (const std::string_view path : known) {
    const bool all = std::ranges::all_of(words, [&](const auto& word) {
      return word.size() > 2 && path.find(word) != std::string_view::npos;
    });
    if (!all) continue;
    if (!found.empty()) return {};
    found = path;
  }
  return found;
}

// "name, seed, search.*, noise.*"
std::string TopOf(const std::vector<std::string_view>& known) {
  std::vector<std::string> top;
  for (const std::string_view path : known) {
    const std::size_t dot = path.find('.');
    std::string one(path.substr(0, dot));
    if (dot != std::string_view::npos) one += ".*";
    if (!std::ranges::count(top, one)) top.push_back(std::move(one));
  }
  return NamesOf(top);
}

}  // namespace

Result<KeyValue> ValueFor(const KeyInfo& key, const Assignment& assignment) {
  std::optional<KeyValue> value = Convert(key, assignment);
  if (!value) {
    return InvalidInput(fmt::format("{}: {} is {}, expected {}", assignment.where, key.path,
                                    KindFor(key, assignment), ExpectationOf(key)));
  }
  if (const std::optional<std::string> wrong = CheckValue(key, *value))
    return InvalidInput(fmt::format("{}: {}", assignment.where, *wrong));
  return *std::move(value);
}

std::string UnknownKey(const std::string& path, const std::vector<std::string_view>& known) {
  const std::size_t dot = path.find('.');
  const std::string table = dot == std::string::npos ? "" : path.substr(0, dot + 1);
  const std::string name = path.substr(table.size());
  std::vector<std::string_view> siblings;  // in the same table
  std::string_view same_name;              // in another one
  for (const std::string_view key : known) {
    if (IsNamed(key, name)) same_name = key;
    if (!table.empty() && key.starts_with(table)) siblings.push_back(key.substr(table.size()));
  }
  std::string nearest(same_name);
  if (nearest.empty() && siblings.empty()) nearest = NearestName(path, known);
  if (nearest.empty() && siblings.empty()) nearest = WithWordsOf(name, known);
  if (const std::string sibling = NearestName(name, siblings); !sibling.empty()) nearest = table + sibling;
  const std::string unknown = fmt::format("unknown key '{}'; ", path);
  if (!nearest.empty()) return unknown + fmt::format("did you mean '{}'?", nearest);
  if (siblings.empty()) return unknown + "known: " + TopOf(known);
  return unknown + fmt::format("known: {}{}", table, fmt::join(siblings, ", " + table));
}

std::string LineOf(std::string_view name, const KeyInfo& key, const KeyValue& value) {
  return fmt::format("{:<36}  # {}{}{}\n", fmt::format("{} = {}", name, ToToml(value)), key.unit,
                     key.unit.empty() ? "" : "; ", key.description);
}

}  // namespace gauntlet
