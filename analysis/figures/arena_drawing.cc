#include "analysis/figures/arena_drawing.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "analysis/figures/value_axis.h"

namespace gauntlet::analysis {
namespace {

void DrawBox(SvgCanvas& canvas, const FigureFrame& frame, const sim::Vec2& min, const sim::Vec2& max,
             std::string_view style) {
  const Pixel corner = frame.At({min.x(), max.y()});
  canvas.Rectangle(corner, (max.x() - min.x()) * frame.scale(), (max.y() - min.y()) * frame.scale(), style);
}

// Between the lines of the grid, m.
double GridStep(const FigureFrame& frame) {
  return RoundStep(2 * std::max(frame.half_x(), frame.half_y()), 12);
}

void DrawWalls(SvgCanvas& canvas, const FigureFrame& frame, const sim::Arena& arena) {
  const sim::Vec2 first = frame.min();
  const sim::Vec2 last = frame.max();
  const sim::Vec2& min = arena.interior_min();
  const sim::Vec2& max = arena.interior_max();
  DrawBox(canvas, frame, {first.x(), max.y()}, last, "class=\"wall\"");
  DrawBox(canvas, frame, first, {last.x(), min.y()}, "class=\"wall\"");
  DrawBox(canvas, frame, {max.x(), min.y()}, {last.x(), max.y()}, "class=\"wall\"");
  DrawBox(canvas, frame, {first.x(), min.y()}, {min.x(), max.y()}, "class=\"wall\"");
}

void DrawStanding(SvgCanvas& canvas, const FigureFrame& frame, const sim::Arena& arena) {
  for (std::size_t i = 0; i < arena.obstacles().size(); ++i) {
    const std::vector<Pixel> corners = frame.At(arena.VisiblePart(i));
    if (!corners.empty()) {
      canvas.Polygon(corners, fmt::format("class=\"obstacle\" id=\"obstacle-{}\"", i + 1));
    }
  }
}

// Where the moving ones go: the way of the centre, and their outline where they turn.
void DrawObstaclePaths(SvgCanvas& canvas, const FigureFrame& frame, const sim::Arena& arena) {
  for (const sim::Arena::Moving& moving : arena.moving()) {
    std::vector<Pixel> way;
    for (const sim::Vec2& point : moving.path) {
      way.push_back(frame.At(point));
      sim::OrientedBox box = arena.obstacles()[moving.obstacle];
      box.center = point;
      const auto corners = frame.At(ClipToRectangle(box, arena.interior_min(), arena.interior_max()));
      if (way.size() > 1 && !corners.empty()) canvas.Polygon(corners, "class=\"obstacle-end\"");
    }
    canvas.Polyline(way, fmt::format("class=\"obstacle-path\" id=\"path-{}\"", moving.obstacle + 1));
  }
}

// The lamps of lit obstacles, on the sides that are inside the walls.
void DrawLamps(SvgCanvas& canvas, const FigureFrame& frame, const sim::Arena& arena) {
  for (const sim::Arena::Lit& lit : arena.lit()) {
    const sim::OrientedBox& box = arena.obstacles()[lit.obstacle];
    const sim::Vec2 ahead = box.half_extents.x() * box.axis;
    const sim::Vec2 aside = box.half_extents.y() * sim::LeftOf(box.axis);
    for (const sim::Vec2& way : {ahead, aside, sim::Vec2(-ahead), sim::Vec2(-aside)}) {
      const sim::Vec2 place = box.center + way;
      if (!arena.InInterior(place)) continue;
      canvas.Circle(frame.At(place), 5.0, fmt::format("class=\"lamp\" fill=\"{}\"", sim::NameOf(lit.color)));
    }
  }
}

}  // namespace

std::string_view ArenaStyleSheet() {
  return R"(.floor { fill: #fdfcf9; }
.grid { stroke: #ebe7dd; stroke-width: 1; }
.wall { fill: #3a424c; }
.obstacle { fill: #cbc4b6; stroke: #857c6c; stroke-width: 1.2; stroke-linejoin: round; }
.obstacle-end { fill: none; stroke: #857c6c; stroke-width: 1.2; stroke-dasharray: 3 3; }
.obstacle-path { fill: none; stroke: #857c6c; stroke-width: 1.6; stroke-dasharray: 1 4; stroke-linecap: round; }
.lamp { stroke: #ffffff; stroke-width: 1; }
.obstacle-number { font-size: 13px; font-weight: bold; fill: #4d463a; text-anchor: middle; stroke: #efebe3; stroke-width: 3; paint-order: stroke; }
)";
}

void DrawFloor(SvgCanvas& canvas, const FigureFrame& frame, const sim::Arena& arena) {
  const double step = GridStep(frame);
  const sim::Vec2& min = arena.interior_min();
  const sim::Vec2& max = arena.interior_max();
  DrawBox(canvas, frame, min, max, "class=\"floor\"");
  for (double x = std::ceil(min.x() / step) * step; x <= max.x(); x += step) {
    canvas.Line(frame.At({x, min.y()}), frame.At({x, max.y()}), "class=\"grid\"");
  }
  for (double y = std::ceil(min.y() / step) * step; y <= max.y(); y += step) {
    canvas.Line(frame.At({min.x(), y}), frame.At({max.x(), y}), "class=\"grid\"");
  }
}

void DrawObstacles(SvgCanvas& canvas, const FigureFrame& frame, const sim::Arena& arena) {
  DrawObstaclePaths(canvas, frame, arena);
  DrawStanding(canvas, frame, arena);
  DrawLamps(canvas, frame, arena);
  DrawWalls(canvas, frame, arena);
}

std::vector<Pixel> DrawObstacleNumbers(SvgCanvas& canvas, const FigureFrame& frame, const sim::Arena& arena,
                                       const std::vector<std::size_t>& kept) {
  std::vector<Pixel> places;
  for (std::size_t i = 0; i < arena.obstacles().size(); ++i) {
    const sim::Polygon corners = arena.VisiblePart(i);
    if (corners.empty()) continue;
    sim::Vec2 sum = sim::Vec2::Zero();
    for (const sim::Vec2& corner : corners) sum += corner;
    const Pixel p = places.emplace_back(frame.At(sum / static_cast<double>(corners.size())));
    canvas.Text({p.x, p.y + 4.5}, fmt::format("{}", (kept.empty() ? i : kept[i]) + 1),
                "class=\"obstacle-number\"");
  }
  return places;
}

void DrawAxes(SvgCanvas& canvas, const FigureFrame& frame) {
  const double step = GridStep(frame);
  const auto label = [step](double value) {
    const int decimals = step < 0.1 ? 2 : step < 1.0 ? 1 : 0;
    const double shown = std::abs(value) < step / 100 ? 0.0 : value;
    std::string text = fmt::format("{:.{}f}", std::abs(shown), decimals);
    return shown < 0 ? "\u2212" + text : text;
  };
  const sim::Vec2 min = frame.min();
  const sim::Vec2 max = frame.max();
  for (double x = std::ceil(min.x() / step) * step; x <= max.x(); x += step) {
    const Pixel p = frame.At({x, min.y()});
    canvas.Line(p, {p.x, p.y + 6}, "class=\"tick\"");
    canvas.Text({p.x, p.y + 20}, label(x), "class=\"axis\" text-anchor=\"middle\"");
  }
  for (double y = std::ceil(min.y() / step) * step; y <= max.y(); y += step) {
    const Pixel p = frame.At({min.x(), y});
    canvas.Line(p, {p.x - 6, p.y}, "class=\"tick\"");
    canvas.Text({p.x - 10, p.y + 4.5}, label(y), "class=\"axis\" text-anchor=\"end\"");
  }
  const double middle_x = (FigureFrame::kLeft + frame.right()) / 2;
  const double middle_y = (FigureFrame::kTop + frame.bottom()) / 2;
  canvas.Text({middle_x, frame.bottom() + 42}, "x (m)", "class=\"axis\" text-anchor=\"middle\"");
  canvas.Text({24, middle_y}, "y (m)",
              fmt::format("class=\"axis\" text-anchor=\"middle\" transform=\"rotate(-90 24 {})\"",
                          SvgNumber(middle_y)));

  const double bar = RoundStep(frame.half_x(), 4);
  const double y = frame.bottom() + 44;
  const double right = frame.right();
  const double left = right - bar * frame.scale();
  canvas.OpenGroup("class=\"scale\" stroke=\"#22272e\" stroke-width=\"2\"");
  canvas.Line({left, y}, {right, y}, "");
  canvas.Line({left, y - 5}, {left, y + 5}, "");
  canvas.Line({right, y - 5}, {right, y + 5}, "");
  canvas.CloseGroup();
  canvas.Text({(left + right) / 2, y + 18}, fmt::format("{:g} m", bar), "text-anchor=\"middle\"");
}

}  // namespace gauntlet::analysis
