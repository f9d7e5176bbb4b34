// Protobuf strings must be UTF-8; what a run prints need not be.
#pragma once

#include <string>
#include <string_view>

namespace gauntlet::worker {

// True when `text` is well-formed UTF-8 (RFC 3629: no overlong forms, no surrogates, at most U+10FFFF).
bool IsUtf8(std::string_view text);

// `text` with every byte that is not part of well-formed UTF-8, and every control character except tab and
// line feed, replaced by '?'.
std::string ToUtf8(std::string_view text);

}  // namespace gauntlet::worker
