#include "analysis/figures/blame_figure.h"

#include <algorithm>
#include <cmath>
#include <map>

#include <fmt/format.h>

#include "analysis/figures/arena_drawing.h"
#include "analysis/figures/figure_frame.h"
#include "analysis/figures/svg_canvas.h"
#include "sim/arena/arena.h"

namespace gauntlet::analysis {
namespace {

constexpr double kCell = 0.2;  // m

std::string BlameStyleSheet() {
  return fmt::format(R"({}.stuck {{ fill: {}; }}
.blamed {{ fill: {}; stroke: none; }}
.line {{ font-size: 13px; fill: {}; white-space: pre; }}
)",
                     ArenaStyleSheet(), kKeptColor, kLostColor, kInk);
}

// Cells are the darker the more often robots stayed there; the square root, so that a crowd does not hide the
// rest.
void DrawStuck(SvgCanvas& canvas, const FigureFrame& frame, const std::vector<sim::Vec2>& stuck) {
  std::map<std::pair<int, int>, int> cells;
  int most = 0;
  for (const sim::Vec2& place : stuck) {
    const auto cell = [](double coordinate) { return static_cast<int>(std::floor(coordinate / kCell)); };
    most = std::max(most, ++cells[{cell(place.x()), cell(place.y())}]);
  }
  for (const auto& [cell, count] : cells) {
    const Pixel corner = frame.At({cell.first * kCell, (cell.second + 1) * kCell});
    const double opacity = 0.8 * std::sqrt(static_cast<double>(count) / most);
    canvas.Rectangle(corner, kCell * frame.scale(), kCell * frame.scale(),
                     fmt::format("class=\"stuck\" fill-opacity=\"{}\"", SvgNumber(opacity)));
  }
}

}  // namespace

std::string DrawBlame(const BlameFigure& figure) {
  const FigureFrame frame(figure.test_case);
  const sim::Arena arena(figure.test_case);
  SvgCanvas canvas(frame.page_width() + 120, frame.page_height(), figure.title, BlameStyleSheet());
  canvas.Text({FigureFrame::kLeft, 34}, figure.title, "class=\"title\"");
  for (std::size_t i = 0; i < figure.sentences.size(); ++i)
    canvas.Text({FigureFrame::kLeft, 58 + 18 * static_cast<double>(i)}, figure.sentences[i],
                "class=\"line\"");
  DrawFloor(canvas, frame, arena);
  DrawStuck(canvas, frame, figure.stuck);
  DrawObstacles(canvas, frame, arena);
  for (std::size_t i = 0; i < figure.effects.size(); ++i) {
    const double effect = std::clamp(figure.effects[i], 0.0, 1.0);
    const std::vector<Pixel> corners = frame.At(arena.VisiblePart(i));
    if (corners.empty() || effect == 0.0) continue;
    canvas.Polygon(corners, fmt::format("class=\"blamed\" fill-opacity=\"{}\"", SvgNumber(effect)));
  }
  DrawObstacleNumbers(canvas, frame, arena);
  DrawAxes(canvas, frame);
  double y = FigureFrame::kTop + 16;
  for (const std::string& line : figure.lines) {
    canvas.Text({frame.right() + 24, y}, line, "class=\"line\"");
    y += 20;
  }
  return canvas.Take();
}

}  // namespace gauntlet::analysis
