// Builds one SVG document, element by element. Coordinates are pixels, y down.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace gauntlet::analysis {

struct Pixel {
  double x = 0.0;
  double y = 0.0;
};

// Text made safe for XML 1.0: markup escaped, control characters and broken UTF-8 replaced by '?'.
std::string EscapeXml(std::string_view text);
// A coordinate with at most two decimals and no trailing zeros; never "-0"; 0 when not finite.
std::string SvgNumber(double value);

// Style arguments are attributes as they stand in the file, e.g. `class="wall"` or `fill="#fff"`; they come
// from our own code and are not escaped. Text is.
class SvgCanvas {
 public:
  // A white page. `style_sheet` is CSS beside what all pictures have in common: the classes title, outcome,
  // subtitle, heading, rule, axis and tick. The title is what a viewer shows as the picture's name.
  SvgCanvas(double width, double height, std::string_view title, std::string_view style_sheet);

  void OpenGroup(std::string_view style);
  void CloseGroup();
  void Line(Pixel a, Pixel b, std::string_view style);
  void Polyline(const std::vector<Pixel>& points, std::string_view style);
  void Polygon(const std::vector<Pixel>& points, std::string_view style);
  void Circle(Pixel center, double radius, std::string_view style);
  void Rectangle(Pixel corner, double width, double height, std::string_view style);
  void Text(Pixel baseline, std::string_view text, std::string_view style);
  // The finished document.
  std::string Take();

 private:
  std::string out_;
};

}  // namespace gauntlet::analysis
