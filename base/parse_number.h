// Numbers out of text that holds nothing else.
#pragma once

#include <charconv>
#include <optional>
#include <string_view>
#include <system_error>

namespace gauntlet {

// The decimal number that the whole text is, as std::from_chars reads it (no blanks, no '+'); nothing when it
// is none, or none that the type can hold.
template <typename Number>
std::optional<Number> ParseNumber(std::string_view text) {
  Number number{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return number;
}

}  // namespace gauntlet
