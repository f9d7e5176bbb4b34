#include <argos3/core/utility/datatypes/color.h>

#include <utility>

namespace argos {
namespace {

const std::pair<const char*, const CColor*> kNames[] = {
    {"black", &CColor::BLACK},   {"white", &CColor::WHITE},   {"red", &CColor::RED},
    {"green", &CColor::GREEN},   {"blue", &CColor::BLUE},     {"magenta", &CColor::MAGENTA},
    {"cyan", &CColor::CYAN},     {"yellow", &CColor::YELLOW}, {"orange", &CColor::ORANGE},
    {"brown", &CColor::BROWN},   {"purple", &CColor::PURPLE}, {"gray10", &CColor::GRAY10},
    {"gray20", &CColor::GRAY20}, {"gray30", &CColor::GRAY30}, {"gray40", &CColor::GRAY40},
    {"gray50", &CColor::GRAY50}, {"gray60", &CColor::GRAY60}, {"gray70", &CColor::GRAY70},
    {"gray80", &CColor::GRAY80}, {"gray90", &CColor::GRAY90},
};

UInt8 Mixed(UInt8 front, UInt8 back, Real opacity) {
  return static_cast<UInt8>(opacity * front + (1.0 - opacity) * back);
}

}  // namespace

void CColor::Set(const std::string& text) {
  for (const auto& [name, color] : kNames) {
    if (text == name) {
      *this = *color;
      return;
    }
  }
  std::vector<std::string> parts;
  Tokenize(text, parts, ",");
  UInt8 values[4] = {0, 0, 0, 255};
  bool good = parts.size() == 3 || parts.size() == 4;
  for (std::size_t i = 0; good && i < parts.size(); ++i) {
    std::istringstream stream(parts[i]);
    int value = -1;
    good = (stream >> value) && value >= 0 && value <= 255;
    values[i] = static_cast<UInt8>(value);
  }
  if (!good)
    throw CARGoSException("\"" + text + "\" is no color: a name or red,green,blue[,alpha], 0 to 255");
  Set(values[0], values[1], values[2], values[3]);
}

CColor& CColor::Blend(const CColor& background) {
  const Real opacity = alpha_ / 255.0;
  Set(Mixed(red_, background.red_, opacity), Mixed(green_, background.green_, opacity),
      Mixed(blue_, background.blue_, opacity));
  return *this;
}

std::ostream& operator<<(std::ostream& stream, const CColor& color) {
  for (const auto& [name, named] : kNames) {
    if (color == *named) return stream << name;
  }
  return stream << color.GetRed() << "," << color.GetGreen() << "," << color.GetBlue() << ","
                << color.GetAlpha();
}

std::istream& operator>>(std::istream& stream, CColor& color) {
  std::string text;
  if (stream >> text) color.Set(text);
  return stream;
}

}  // namespace argos
