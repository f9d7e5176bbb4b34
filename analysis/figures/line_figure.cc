#include "analysis/figures/line_figure.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string_view>

#include <fmt/format.h>

#include "analysis/figures/figure_frame.h"
#include "analysis/figures/svg_canvas.h"
#include "analysis/figures/value_axis.h"

namespace gauntlet::analysis {
namespace {

// Pixels.
constexpr double kLeft = 78.0;
constexpr double kTop = 92.0;
constexpr double kWidth = 640.0;
constexpr double kHeight = 190.0;
constexpr double kGap = 52.0;     // between panels
constexpr double kNames = 150.0;  // right of the lines
constexpr double kBottom = 62.0;
constexpr double kNameHeight = 17.0;

constexpr std::string_view kStyle =
    R"(.line { fill: none; stroke-width: 2.2; stroke-linejoin: round; }
.band { fill-opacity: 0.16; stroke: none; }
.label { font-size: 13px; font-weight: bold; }
.value { font-size: 12px; fill: #5b6470; text-anchor: end; }
.below { font-size: 12px; fill: #5b6470; text-anchor: middle; }
)";

// A line of a panel looks the same in all figures; dashes help where colours do not.
constexpr std::array<std::string_view, 4> kColors = {kLostColor, kKeptColor, kGuideColor, kSplitColor};
constexpr std::array<std::string_view, 4> kDashes = {"", "7 4", "2 3", "9 3 2 3"};

struct Range {
  double low = std::numeric_limits<double>::infinity();
  double high = -std::numeric_limits<double>::infinity();

  void Add(const std::vector<double>& values) {
    for (const double value : values) {
      if (!std::isfinite(value)) continue;
      low = std::min(low, value);
      high = std::max(high, value);
    }
  }
  // Some extent, whatever was added.
  Range Widened() const {
    if (!(low <= high)) return {0.0, 1.0};
    if (low == high) return {low - 0.5, high + 0.5};
    return *this;
  }
};

Range RangeOf(const LinePanel& panel) {
  Range range;
  if (panel.least < panel.most) range.Add({panel.least, panel.most});
  for (const FigureLine& line : panel.lines) {
    for (const auto* values : {&line.y, &line.low, &line.high}) range.Add(*values);
  }
  return range.Widened();
}

class Panel {
 public:
  Panel(SvgCanvas& canvas, const LinePanel& panel, Range x, double top)
      : canvas_(canvas), panel_(panel), x_(x), y_(RangeOf(panel)), top_(top) {}

  void Draw() {
    DrawAxes();
    for (std::size_t i = 0; i < panel_.lines.size(); ++i) DrawLine(panel_.lines[i], i);
    DrawNames();
  }

 private:
  Pixel At(double x, double y) const {
    return {kLeft + kWidth * (x - x_.low) / (x_.high - x_.low),
            top_ + kHeight * (y_.high - y) / (y_.high - y_.low)};
  }

  void DrawAxes() {
    canvas_.Text({kLeft - 60, top_ - 12}, panel_.axis_name, "class=\"axis\"");
    for (const double value : RoundValues(y_.low, y_.high, 5)) {
      const double y = At(0, value).y;
      canvas_.Line({kLeft, y}, {kLeft + kWidth, y}, "class=\"rule\"");
      canvas_.Text({kLeft - 8, y + 4}, fmt::format("{:.6g}", value), "class=\"value\"");
    }
    for (const double value : RoundValues(x_.low, x_.high, 8)) {
      const double x = At(value, 0).x;
      canvas_.Line({x, top_ + kHeight}, {x, top_ + kHeight + 5}, "class=\"tick\"");
      canvas_.Text({x, top_ + kHeight + 19}, fmt::format("{:.6g}", value), "class=\"below\"");
    }
    canvas_.Line({kLeft, top_ + kHeight}, {kLeft + kWidth, top_ + kHeight}, "class=\"tick\"");
  }

  void DrawLine(const FigureLine& line, std::size_t number) {
    const std::string_view color = kColors[number % kColors.size()];
    if (!line.low.empty()) {
      std::vector<Pixel> band;
      for (std::size_t i = 0; i < line.x.size(); ++i) {
        if (std::isfinite(line.high[i])) band.push_back(At(line.x[i], line.high[i]));
      }
      for (std::size_t i = line.x.size(); i-- > 0;) {
        if (std::isfinite(line.low[i])) band.push_back(At(line.x[i], line.low[i]));
      }
      canvas_.Polygon(band, fmt::format("class=\"band\" fill=\"{}\"", color));
    }
    std::vector<Pixel> points;
    const auto end_piece = [&] {
      const std::string style =
          fmt::format("class=\"line\" stroke=\"{}\" stroke-dasharray=\"{}\"", color, kDashes[number % 4]);
      if (points.size() == 1) {
        canvas_.Circle(points.front(), 3, fmt::format("fill=\"{}\"", color));
      } else if (!points.empty()) {
        canvas_.Polyline(points, style);
      }
      if (!points.empty()) ends_.push_back({points.back().y, number});
      points.clear();
    };
    const std::size_t ends_before = ends_.size();
    for (std::size_t i = 0; i < line.x.size(); ++i) {
      if (std::isfinite(line.y[i])) {
        points.push_back(At(line.x[i], line.y[i]));
      } else {
        end_piece();
      }
    }
    end_piece();
    // The name stands at the last piece.
    if (ends_.size() > ends_before + 1) {
      ends_.erase(ends_.begin() + static_cast<std::ptrdiff_t>(ends_before), ends_.end() - 1);
    }
  }

  // At the heights of the lines' ends, moved apart where they would cover each other.
  void DrawNames() {
    std::ranges::sort(ends_);
    double least = top_;
    for (auto& [y, number] : ends_) {
      y = std::max(y, least);
      least = y + kNameHeight;
    }
    double most = top_ + kHeight;
    for (auto end = ends_.rbegin(); end != ends_.rend(); ++end) {
      end->first = std::min(end->first, most);
      most = end->first - kNameHeight;
    }
    for (const auto& [y, number] : ends_) {
      canvas_.Text({kLeft + kWidth + 10, y + 4}, panel_.lines[number].name,
                   fmt::format("class=\"label\" style=\"fill: {}\"", kColors[number % kColors.size()]));
    }
  }

  SvgCanvas& canvas_;
  const LinePanel& panel_;
  Range x_;
  Range y_;
  double top_;
  std::vector<std::pair<double, std::size_t>> ends_;  // height of a line's end, number of the line
};

}  // namespace

std::string DrawLines(const LineFigure& figure) {
  const auto panels = static_cast<double>(figure.panels.size());
  const double height = kTop + panels * kHeight + (panels - 1) * kGap + kBottom;
  SvgCanvas canvas(kLeft + kWidth + kNames, height, figure.title, kStyle);
  canvas.Text({kLeft - 60, 34}, figure.title, "class=\"title\"");
  canvas.Text({kLeft - 60, 58}, figure.outcome, "class=\"axis\"");
  Range x;
  for (const LinePanel& panel : figure.panels) {
    for (const FigureLine& line : panel.lines) x.Add(line.x);
  }
  double top = kTop;
  for (const LinePanel& panel : figure.panels) {
    Panel(canvas, panel, x.Widened(), top).Draw();
    top += kHeight + kGap;
  }
  canvas.Text({kLeft + kWidth / 2, height - 16}, figure.x_name, "class=\"below\"");
  return canvas.Take();
}

}  // namespace gauntlet::analysis
