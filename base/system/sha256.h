// SHA-256 (FIPS 180-4), by which files are told apart that somebody may have forged.
#pragma once

#include <string>
#include <string_view>

namespace gauntlet {

// 64 hexadecimal digits.
std::string Sha256(std::string_view bytes);
// Whether a text is what Sha256 gives.
bool IsSha256(std::string_view text);

}  // namespace gauntlet
