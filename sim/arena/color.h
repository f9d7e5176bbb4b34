// Colours of LEDs and lamps, as cameras tell them apart.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string_view>

namespace gauntlet::sim {

enum class Color : std::uint8_t {
  kBlack = 0,  // off
  kRed,
  kGreen,
  kBlue,
  kYellow,
  kWhite,
  kMagenta,
  kCyan,
  kOrange
};

// In the order of the enumeration. Stored in case files: do not rename.
inline constexpr std::array<std::string_view, 9> kColorNames = {
    "black", "red", "green", "blue", "yellow", "white", "magenta", "cyan", "orange"};

inline std::string_view NameOf(Color color) {
  return kColorNames.at(static_cast<std::size_t>(color));
}

inline std::optional<Color> ColorNamed(std::string_view name) {
  for (std::size_t i = 0; i < kColorNames.size(); ++i) {
    if (kColorNames[i] == name) return static_cast<Color>(i);
  }
  return std::nullopt;
}

}  // namespace gauntlet::sim
