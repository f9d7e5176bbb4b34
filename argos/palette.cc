#include "argos/palette.h"

#include <string>

namespace gauntlet::argos_form {
namespace {

constexpr std::size_t kMostColors = 256;

}  // namespace

Palette::Palette() {
  colors_.reserve(kMostColors);
  for (const std::string_view name : sim::kColorNames) colors_.emplace_back().Set(std::string(name));
}

sim::Color Palette::NumberOf(const argos::CColor& color) {
  for (std::size_t i = 0; i < colors_.size(); ++i) {
    if (colors_[i] == color) return static_cast<sim::Color>(i);
  }
  if (colors_.size() == kMostColors) {
    throw argos::CARGoSException("LEDs of a run show at most 256 different colors");
  }
  colors_.push_back(color);
  return static_cast<sim::Color>(colors_.size() - 1);
}

}  // namespace gauntlet::argos_form
