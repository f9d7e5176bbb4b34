#include "search/experiment/toml_text.h"

#include <fmt/format.h>
#include <toml++/toml.h>

#include <algorithm>
#include <optional>
#include <utility>

#include "base/key.h"
#include "base/number_text.h"
#include "base/utf8.h"

namespace gauntlet {
namespace {

OtherToml ArrayOf(const toml::array& array) {
  std::vector<std::string> texts;
  for (const toml::node& node : array) {
    const auto* text = node.as_string();
    if (text == nullptr) return {"an array"};
    texts.push_back(text->get());
  }
  return {"an array", std::move(texts)};
}

TomlValue ValueOf(const toml::node& node) {
  if (const auto* text = node.as_string()) return text->get();
  if (const auto* integer = node.as_integer()) return integer->get();
  if (const auto* number = node.as_floating_point()) return number->get();
  if (const auto* flag = node.as_boolean()) return flag->get();
  if (const auto* array = node.as_array()) return ArrayOf(*array);
  if (node.is_table()) return OtherToml{"a table"};
  return OtherToml{"a date or time"};
}

// The library recurses once per part of a key when it parses, and again when a table goes: a key of many
// thousand parts would exhaust the stack. With its own limit of 256 nested values, this bound keeps the depth
// below 5,000. No key of an experiment has more than two parts.
constexpr int kMostKeyParts = 16;

// Finds the first run of more than kMostKeyParts parts joined by dots, before the library sees it. Texts and
// comments are skipped, so dots in them do not count; whether all else is TOML is the library's to say.
class KeyDepthScan {
 public:
  explicit KeyDepthScan(std::string_view text) : text_(text) {}

  // Offset of the key's beginning; nothing when no key is too deep.
  std::optional<std::size_t> Find() {
    while (at_ < text_.size()) {
      const char c = text_[at_];
      if (c == '#') {
        at_ = std::min(text_.find('\n', at_), text_.size());
      } else if (c == '"' || c == '\'') {
        BeginKey();
        SkipText(c);
      } else if (c == '.') {
        if (++dots_ >= kMostKeyParts) return begin_.value_or(at_);
        ++at_;
      } else if (c == ' ' || c == '\t') {
        ++at_;
      } else {
        const bool ends = std::string_view("=[]{},\r\n").find(c) != std::string_view::npos;
        if (ends) {
          begin_.reset();
          dots_ = 0;
        } else {
          BeginKey();
        }
        ++at_;
      }
    }
    return std::nullopt;
  }

 private:
  void BeginKey() {
    if (!begin_) begin_ = at_;
  }

  // From an opening quote to behind its closing one; an open text ends with its line, or with the file.
  void SkipText(char quote) {
    const std::string fence(3, quote);
    const bool multi_line = text_.substr(at_).starts_with(fence);
    const std::string_view end = multi_line ? std::string_view(fence) : std::string_view(fence).substr(0, 1);
    for (at_ += end.size(); at_ < text_.size(); ++at_) {
      if (text_.substr(at_).starts_with(end)) {
        at_ += end.size();
        // Up to two quotes may stand before the closing three.
        for (int extra = 0; multi_line && extra < 2 && at_ < text_.size() && text_[at_] == quote; ++extra)
          ++at_;
        return;
      }
      if (!multi_line && text_[at_] == '\n') return;
      if (quote == '"' && text_[at_] == '\\') ++at_;
    }
    at_ = text_.size();
  }

  std::string_view text_;
  std::size_t at_ = 0;
  std::optional<std::size_t> begin_;
  int dots_ = 0;
};

struct Located {
  toml::source_position position;
  Assignment assignment;
};

bool IsListOfTables(const toml::node& node) {
  const toml::array* list = node.as_array();
  return list != nullptr && !list->empty() &&
         std::ranges::all_of(*list, [](const toml::node& element) { return element.is_table(); });
}

void Flatten(const toml::table& table, const std::string& prefix, const std::string& file_name,
             std::vector<Located>& out) {
  for (const auto& [key, node] : table) {
    const std::string path = prefix + std::string(key.str());
    const toml::table* inner = node.as_table();
    if (inner != nullptr && !inner->empty()) {
      Flatten(*inner, path + ".", file_name, out);
      continue;
    }
    const auto add = [&](const std::string& full_path, TomlValue value,
                         const toml::source_position& position) {
      out.push_back({position, Assignment{.path = full_path,
                                          .value = std::move(value),
                                          .text = "",
                                          .where = fmt::format("{}:{}:{}", file_name, position.line,
                                                               position.column)}});
    };
    if (!IsListOfTables(node)) {
      add(path, ValueOf(node), key.source().begin);
      continue;
    }
    int number = 0;
    for (const toml::node& element : *node.as_array()) {
      const std::string place = fmt::format("{}.{}", path, ++number);
      add(place, OtherToml{std::string(kListOfTables)}, element.source().begin);
      Flatten(*element.as_table(), place + ".", file_name, out);
    }
  }
}

// The one value of "v = text", or nothing when that is not valid TOML.
std::optional<TomlValue> ParseValue(const std::string& text) {
  if (KeyDepthScan(text).Find()) return std::nullopt;
  try {
    const toml::table table = toml::parse("v = " + text);
    const toml::node* node = table.get("v");
    if (node == nullptr || table.size() != 1) return std::nullopt;
    return ValueOf(*node);
  } catch (const toml::parse_error&) {
    return std::nullopt;
  }
}

}  // namespace

Result<std::vector<Assignment>> ReadToml(std::string_view text, const std::string& file_name) {
  if (const std::optional<std::size_t> deep = KeyDepthScan(text).Find()) {
    return InvalidInput(
        fmt::format("{}:{}: a key of more than {} parts; those of an experiment have at most 2", file_name,
                    PlaceIn(text, *deep), kMostKeyParts));
  }
  std::vector<Located> located;
  try {
    Flatten(toml::parse(text), "", file_name, located);
  } catch (const toml::parse_error& error) {
    const toml::source_position position = error.source().begin;
    return InvalidInput(
        fmt::format("{}:{}:{}: {}", file_name, position.line, position.column, error.description()));
  }
  // The library's tables are ordered by name; the first error to report is the first of the file.
  std::stable_sort(located.begin(), located.end(),
                   [](const Located& a, const Located& b) { return a.position < b.position; });
  std::vector<Assignment> assignments;
  for (Located& one : located) assignments.push_back(std::move(one.assignment));
  return assignments;
}

Result<Assignment> ReadSet(const std::string& set, const std::string& option) {
  const std::string where = option + " " + set;
  const std::size_t equals = set.find('=');
  if (equals == std::string::npos || equals == 0) {
    return InvalidInput(where + ": expected key=value, such as search.generations=10");
  }
  Assignment assignment{
      .path = set.substr(0, equals), .value = {}, .text = set.substr(equals + 1), .where = where};
  std::optional<TomlValue> value = ParseValue(assignment.text);
  if (!value.has_value()) value = ParseValue(QuoteToml(assignment.text));
  if (!value.has_value()) return InvalidInput(where + ": the value is not valid UTF-8 text");
  assignment.value = std::move(*value);
  return assignment;
}

std::string TextOf(const TomlValue& value) {
  if (const auto* text = std::get_if<std::string>(&value)) return *text;
  if (const auto* integer = std::get_if<std::int64_t>(&value)) return fmt::format("{}", *integer);
  if (const auto* number = std::get_if<double>(&value)) return NumberText(*number);
  if (const auto* flag = std::get_if<bool>(&value)) return *flag ? "true" : "false";
  return "";
}

std::string KindOf(const TomlValue& value) {
  if (const auto* other = std::get_if<OtherToml>(&value)) return other->kind;
  if (std::holds_alternative<std::string>(value)) return "text";
  if (std::holds_alternative<std::int64_t>(value)) return "a whole number";
  return std::holds_alternative<double>(value) ? "a decimal number" : "true or false";
}

}  // namespace gauntlet
