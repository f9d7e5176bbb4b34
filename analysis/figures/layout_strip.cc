#include "analysis/figures/layout_strip.h"

#include <algorithm>

#include <fmt/format.h>

#include "analysis/figures/arena_drawing.h"
#include "analysis/figures/figure_frame.h"
#include "analysis/figures/svg_canvas.h"
#include "sim/arena/arena.h"

namespace gauntlet::analysis {
namespace {

constexpr double kScale = 0.4;  // of a run's picture
constexpr std::size_t kColumns = 4;
constexpr double kMargin = 24.0;   // pixels
constexpr double kTitle = 44.0;    // above all
constexpr double kCaption = 46.0;  // above each picture

std::string StyleSheet() {
  return fmt::format(R"({}.gone {{ opacity: 0.22; }}
.failure {{ fill: {}; fill-opacity: 0.75; stroke: #ffffff; stroke-width: 2; }}
.step {{ font-size: 14px; font-weight: bold; fill: {}; }}
.found {{ font-size: 13px; fill: {}; }}
)",
                     ArenaStyleSheet(), kLostColor, kInk, kSoftInk);
}

// The arena with its walls at the origin of its group.
void DrawArena(SvgCanvas& canvas, const LayoutStrip& strip, const LayoutPicture& picture, bool with_places) {
  const FigureFrame frame(strip.original);
  sim::TestCase shown = strip.original;
  shown.obstacles = picture.obstacles;
  const sim::Arena whole(strip.original);
  const sim::Arena arena(shown);
  DrawFloor(canvas, frame, arena);
  canvas.OpenGroup("class=\"gone\"");
  DrawObstacles(canvas, frame, whole);
  canvas.CloseGroup();
  DrawObstacles(canvas, frame, arena);
  if (with_places)
    for (const sim::Vec2& place : strip.places) canvas.Circle(frame.At(place), 9.0, "class=\"failure\"");
  DrawObstacleNumbers(canvas, frame, arena, picture.kept);
}

}  // namespace

std::string DrawLayoutStrip(const LayoutStrip& strip) {
  const FigureFrame frame(strip.original);
  const double width = kScale * 2 * frame.half_x() * frame.scale();
  const double height = kScale * 2 * frame.half_y() * frame.scale();
  const std::size_t columns = std::clamp<std::size_t>(strip.pictures.size(), 2, kColumns);
  const std::size_t rows = (strip.pictures.size() + columns - 1) / columns;
  SvgCanvas canvas(kMargin + static_cast<double>(columns) * (width + kMargin),
                   kTitle + static_cast<double>(rows) * (kCaption + height + kMargin), strip.title,
                   StyleSheet());
  canvas.Text({kMargin, 30}, strip.title, "class=\"title\"");
  for (std::size_t i = 0; i < strip.pictures.size(); ++i) {
    const LayoutPicture& picture = strip.pictures[i];
    const Pixel corner{kMargin + static_cast<double>(i % columns) * (width + kMargin),
                       kTitle + static_cast<double>(i / columns) * (kCaption + height + kMargin)};
    canvas.Text({corner.x, corner.y + 18}, picture.heading, "class=\"step\"");
    canvas.Text({corner.x, corner.y + 37}, picture.outcome, "class=\"found\"");
    canvas.OpenGroup(fmt::format("transform=\"translate({} {}) scale({})\"",
                                 SvgNumber(corner.x - kScale * FigureFrame::kLeft),
                                 SvgNumber(corner.y + kCaption - kScale * FigureFrame::kTop), kScale));
    DrawArena(canvas, strip, picture, i + 1 == strip.pictures.size());
    canvas.CloseGroup();
  }
  return canvas.Take();
}

}  // namespace gauntlet::analysis
