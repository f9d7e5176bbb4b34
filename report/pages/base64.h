// Bytes as text.
#pragma once

#include <span>
#include <string>
#include <string_view>

namespace gauntlet {

// RFC 4648, with padding.
std::string Base64(std::span<const unsigned char> bytes);

// "sha256-...", as a Content-Security-Policy names the one script that it lets run.
std::string ScriptHash(std::string_view script);

}  // namespace gauntlet
