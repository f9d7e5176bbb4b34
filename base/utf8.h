// Text that came from outside need not be UTF-8; protobuf's strings, JSON and terminals want it.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace gauntlet {

// Bytes of the well-formed sequence that begins at `position` of `text` (RFC 3629, section 4: no overlong
// forms, no surrogates, at most U+10FFFF); 0 when there is none. `position` < text.size().
std::size_t Utf8Length(std::string_view text, std::size_t position);

// Whether `text` is well-formed UTF-8.
bool IsUtf8(std::string_view text);

// `text` with every byte that is not part of well-formed UTF-8, and every control character except tab and
// line feed, replaced by '?'.
std::string ToUtf8(std::string_view text);

// "2:7": line and column, in characters, of the byte at `offset` of `text`; both count from 1.
std::string PlaceIn(std::string_view text, std::size_t offset);

}  // namespace gauntlet
