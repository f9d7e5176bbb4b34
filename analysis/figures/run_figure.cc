#include "analysis/figures/run_figure.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "analysis/figures/figure_frame.h"
#include "analysis/figures/robot_states.h"
#include "analysis/figures/run_panel.h"
#include "analysis/figures/run_tracks.h"
#include "analysis/figures/svg_canvas.h"
#include "sim/arena/arena.h"
#include "sim/geometry/trigonometry.h"

namespace gauntlet::analysis {
namespace {

std::string StyleSheet() {
  return fmt::format(
      "text {{ font-family: 'DejaVu Sans', Verdana, Helvetica, Arial, sans-serif; font-size: 13px; fill: "
      "{ink}; }}\n"
      ".title {{ font-size: 23px; font-weight: bold; }}\n"
      ".outcome {{ font-size: 17px; font-weight: bold; }}\n"
      ".subtitle {{ font-size: 13px; fill: {soft}; text-anchor: end; }}\n"
      ".heading {{ font-size: 11.5px; font-weight: bold; letter-spacing: 1.2px; fill: {soft}; }}\n"
      ".rule {{ stroke: #d5d9de; stroke-width: 1; }}\n"
      ".name {{ font-size: 12px; fill: {soft}; }}\n"
      ".value {{ font-size: 12px; text-anchor: end; }}\n"
      ".axis {{ font-size: 12px; fill: {soft}; }}\n"
      ".tick {{ stroke: {soft}; stroke-width: 1; }}\n"
      ".floor {{ fill: #fdfcf9; }}\n"
      ".grid {{ stroke: #ebe7dd; stroke-width: 1; }}\n"
      ".wall {{ fill: #3a424c; }}\n"
      ".obstacle {{ fill: #cbc4b6; stroke: #857c6c; stroke-width: 1.2; stroke-linejoin: round; }}\n"
      ".obstacle-end {{ fill: none; stroke: #857c6c; stroke-width: 1.2; stroke-dasharray: 3 3; }}\n"
      ".obstacle-path {{ fill: none; stroke: #857c6c; stroke-width: 1.6; stroke-dasharray: 1 4; "
      "stroke-linecap: "
      "round; }}\n"
      ".lamp {{ stroke: #ffffff; stroke-width: 1; }}\n"
      ".obstacle-number {{ font-size: 13px; font-weight: bold; fill: #4d463a; text-anchor: middle; "
      "stroke: #efebe3; stroke-width: 3; paint-order: stroke; }}\n"
      ".spawn {{ fill: {kept}; fill-opacity: 0.08; stroke: {kept}; stroke-opacity: 0.55; stroke-width: 1.2; "
      "stroke-dasharray: 2 3; }}\n"
      ".goal {{ fill: {goal}; fill-opacity: 0.35; stroke: {goal}; stroke-width: 2.4; }}\n"
      ".nest {{ fill: #8a94a0; fill-opacity: 0.4; stroke: {soft}; stroke-width: 2; }}\n"
      ".food {{ fill: {prey}; fill-opacity: 0.3; stroke: {prey}; stroke-width: 2.4; }}\n"
      ".beacon {{ fill: {beacon}; fill-opacity: 0.6; stroke: #ffffff; stroke-width: 1; }}\n"
      ".beacon-before {{ fill: none; stroke: {beacon}; stroke-width: 1.3; stroke-opacity: 0.75; }}\n"
      ".transfer {{ fill: #ffffff; fill-opacity: 0.85; stroke: {beacon}; stroke-width: 2.2; }}\n"
      ".chain {{ fill: none; stroke: {beacon}; stroke-width: 2; stroke-dasharray: 7 5; }}\n"
      ".place {{ font-size: 12px; font-weight: bold; fill: #7a5c00; text-anchor: middle; stroke: #fdfcf9; "
      "stroke-width: 3; paint-order: stroke; }}\n"
      ".plan {{ fill: none; stroke: {plan}; stroke-width: 1.7; stroke-dasharray: 7 5; }}\n"
      ".way {{ fill: none; stroke-linejoin: round; }}\n"
      ".arrow {{ stroke: #fdfcf9; stroke-width: 0.8; }}\n"
      ".start {{ fill: #ffffff; stroke-width: 1.5; }}\n"
      ".robot {{ stroke: #ffffff; stroke-width: 1.4; }}\n"
      ".nose {{ stroke-width: 2.6; stroke-linecap: round; }}\n"
      ".ring {{ fill-opacity: 0.18; stroke-width: 1.6; stroke-opacity: 0.85; }}\n"
      ".number {{ font-size: 9.5px; font-weight: bold; fill: #ffffff; text-anchor: middle; }}\n"
      ".split {{ fill: {split}; fill-opacity: 0.12; stroke: {split}; stroke-width: 2.2; stroke-dasharray: 4 "
      "3; }}\n"
      ".split-robot {{ fill: {split}; stroke: #ffffff; stroke-width: 1.2; }}\n"
      ".callout {{ fill: #ffffff; fill-opacity: 0.93; stroke: {split}; stroke-width: 1.4; }}\n"
      ".callout-line {{ stroke: {split}; stroke-width: 1.4; }}\n"
      ".callout-text {{ font-size: 12.5px; font-weight: bold; fill: {split}; }}\n",
      fmt::arg("ink", kInk), fmt::arg("soft", kSoftInk), fmt::arg("kept", kKeptColor),
      fmt::arg("goal", kGoalColor), fmt::arg("plan", kPlanColor), fmt::arg("split", kSplitColor),
      fmt::arg("prey", kPreyColor), fmt::arg("beacon", kBeaconColor));
}

void DrawBox(SvgCanvas& canvas, const FigureFrame& frame, const sim::Vec2& min, const sim::Vec2& max,
             std::string_view style) {
  const Pixel corner = frame.At({min.x(), max.y()});
  canvas.Rectangle(corner, (max.x() - min.x()) * frame.scale(), (max.y() - min.y()) * frame.scale(), style);
}

// A step of 1, 2 or 5 times a power of ten that divides `extent` into at most `most` parts.
double NiceStep(double extent, double most) {
  double step = 0.1;
  for (int i = 0; step * most < extent && i < 60; ++i) step *= i % 3 == 1 ? 2.5 : 2.0;
  return step;
}

void DrawFloor(SvgCanvas& canvas, const FigureFrame& frame, const sim::Arena& arena, double step) {
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

void DrawWalls(SvgCanvas& canvas, const FigureFrame& frame, const sim::Arena& arena) {
  const sim::Vec2 outer{frame.half_x(), frame.half_y()};
  const sim::Vec2& min = arena.interior_min();
  const sim::Vec2& max = arena.interior_max();
  DrawBox(canvas, frame, {-outer.x(), max.y()}, outer, "class=\"wall\"");
  DrawBox(canvas, frame, -outer, {outer.x(), min.y()}, "class=\"wall\"");
  DrawBox(canvas, frame, {max.x(), min.y()}, {outer.x(), max.y()}, "class=\"wall\"");
  DrawBox(canvas, frame, {-outer.x(), min.y()}, {min.x(), max.y()}, "class=\"wall\"");
}

void DrawAxes(SvgCanvas& canvas, const FigureFrame& frame, double step) {
  const auto label = [step](double value) {
    const int decimals = step < 1.0 ? 1 : 0;
    const double shown = std::abs(value) < step / 100 ? 0.0 : value;
    std::string text = fmt::format("{:.{}f}", std::abs(shown), decimals);
    return shown < 0 ? "\u2212" + text : text;
  };
  for (double x = -std::floor(frame.half_x() / step) * step; x <= frame.half_x(); x += step) {
    const Pixel p = frame.At({x, -frame.half_y()});
    canvas.Line(p, {p.x, p.y + 6}, "class=\"tick\"");
    canvas.Text({p.x, p.y + 20}, label(x), "class=\"axis\" text-anchor=\"middle\"");
  }
  for (double y = -std::floor(frame.half_y() / step) * step; y <= frame.half_y(); y += step) {
    const Pixel p = frame.At({-frame.half_x(), y});
    canvas.Line(p, {p.x - 6, p.y}, "class=\"tick\"");
    canvas.Text({p.x - 10, p.y + 4.5}, label(y), "class=\"axis\" text-anchor=\"end\"");
  }
  const double middle_x = (FigureFrame::kLeft + frame.right()) / 2;
  const double middle_y = (FigureFrame::kTop + frame.bottom()) / 2;
  canvas.Text({middle_x, frame.bottom() + 42}, "x (m)", "class=\"axis\" text-anchor=\"middle\"");
  canvas.Text({24, middle_y}, "y (m)",
              fmt::format("class=\"axis\" text-anchor=\"middle\" transform=\"rotate(-90 24 {})\"",
                          SvgNumber(middle_y)));

  const double bar = NiceStep(frame.half_x(), 4);
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

// Middle of the corners; good enough to put a number on a convex polygon.
sim::Vec2 CenterOf(const sim::Polygon& polygon) {
  sim::Vec2 sum = sim::Vec2::Zero();
  for (const sim::Vec2& corner : polygon) sum += corner;
  return sum / static_cast<double>(polygon.size());
}

void DrawObstacles(SvgCanvas& canvas, const FigureFrame& frame, const sim::Arena& arena) {
  for (std::size_t i = 0; i < arena.obstacles().size(); ++i) {
    std::vector<Pixel> corners;
    for (const sim::Vec2& corner : arena.VisiblePart(i)) corners.push_back(frame.At(corner));
    if (!corners.empty())
      canvas.Polygon(corners, fmt::format("class=\"obstacle\" id=\"obstacle-{}\"", i + 1));
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
      std::vector<Pixel> corners;
      for (const sim::Vec2& corner : ClipToRectangle(box, arena.interior_min(), arena.interior_max())) {
        corners.push_back(frame.At(corner));
      }
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

void DrawObstacleNumbers(SvgCanvas& canvas, const FigureFrame& frame, const sim::Arena& arena) {
  for (std::size_t i = 0; i < arena.obstacles().size(); ++i) {
    const sim::Polygon polygon = arena.VisiblePart(i);
    if (polygon.empty()) continue;
    const Pixel p = frame.At(CenterOf(polygon));
    canvas.Text({p.x, p.y + 4.5}, fmt::format("{}", i + 1), "class=\"obstacle-number\"");
  }
}

void DrawPlaces(SvgCanvas& canvas, const RunFigure& figure, const FigureFrame& frame) {
  for (const sim::Annotation& annotation : figure.result.annotations) {
    if (annotation.kind == "area") {
      std::vector<Pixel> corners;
      for (const sim::Vec2& corner : annotation.points) corners.push_back(frame.At(corner));
      canvas.Polygon(corners, "class=\"spawn\"");
    }
    if (annotation.kind != "disc" || annotation.points.empty()) continue;
    const Pixel center = frame.At(annotation.points.front());
    const double radius = std::max(5.0, annotation.radius * frame.scale());
    canvas.Circle(center, radius, fmt::format("class=\"{}\"", PlaceClass(annotation)));
    canvas.Text({center.x, center.y + radius + 15}, annotation.label.empty() ? "goal" : annotation.label,
                "class=\"place\"");
  }
}

void DrawPlans(SvgCanvas& canvas, const RunFigure& figure, const FigureFrame& frame) {
  for (const sim::Annotation& annotation : figure.result.annotations) {
    if (annotation.kind != "path" || annotation.points.size() < 2) continue;
    std::vector<Pixel> points;
    for (const sim::Vec2& p : annotation.points) points.push_back(frame.At(p));
    canvas.Polyline(points, "class=\"plan\"");
  }
  for (const sim::Annotation& annotation : figure.result.annotations) {
    if (annotation.kind != "chain" || annotation.points.size() < 2) continue;
    std::vector<Pixel> points;
    for (const sim::Vec2& p : annotation.points) points.push_back(frame.At(p));
    canvas.Polyline(points, "class=\"chain\"");
  }
}

// Where robots stood as beacons: hollow where they left again.
void DrawBeacons(SvgCanvas& canvas, const RunFigure& figure, const FigureFrame& frame) {
  const RobotStates states = StatesOf(figure.result);
  const double end = figure.result.ticks * sim::kTickSeconds;
  for (const bool stays : {false, true}) {
    for (const StateSpell& spell : states.spells) {
      if (states.names[static_cast<std::size_t>(spell.state)] != "beacon") continue;
      if ((spell.end >= end) != stays) continue;
      const auto tick = static_cast<sim::Tick>(std::lround(spell.begin * sim::kTicksPerSecond));
      if (const auto position = PositionAt(figure, spell.robot, tick)) {
        // Around the robot that stands there still.
        DrawBeacon(canvas, frame.At(*position), stays ? 19.0 : 7.0, stays);
      }
    }
  }
}

// Where robots handed items over.
void DrawTransfers(SvgCanvas& canvas, const RunFigure& figure, const FigureFrame& frame) {
  for (const sim::Annotation& annotation : figure.result.annotations) {
    if (annotation.kind != "transfer" || annotation.points.empty()) continue;
    DrawTransfer(canvas, frame.At(annotation.points.front()));
  }
}

// "0-3, 5, 7-9".
std::string Ranges(std::vector<sim::RobotIndex> robots) {
  std::sort(robots.begin(), robots.end());
  std::string text;
  for (std::size_t begin = 0; begin < robots.size();) {
    std::size_t end = begin;
    while (end + 1 < robots.size() && robots[end + 1] == robots[end] + 1) ++end;
    if (!text.empty()) text += ", ";
    text += fmt::format("{}", robots[begin]);
    if (end > begin) text += fmt::format("{}{}", end == begin + 1 ? ", " : "-", robots[end]);
    begin = end + 1;
  }
  return text;
}

std::string SplitLabel(const RunFigure& figure, const sim::Annotation& split) {
  std::string text =
      split.tick >= 0 ? fmt::format("split at {:.0f} s", split.tick * sim::kTickSeconds) : "split";
  if (!split.robots.empty()) {
    text += fmt::format(": {}{} {} left the swarm", figure.member, split.robots.size() == 1 ? "" : "s",
                        Ranges(split.robots));
  }
  return text;
}

// Where a box of that size, linked to `place`, hides the least: among positions around it, the one that
// covers the fewest points of ways and obstacles' numbers.
Pixel PlaceCallout(const FigureFrame& frame, Pixel place, double width, double height,
                   const std::vector<Track>& tracks, const std::vector<Pixel>& keep_free) {
  Pixel best{FigureFrame::kLeft + 10, FigureFrame::kTop + 10};
  double least = std::numeric_limits<double>::infinity();
  for (const double reach : {48.0, 75.0, 110.0, 150.0, 200.0}) {
    for (int direction = 0; direction < 16; ++direction) {
      constexpr double kSixteenth = sim::kPi / 8;
      const sim::Vec2 unit = sim::UnitVector(direction * kSixteenth);
      const Pixel corner{place.x + unit.x() * (reach + width / 2) - width / 2,
                         place.y - unit.y() * (reach + height / 2) - height / 2};
      if (corner.x < FigureFrame::kLeft + 14 || corner.x + width > frame.right() - 14 ||
          corner.y < FigureFrame::kTop + 14 || corner.y + height > frame.bottom() - 14) {
        continue;
      }
      const auto covers = [&](Pixel p) {
        return p.x > corner.x - 5 && p.x < corner.x + width + 5 && p.y > corner.y - 5 &&
               p.y < corner.y + height + 5;
      };
      double cost = 0.15 * reach;
      for (const Track& track : tracks) {
        cost += static_cast<double>(std::count_if(track.points.begin(), track.points.end(), covers));
        if (covers(frame.At(track.end.position))) cost += 60;
      }
      cost += 40 * static_cast<double>(std::count_if(keep_free.begin(), keep_free.end(), covers));
      if (cost < least) {
        least = cost;
        best = corner;
      }
    }
  }
  return best;
}

double SplitRadius(const FigureFrame& frame) {
  return std::max(14.0, 0.2 * frame.scale());
}

// Where those who left at a split were at that moment.
void DrawSplitRobots(SvgCanvas& canvas, const RunFigure& figure, const FigureFrame& frame,
                     const sim::Annotation& split) {
  for (const sim::RobotIndex robot : split.robots) {
    const auto position = PositionAt(figure, robot, split.tick);
    if (!position) continue;
    const Pixel p = frame.At(*position);
    canvas.Polygon({{p.x, p.y - 6}, {p.x + 6, p.y}, {p.x, p.y + 6}, {p.x - 6, p.y}}, "class=\"split-robot\"");
  }
}

void DrawSplitPlace(SvgCanvas& canvas, const FigureFrame& frame, const sim::Annotation& split) {
  canvas.Circle(frame.At(split.points.front()), SplitRadius(frame), "class=\"split\" id=\"split\"");
}

struct Callout {
  std::string label;
  Pixel corner;
  double width = 0.0;
  static constexpr double kHeight = 25;
};

Callout SplitCallout(const RunFigure& figure, const sim::Annotation& split, const FigureFrame& frame,
                     const sim::Arena& arena, const std::vector<Track>& tracks) {
  std::vector<Pixel> keep_free;
  for (std::size_t i = 0; i < arena.obstacles().size(); ++i) {
    if (const sim::Polygon polygon = arena.VisiblePart(i); !polygon.empty()) {
      keep_free.push_back(frame.At(CenterOf(polygon)));
    }
  }
  for (const Track& track : tracks) keep_free.push_back(frame.At(track.start.position));
  Callout callout;
  callout.label = SplitLabel(figure, split);
  callout.width = 6.7 * static_cast<double>(callout.label.size()) + 18;
  callout.corner =
      PlaceCallout(frame, frame.At(split.points.front()), callout.width, Callout::kHeight, tracks, keep_free);
  return callout;
}

void DrawCalloutLine(SvgCanvas& canvas, const FigureFrame& frame, const sim::Annotation& split,
                     const Callout& callout) {
  const Pixel place = frame.At(split.points.front());
  const Pixel anchor{std::clamp(place.x, callout.corner.x, callout.corner.x + callout.width),
                     std::clamp(place.y, callout.corner.y, callout.corner.y + Callout::kHeight)};
  const double distance = std::hypot(anchor.x - place.x, anchor.y - place.y);
  if (distance <= SplitRadius(frame)) return;
  const double share = SplitRadius(frame) / distance;
  const Pixel edge{place.x + share * (anchor.x - place.x), place.y + share * (anchor.y - place.y)};
  canvas.Line(edge, anchor, "class=\"callout-line\"");
}

void DrawCalloutBox(SvgCanvas& canvas, const Callout& callout) {
  canvas.Rectangle(callout.corner, callout.width, Callout::kHeight, "class=\"callout\" rx=\"5\"");
  canvas.Text({callout.corner.x + 9, callout.corner.y + 17}, callout.label, "class=\"callout-text\"");
}

}  // namespace

std::string DrawRun(const RunFigure& figure) {
  const FigureFrame frame(figure.spec.test_case);
  const sim::Arena arena(figure.spec.test_case);
  const std::vector<Track> tracks = TracksOf(figure, frame);
  const double step = NiceStep(2 * std::max(frame.half_x(), frame.half_y()), 12);

  SvgCanvas canvas(frame.page_width(), frame.page_height(),
                   fmt::format("{}, {}: {}", figure.experiment, figure.run, DescribeOutcome(figure)),
                   StyleSheet());
  canvas.Rectangle({0, 0}, frame.page_width(), frame.page_height(), "fill=\"#ffffff\"");
  DrawFloor(canvas, frame, arena, step);
  DrawPlaces(canvas, figure, frame);
  DrawObstaclePaths(canvas, frame, arena);
  DrawObstacles(canvas, frame, arena);
  DrawLamps(canvas, frame, arena);
  DrawWalls(canvas, frame, arena);
  for (const TrackKind kind : {TrackKind::kKept, TrackKind::kLost}) {
    for (const Track& track : tracks) {
      if (track.kind == kind) DrawWay(canvas, track);
    }
  }
  for (const Track& track : tracks) {
    if (track.kind == TrackKind::kPrey) DrawWay(canvas, track);
  }
  DrawPlans(canvas, figure, frame);
  DrawBeacons(canvas, figure, frame);
  DrawTransfers(canvas, figure, frame);
  DrawObstacleNumbers(canvas, frame, arena);
  const sim::Annotation* split = LatestAnnotation(figure, "split");
  Callout callout;
  if (split != nullptr) {
    callout = SplitCallout(figure, *split, frame, arena, tracks);
    DrawSplitPlace(canvas, frame, *split);
    DrawCalloutLine(canvas, frame, *split, callout);
  }
  for (const Track& track : tracks) DrawStart(canvas, frame, track);
  DrawEnds(canvas, frame, tracks);
  if (split != nullptr) {
    DrawSplitRobots(canvas, figure, frame, *split);
    DrawCalloutBox(canvas, callout);
  }
  DrawAxes(canvas, frame, step);
  DrawTitle(canvas, figure, frame);
  DrawPanel(canvas, figure, frame, tracks);
  return canvas.Take();
}

}  // namespace gauntlet::analysis
