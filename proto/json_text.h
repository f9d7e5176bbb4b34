// JSON as files and people have it.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "base/result.h"

namespace gauntlet {

// The value on lines of its own, with a line break at the end. Never fails: a byte that is not UTF-8, in a
// word of another program say, becomes U+FFFD.
std::string JsonText(const nlohmann::ordered_json& value);

// Strict: no comments, no trailing commas, no repeated keys, valid UTF-8, nesting up to 64. A byte order mark
// is skipped. Error (kInvalidInput): names the file, and line and column (in characters) of what is no JSON
// or the path of what is not taken, "case.json: obstacles[3].x is given twice". No value is repeated in it:
// it may be a part of a key.
Result<nlohmann::json> ParseJson(std::string_view text, const std::string& file_name);

// The text that an object has at `key`; "" when it has none, or is no object.
std::string TextAt(const nlohmann::json& json, const char* key);

}  // namespace gauntlet
