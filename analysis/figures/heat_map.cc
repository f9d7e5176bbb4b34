#include "analysis/figures/heat_map.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>

#include <fmt/format.h>

#include "analysis/figures/svg_canvas.h"
#include "base/number_text.h"

namespace gauntlet::analysis {
namespace {

// Pixels.
constexpr double kTop = 118.0;
constexpr double kCellWidth = 68.0;
constexpr double kCellHeight = 46.0;
constexpr double kRowName = 8.0;  // a character of a row's name
constexpr double kBottom = 30.0;

constexpr std::string_view kStyle =
    R"(.cell { stroke: #ffffff; stroke-width: 2; }
.count { font-size: 14px; text-anchor: middle; }
.column { font-size: 12px; fill: #5b6470; text-anchor: middle; }
.row { font-size: 12px; fill: #5b6470; text-anchor: end; }
)";

struct Rgb {
  double red;
  double green;
  double blue;
};
// From light to dark within one range of hues that all colour-blind readers tell apart by brightness.
constexpr std::array<Rgb, 4> kRamp = {{{255, 241, 214}, {253, 190, 110}, {217, 95, 14}, {115, 28, 8}}};
constexpr std::string_view kEmptyFill = "#f3f4f6";
constexpr std::string_view kDarkText = "#000000";
constexpr std::string_view kLightText = "#ffffff";

// Relative luminance of WCAG 2, 0 to 1; channels from 0 to 255.
double Luminance(int red, int green, int blue) {
  const auto linear = [](int channel) {
    const double c = channel / 255.0;
    return c <= 0.03928 ? c / 12.92 : std::pow((c + 0.055) / 1.055, 2.4);
  };
  return 0.2126 * linear(red) + 0.7152 * linear(green) + 0.0722 * linear(blue);
}

}  // namespace

HeatColors HeatColorsOf(std::uint64_t count, std::uint64_t largest) {
  if (count == 0 || largest == 0) return {std::string(kEmptyFill), std::string(kDarkText)};
  // By the root: few runs are seen beside many.
  const double share = std::sqrt(static_cast<double>(count) / static_cast<double>(largest));
  const double place = std::min(share, 1.0) * (kRamp.size() - 1);
  const auto below = std::min(static_cast<std::size_t>(place), kRamp.size() - 2);
  const double rest = place - static_cast<double>(below);
  const auto mix = [rest](double from, double to) {
    return static_cast<int>(std::lround(from + rest * (to - from)));
  };
  const Rgb& a = kRamp[below];
  const Rgb& b = kRamp[below + 1];
  const int red = mix(a.red, b.red);
  const int green = mix(a.green, b.green);
  const int blue = mix(a.blue, b.blue);
  // On a fill of this luminance black and white are equally easy to read (W3C, WCAG 2: contrast ratio).
  constexpr double kMiddle = 0.179;
  return {fmt::format("#{:02x}{:02x}{:02x}", red, green, blue),
          std::string(Luminance(red, green, blue) > kMiddle ? kDarkText : kLightText)};
}

std::uint64_t HeatMap::Largest() const {
  std::uint64_t largest = 0;
  for (const std::vector<HeatCell>& row : cells) {
    for (const HeatCell& cell : row) largest = std::max(largest, cell.count);
  }
  return largest;
}

std::string DrawHeatMap(const HeatMap& map) {
  std::size_t longest = map.down_name.size();
  for (const std::string& row : map.rows) longest = std::max(longest, row.size());
  const std::uint64_t largest = map.Largest();
  constexpr double kMargin = 24.0;
  const double left = kMargin + kRowName * static_cast<double>(longest);
  const double width = std::max(left + kCellWidth * static_cast<double>(map.columns.size()) + kMargin, 640.0);
  const double height = kTop + kCellHeight * static_cast<double>(map.rows.size()) + kBottom;
  SvgCanvas canvas(width, height, map.title, kStyle);
  canvas.Text({kMargin, 34}, map.title, "class=\"title\"");
  canvas.Text({kMargin, 58}, map.outcome, "class=\"axis\"");
  canvas.Text({left, kTop - 30}, map.across_name, "class=\"axis\"");
  canvas.Text({left - 10, kTop - 10}, map.down_name, "class=\"row\"");
  for (std::size_t column = 0; column < map.columns.size(); ++column) {
    const double middle = left + kCellWidth * (static_cast<double>(column) + 0.5);
    canvas.Text({middle, kTop - 10}, map.columns[column], "class=\"column\"");
  }
  for (std::size_t row = 0; row < map.rows.size(); ++row) {
    const double y = kTop + kCellHeight * static_cast<double>(row);
    canvas.Text({left - 10, y + kCellHeight / 2 + 4}, map.rows[row], "class=\"row\"");
    for (std::size_t column = 0; column < map.columns.size(); ++column) {
      const double x = left + kCellWidth * static_cast<double>(column);
      const std::uint64_t count = map.cells[row][column].count;
      const HeatColors colors = HeatColorsOf(count, largest);
      canvas.Rectangle({x, y}, kCellWidth, kCellHeight,
                       fmt::format("class=\"cell\" fill=\"{}\"", colors.fill));
      if (count == 0) continue;
      canvas.Text({x + kCellWidth / 2, y + kCellHeight / 2 + 5}, FormatCount(count),
                  fmt::format("class=\"count\" style=\"fill: {}\"", colors.text));
    }
  }
  return canvas.Take();
}

}  // namespace gauntlet::analysis
