// A JSON text (RFC 8259) with the place of every value, so that errors can name line and column.
#pragma once

#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "base/result.h"

namespace gauntlet::proto {

struct TextPlace {
  int line = 1;    // from 1
  int column = 1;  // from 1, in characters (code points)
};

struct JsonMember;

struct JsonValue {
  struct Null {};
  struct Number {
    double value = 0.0;
    std::string text;  // as it was written
  };
  using Array = std::vector<JsonValue>;
  using Object = std::vector<JsonMember>;  // keys are unique

  std::variant<Null, bool, Number, std::string, Array, Object> value;
  TextPlace place;

  // "a number", "a text", ... for messages.
  std::string_view Kind() const;
};

struct JsonMember {
  std::string key;
  TextPlace place;  // of the key
  JsonValue value;
};

// "file:line:column: what" as one line, an invalid input.
Error ErrorAt(const std::string& file_name, TextPlace place, const std::string& what);

// Strict: no comments, no trailing commas, no repeated keys, valid UTF-8, nesting up to 64. A byte order mark
// is skipped.
Result<JsonValue> ParseJson(std::string_view text, const std::string& file_name);

}  // namespace gauntlet::proto
