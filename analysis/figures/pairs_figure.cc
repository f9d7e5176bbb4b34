#include "analysis/figures/pairs_figure.h"

#include <algorithm>

#include <fmt/format.h>

#include "analysis/figures/svg_canvas.h"

namespace gauntlet::analysis {
namespace {

// Pixels.
constexpr double kPageLeft = 72.0;
constexpr double kPageTop = 128.0;
constexpr double kSquare = 150.0;
constexpr double kGap = 14.0;
constexpr double kPageBottom = 56.0;
constexpr double kLeastWidth = 760.0;
constexpr std::size_t kParts = 20;
constexpr std::size_t kMostNameCharacters = 23;  // above a square

constexpr std::string_view kPairsStyle =
    R"(.square { fill: none; stroke: #c5ccd3; stroke-width: 1; }
.draw { fill: #2b6cb0; fill-opacity: 0.22; }
.part { fill: #2b6cb0; fill-opacity: 0.55; }
.chosen { fill: none; stroke: #d1410c; stroke-width: 2; }
.end { font-size: 11px; fill: #5b6470; }
.begin { font-size: 11px; fill: #5b6470; text-anchor: end; }
.name { font-size: 12px; fill: #22272e; }
)";

class PairsDrawing {
 public:
  explicit PairsDrawing(const PairsFigure& figure)
      : figure_(figure),
        side_(static_cast<double>(figure.axes.size()) * (kSquare + kGap)),
        canvas_(std::max(kPageLeft + side_ + 40, kLeastWidth), kPageTop + side_ + kPageBottom, figure.title,
                kPairsStyle) {}

  std::string Draw() {
    canvas_.Text({kPageLeft, 38}, figure_.title, "class=\"title\"");
    canvas_.Text({kPageLeft, 64}, figure_.outcome, "class=\"axis\"");
    for (std::size_t row = 0; row < figure_.axes.size(); ++row) {
      for (std::size_t column = 0; column <= row; ++column) DrawSquare(row, column);
    }
    canvas_.Text({kPageLeft, kPageTop + side_ + kPageBottom - 12},
                 "bars: how the accepted settings are spread; points: they themselves; red: the chosen one",
                 "class=\"axis\"");
    return canvas_.Take();
  }

 private:
  void DrawSquare(std::size_t row, std::size_t column) {
    const Pixel corner{kPageLeft + static_cast<double>(column) * (kSquare + kGap),
                       kPageTop + static_cast<double>(row) * (kSquare + kGap)};
    canvas_.Rectangle(corner, kSquare, kSquare, "class=\"square\"");
    row == column ? DrawSpread(row, corner) : DrawPoints(row, column, corner);
    if (row + 1 == figure_.axes.size()) {
      canvas_.Text({corner.x, corner.y + kSquare + 13}, figure_.axes[column].low, "class=\"end\"");
      canvas_.Text({corner.x + kSquare, corner.y + kSquare + 13}, figure_.axes[column].high,
                   "class=\"begin\"");
    }
    if (column > 0 || row == 0) return;
    canvas_.Text({corner.x - 4, corner.y + 10}, figure_.axes[row].high, "class=\"begin\"");
    canvas_.Text({corner.x - 4, corner.y + kSquare}, figure_.axes[row].low, "class=\"begin\"");
  }

  void DrawSpread(std::size_t axis, Pixel corner) {
    std::vector<double> parts(kParts, 0.0);
    for (const std::vector<double>& point : figure_.points) {
      const auto part = static_cast<std::size_t>(std::clamp(point[axis], 0.0, 1.0) * kParts);
      ++parts[std::min(part, kParts - 1)];
    }
    const double most = std::max(*std::ranges::max_element(parts), 1.0);
    const double width = kSquare / static_cast<double>(kParts);
    for (std::size_t i = 0; i < kParts; ++i) {
      const double height = (kSquare - 4) * parts[i] / most;
      if (height > 0.0)
        canvas_.Rectangle({corner.x + width * static_cast<double>(i), corner.y + kSquare - height}, width,
                          height, "class=\"part\"");
    }
    if (!figure_.chosen.empty()) {
      const double x = corner.x + kSquare * figure_.chosen[axis];
      canvas_.Line({x, corner.y}, {x, corner.y + kSquare}, "class=\"chosen\"");
    }
    std::string name = figure_.axes[axis].name;
    if (name.size() > kMostNameCharacters) name = "…" + name.substr(name.size() - kMostNameCharacters);
    canvas_.Text({corner.x, corner.y - 5}, name, "class=\"name\"");
  }

  void DrawPoints(std::size_t row, std::size_t column, Pixel corner) {
    const auto at = [&](const std::vector<double>& point) {
      return Pixel{corner.x + kSquare * point[column], corner.y + kSquare * (1.0 - point[row])};
    };
    for (const std::vector<double>& point : figure_.points) canvas_.Circle(at(point), 1.6, "class=\"draw\"");
    if (!figure_.chosen.empty()) canvas_.Circle(at(figure_.chosen), 5.0, "class=\"chosen\"");
  }

  const PairsFigure& figure_;
  double side_;
  SvgCanvas canvas_;
};

}  // namespace

std::string DrawPairs(const PairsFigure& figure) {
  return PairsDrawing(figure).Draw();
}

}  // namespace gauntlet::analysis
