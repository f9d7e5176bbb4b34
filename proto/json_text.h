// JSON as files and people get it.
#pragma once

#include <string>

#include <nlohmann/json_fwd.hpp>

namespace gauntlet {

// The value on lines of its own, with a line break at the end. Never fails: a byte that is not UTF-8, in a
// word of another program say, becomes U+FFFD.
std::string JsonText(const nlohmann::ordered_json& value);

}  // namespace gauntlet
