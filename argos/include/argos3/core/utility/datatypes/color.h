// Colours: red, green, blue and opacity, 0 to 255 each.
#pragma once

#include <iostream>
#include <string>

#include <argos3/core/utility/configuration/argos_exception.h>
#include <argos3/core/utility/datatypes/datatypes.h>
#include <argos3/core/utility/string_utilities.h>

namespace argos {

class CColor {
 public:
  static CColor BLACK, WHITE, RED, GREEN, BLUE, MAGENTA, CYAN, YELLOW, ORANGE, BROWN, PURPLE;
  static CColor GRAY10, GRAY20, GRAY30, GRAY40, GRAY50, GRAY60, GRAY70, GRAY80, GRAY90;

  constexpr CColor() = default;
  explicit constexpr CColor(UInt8 red, UInt8 green, UInt8 blue, UInt8 alpha = 255)
      : red_(red), green_(green), blue_(blue), alpha_(alpha) {}

  UInt8 GetRed() const { return red_; }
  UInt8 GetGreen() const { return green_; }
  UInt8 GetBlue() const { return blue_; }
  UInt8 GetAlpha() const { return alpha_; }
  void SetRed(UInt8 red) { red_ = red; }
  void SetGreen(UInt8 green) { green_ = green; }
  void SetBlue(UInt8 blue) { blue_ = blue; }
  void SetAlpha(UInt8 alpha) { alpha_ = alpha; }
  void Set(UInt8 red, UInt8 green, UInt8 blue, UInt8 alpha = 255) { *this = CColor(red, green, blue, alpha); }
  // A name or "r,g,b,a"; throws when it is neither.
  void Set(const std::string& text);

  UInt8 ToGrayScale() const { return static_cast<UInt8>(0.299 * red_ + 0.587 * green_ + 0.114 * blue_); }
  // Puts it on that background by its opacity, in place.
  CColor& Blend(const CColor& background);

  bool operator==(const CColor& other) const { return UInt32(*this) == UInt32(other); }
  operator UInt32() const {
    return static_cast<UInt32>(red_) << 24 | static_cast<UInt32>(green_) << 16 |
           static_cast<UInt32>(blue_) << 8 | static_cast<UInt32>(alpha_);
  }

 private:
  UInt8 red_ = 0;
  UInt8 green_ = 0;
  UInt8 blue_ = 0;
  UInt8 alpha_ = 255;
};

inline constinit CColor CColor::BLACK(0, 0, 0);
inline constinit CColor CColor::WHITE(255, 255, 255);
inline constinit CColor CColor::RED(255, 0, 0);
inline constinit CColor CColor::GREEN(0, 255, 0);
inline constinit CColor CColor::BLUE(0, 0, 255);
inline constinit CColor CColor::MAGENTA(255, 0, 255);
inline constinit CColor CColor::CYAN(0, 255, 255);
inline constinit CColor CColor::YELLOW(255, 255, 0);
inline constinit CColor CColor::ORANGE(255, 140, 0);
inline constinit CColor CColor::BROWN(165, 42, 42);
inline constinit CColor CColor::PURPLE(160, 32, 240);
inline constinit CColor CColor::GRAY10(26, 26, 26);
inline constinit CColor CColor::GRAY20(51, 51, 51);
inline constinit CColor CColor::GRAY30(77, 77, 77);
inline constinit CColor CColor::GRAY40(102, 102, 102);
inline constinit CColor CColor::GRAY50(127, 127, 127);
inline constinit CColor CColor::GRAY60(153, 153, 153);
inline constinit CColor CColor::GRAY70(179, 179, 179);
inline constinit CColor CColor::GRAY80(204, 204, 204);
inline constinit CColor CColor::GRAY90(229, 229, 229);

// The name of a colour that has one, otherwise r,g,b,a. Reads either.
std::ostream& operator<<(std::ostream& stream, const CColor& color);
std::istream& operator>>(std::istream& stream, CColor& color);

}  // namespace argos
