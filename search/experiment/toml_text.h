// TOML as a flat list of assignments. The only place that knows the TOML library.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "base/result.h"

namespace gauntlet {

// A value of a kind that no key of one value takes; `kind` is for the message: "an array", "a date".
struct OtherToml {
  std::string kind;
  std::optional<std::vector<std::string>> texts = std::nullopt;  // of an array of nothing but texts
};
using TomlValue = std::variant<std::string, std::int64_t, double, bool, OtherToml>;

struct Assignment {
  std::string path;  // dotted
  TomlValue value;
  std::string text;   // of --set: the value as it was typed, which a key of texts takes as it is
  std::string where;  // "file:line:column" or "--set key=value", for messages
};

// The kind of the assignment with which each element of a list of tables begins.
inline constexpr std::string_view kListOfTables = "a list of tables";

// All assignments in the order of the file. An empty table is an assignment of OtherToml "a table" to its
// name, so that it can be refused when unknown. A list of tables is
// flattened too: "LIST.1" is assigned an OtherToml of kListOfTables, then follow "LIST.1.KEY" and on. Error:
// "file:line:column: what is malformed".
Result<std::vector<Assignment>> ReadToml(std::string_view text, const std::string& file_name);

// "key=value": the value is read as TOML where it is valid TOML, else it is text. Error: no '=', no key, or
// text that is not UTF-8.
Result<Assignment> ReadSet(const std::string& set, const std::string& option = "--set");

// A text, number or truth value as people write it; "" of another kind.
std::string TextOf(const TomlValue& value);

// "text", "a whole number", "a table": for messages.
std::string KindOf(const TomlValue& value);

}  // namespace gauntlet
