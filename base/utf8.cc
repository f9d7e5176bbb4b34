#include "base/utf8.h"

#include <algorithm>
#include <cstdint>

namespace gauntlet {

std::size_t Utf8Length(std::string_view text, std::size_t position) {
  const auto byte = [&](std::size_t i) -> unsigned {
    return position + i < text.size() ? static_cast<std::uint8_t>(text[position + i]) : 0u;
  };
  const auto continues = [&](std::size_t i) { return byte(i) >= 0x80 && byte(i) <= 0xBF; };
  const unsigned lead = byte(0);
  if (lead < 0x80) return 1;
  if (lead >= 0xC2 && lead <= 0xDF) return continues(1) ? 2 : 0;
  if (lead >= 0xE0 && lead <= 0xEF) {
    const unsigned low = lead == 0xE0 ? 0xA0 : 0x80;
    const unsigned high = lead == 0xED ? 0x9F : 0xBF;
    return byte(1) >= low && byte(1) <= high && continues(2) ? 3 : 0;
  }
  if (lead >= 0xF0 && lead <= 0xF4) {
    const unsigned low = lead == 0xF0 ? 0x90 : 0x80;
    const unsigned high = lead == 0xF4 ? 0x8F : 0xBF;
    return byte(1) >= low && byte(1) <= high && continues(2) && continues(3) ? 4 : 0;
  }
  return 0;
}

namespace {

bool IsControl(char c) {
  const auto value = static_cast<std::uint8_t>(c);
  return (value < 0x20 && c != '\n' && c != '\t') || value == 0x7F;
}

}  // namespace

bool IsUtf8(std::string_view text) {
  for (std::size_t position = 0; position < text.size();) {
    const std::size_t length = Utf8Length(text, position);
    if (length == 0) return false;
    position += length;
  }
  return true;
}

std::string ToUtf8(std::string_view text) {
  std::string clean;
  clean.reserve(text.size());
  for (std::size_t position = 0; position < text.size();) {
    const std::size_t length = Utf8Length(text, position);
    if (length == 0 || (length == 1 && IsControl(text[position]))) {
      clean.push_back('?');
      ++position;
    } else {
      clean.append(text.substr(position, length));
      position += length;
    }
  }
  return clean;
}

std::string PlaceIn(std::string_view text, std::size_t offset) {
  const std::string_view before = text.substr(0, offset);
  const std::string_view line = before.substr(before.rfind('\n') + 1);  // npos + 1 is the beginning
  const auto begins_character = [](char c) { return (static_cast<std::uint8_t>(c) & 0xC0U) != 0x80U; };
  return std::to_string(std::ranges::count(before, '\n') + 1) + ":" +
         std::to_string(std::ranges::count_if(line, begins_character) + 1);
}

}  // namespace gauntlet
